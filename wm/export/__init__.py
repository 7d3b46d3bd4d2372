"""What other programs take of a finished run, one module a target: python -m wm.export RUN to=[...].

    __main__  the command line
    targets   TARGETS: the targets by name, and the module of each
    records   ExportError, Check
    splats    gaussians in the formats that viewers open
"""
