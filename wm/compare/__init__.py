"""Scenes of other methods beside ours, on the same trajectories: python -m wm.compare METHOD=PATH ...

    __main__   the command line
"""
