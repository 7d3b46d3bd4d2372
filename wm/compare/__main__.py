"""The command line: python -m wm.compare METHOD=PATH ...."""
