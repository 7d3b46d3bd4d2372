"""Gaussian splatting in JAX: from gaussians and a camera to an image, and back to better gaussians.

    render.py     render: one call from gaussians to an image, in and out of jit
    project.py    project -> Projected: ellipses on the image plane
    tiles.py      plan_tiles -> TilePlan: which gaussians touch which tiles, front to back (host)
    composite.py  rasterize: alpha compositing over a plan, with its own derivative
    harmonics.py  the colour's dependence on direction
    _reference.py render_reference: the slow float64 twin of render
"""

from wm.splat.composite import rasterize
from wm.splat.project import Projected, project
from wm.splat.render import render
from wm.splat.tiles import TilePlan, plan_tiles

__all__ = ["Projected", "TilePlan", "plan_tiles", "project", "rasterize", "render"]
