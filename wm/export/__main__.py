"""The command line: python -m wm.export RUN to=[...]."""
