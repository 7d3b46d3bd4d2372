"""Gaussian splatting in JAX: from gaussians and a camera to an image, and from images to gaussians.

    rasterizer    render, project, plan_tiles, rasterize: gaussians to images, with hand-written derivatives
    optimization  fit, initial_gaussians: the gaussians of one room from its training views
    scene         fit_scene, SceneRenderer: many rooms, each beside frozen neighbours
    xla           fusion barriers, vector width and blocks for XLA on a CPU
    similarity    ssim, with a hand-written derivative
    metrics       psnr, depth_error, normal_error: errors against the truth and the scaffold
    reprojection  reprojection_error: consistency of depth between views
    image_checks  what is wrong with an image that is to be measured
    ply           load_ply, save_ply, splat_render_mode, save_point_cloud: files of ours and of other programs
    formats       load_splats and writers: compressed PLY, .splat, SPZ, SOG and glTF
"""

from wm.compiler_options import WIDE
from wm.splat.metrics import DepthError, NormalError, depth_error, normal_error, normals_from_depth, one_surface, psnr
from wm.splat.optimization.cloud import initial_gaussians
from wm.splat.optimization.curve import FitPoint
from wm.splat.optimization.fitting import Fit, FitError, fit
from wm.splat.optimization.padding import Capacity
from wm.splat.optimization.training import TrainingView
from wm.splat.ply import PlyError, load_ply, save_ply, save_point_cloud, splat_render_mode
from wm.splat.rasterizer.compositing import rasterize
from wm.splat.rasterizer.projection import Projected, project
from wm.splat.rasterizer.rendering import render
from wm.splat.rasterizer.tiles import TilePlan, plan_tiles, plan_views
from wm.splat.rasterizer.tiles_traced import TracedPlan, plan_tiles_on_device, plan_tiles_traced
from wm.splat.reprojection import ReprojectionError, mutual_pixels, overlap, reprojection_error, shared_pixels
from wm.splat.scene.scene_fit import SceneFit, fit_scene
from wm.splat.scene.scene_render import SceneRenderer
from wm.splat.similarity import ssim, ssim_map

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
    "save_point_cloud",
    "shared_pixels",
    "splat_render_mode",
    "ssim",
    "ssim_map",
]
