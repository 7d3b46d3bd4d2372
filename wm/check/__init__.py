"""Proves an exported run with the tools of those who use it: python -m wm.check RUN.

    __main__   the command line
"""
