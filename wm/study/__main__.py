"""The command line: python -m wm.study make, and python -m wm.study analyse."""
