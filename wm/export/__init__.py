"""What other programs take of a finished run, one module a target: python -m wm.export RUN to=[...].

    __main__   the command line
"""
