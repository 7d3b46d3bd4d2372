"""A study in which people rate and compare videos of scenes: python -m wm.study make, and analyse.

    __main__   the command line
"""
