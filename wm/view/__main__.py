"""The command line: python -m wm.view RUN."""
