"""From gaussians and a camera to an image, with derivatives by hand; nothing here knows of a fit.

    rendering     render: one call from gaussians to an image, in and out of jit
    projection    project: ellipses on the image plane; _axes, _pose, _pullback: its parts and its vector-Jacobian product
    harmonics     colour by direction
    tiles         plan_tiles: tile binning on the host; tiles_traced: in the graph; _spans: what both share
    planner       which of the two
    compositing   rasterize: alpha compositing over a plan (an alpha is clamped in _pairs)
    _loops        the compositing loop for any device; _kernels: for NVIDIA GPUs
    _pairs        one gaussian at one pixel; _exp2, _tile_sums: its arithmetic
    checks        what is wrong with the arguments
    _reference    render_reference: the slow float64 twin
"""
