"""Gaussian splatting in JAX: from gaussians and a camera to an image, and back to better gaussians.

    render.py     render: one call from gaussians to an image, in and out of jit
    project.py    project -> Projected: ellipses on the image plane
    tiles.py      plan_tiles -> TilePlan: which gaussians touch which tiles, front to back (host); tiles_traced.py: in the graph;
                  planner.py: which of the two
    composite.py  rasterize: alpha compositing over a plan, with its own derivative; _loops.py, _kernels.py: the walk, for XLA
                  anywhere and for NVIDIA GPUs; _pairs.py: one gaussian at one pixel
    _blocks.py    what is done for each gaussian, a block of them at a time
    checks.py     what is wrong with the arguments
    harmonics.py  the colour's dependence on direction
    _reference.py render_reference: the slow float64 twin of render

    training.py   TrainingView: what a fit is shown
    cloud.py      initial_gaussians: the scaffold's surfaces, thinned and coloured
    ssim.py       ssim, with its own derivative; normal_loss.py likewise; losses.py: what a fit minimises
    step.py       one step; batch.py: the views of a step, over devices; frozen.py: what a fit renders and does not move
    room_fit.py   the loop of steps; room_state.py, checkpoint.py: where it stands; padding.py: the shapes that steps share
    watch.py      is it getting better; trouble.py: what is wrong if not; curve.py: its error against time
    exposure.py   tone of each view; refine.py: faint gaussians given to where the residual stays
    fit.py        fit: views of one room; scene_fit.py, scene_progress.py: fit_scene, many rooms side by side
    scene_render.py  SceneRenderer: renders of many rooms
    room_task.py  what the fit of one of them reads
    metrics.py    error against the truth and the scaffold; reprojection.py: consistency between views
    ply.py        load_ply, save_ply
"""

from wm.splat.metrics import DepthError, NormalError, depth_error, normal_error, normals_from_depth, one_surface, psnr
from wm.splat.optimization.cloud import initial_gaussians
from wm.splat.optimization.curve import FitPoint
from wm.splat.optimization.fitting import Fit, FitError, fit
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.training import TrainingView
from wm.splat.ply import PlyError, load_ply, save_ply
from wm.splat.rasterizer.compositing import rasterize
from wm.splat.rasterizer.projection import Projected, project
from wm.splat.rasterizer.rendering import render
from wm.splat.rasterizer.tiles import TilePlan, plan_tiles, plan_views
from wm.splat.rasterizer.tiles_traced import TracedPlan, plan_tiles_on_device, plan_tiles_traced
from wm.splat.reprojection import ReprojectionError, mutual_pixels, overlap, reprojection_error, shared_pixels
from wm.splat.scene.scene_fit import SceneFit, fit_scene
from wm.splat.scene.scene_render import SceneRenderer
from wm.splat.similarity import ssim, ssim_map
from wm.splat.xla.vector_width import WIDE

__all__ = [
    "WIDE",
    "Capacity",
    "DepthError",
    "Fit",
    "FitError",
    "FitPoint",
    "NormalError",
    "PlyError",
    "Projected",
    "ReprojectionError",
    "SceneFit",
    "SceneRenderer",
    "TilePlan",
    "TracedPlan",
    "TrainingView",
    "depth_error",
    "fit",
    "fit_scene",
    "initial_gaussians",
    "load_ply",
    "mutual_pixels",
    "normal_error",
    "normals_from_depth",
    "one_surface",
    "overlap",
    "plan_tiles",
    "plan_tiles_on_device",
    "plan_tiles_traced",
    "plan_views",
    "project",
    "psnr",
    "rasterize",
    "render",
    "reprojection_error",
    "save_ply",
    "shared_pixels",
    "ssim",
    "ssim_map",
]
