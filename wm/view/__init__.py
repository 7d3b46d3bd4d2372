"""The page on which a finished run is walked through: python -m wm.view RUN.

    __main__   the command line
"""
