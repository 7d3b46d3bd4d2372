"""Posed images, depth, normals and labels along a trajectory through a run: python -m wm.capture RUN.

    __main__   the command line
"""
