"""Gaussians on disk, in the layout that every splat viewer opens, and the layouts of other programs.

    errors      PlyError
    header      read_header: the text at the head of a PLY file: its format, elements and comments
    body        the rows of its elements, binary or ASCII
    dialects    which properties hold gaussians: INRIA, 2DGS, red-green-blue, point clouds
    compressed  PlayCanvas's packed layout
    standard    packable: unit quaternions and finite numbers
    loading     load_ply, splat_render_mode
    saving      save_ply, save_point_cloud
"""

from wm.splat.ply.errors import PlyError
from wm.splat.ply.loading import load_ply, splat_render_mode
from wm.splat.ply.saving import save_ply, save_point_cloud

__all__ = ["PlyError", "load_ply", "save_ply", "save_point_cloud", "splat_render_mode"]
