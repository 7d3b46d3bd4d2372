"""Proves an exported run with the tools of those who use it: python -m wm.check RUN.

    __main__     the command line
    checking     check_run, check_table: the checks of all targets
    splat_depth  splat_depth: whether the gaussians lie on the mesh, by room
"""
