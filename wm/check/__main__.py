"""The command line: python -m wm.check RUN."""
