"""The command line: python -m wm.capture RUN."""
