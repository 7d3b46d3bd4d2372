"""From gaussians and a camera to an image, with hand-written derivatives; imports nothing of the fit.

    rendering     render: one call from gaussians to an image, in and out of jit
    projection    project: gaussians in the world to ellipses on the image, and its vector-Jacobian product
    harmonics     spherical harmonics: colour by direction
    tiles         plan_tiles: tile binning on the host
    tiles_traced  plan_tiles_traced: tile binning in the graph
    planner       the choice between the two
    compositing   rasterize: alpha compositing over a plan
    checks        checks of arguments and settings
    _axes         rotations, clamps and slopes that the projection and its derivative share
    _pose         points in camera axes, exact far from the origin
    _vjp          the vector-Jacobian product of the projection with respect to the gaussians
    _spans        arithmetic of tile binning that host and graph share
    _loops        the compositing loop for any device
    _kernels      the compositing loop for NVIDIA GPUs
    _pairs        one gaussian at one pixel: its alpha (clamped here), weight and derivatives
    _exp2         powers of two on a bounded range
    _tile_sums    sums over the pixels of a tile
    _reference    render_reference: the slow float64 twin of render
"""
