"""Files of gaussians in the formats of other programs, read and written.

    errors          SplatFileError
    loading         load_splats: any format
    splat_records   save_splat: antimatter15's .splat
    compressed_ply  save_compressed_ply: PlayCanvas's packed layout
    gaussforge      save_packed: SPZ and SOG, by gaussforge (extra `splats`)
    glb_file        the container of a GLB file and the arrays in it
    gltf_splats     save_gltf_splats: KHR_gaussian_splatting
    turning         to_y_up, to_z_up: gaussians in other axes
"""

from wm.splat.formats.compressed_ply import save_compressed_ply
from wm.splat.formats.errors import SplatFileError
from wm.splat.formats.gaussforge import save_packed
from wm.splat.formats.gltf_splats import save_gltf_splats
from wm.splat.formats.loading import load_splats
from wm.splat.formats.splat_records import save_splat
from wm.splat.formats.turning import to_y_up, to_z_up

__all__ = [
    "SplatFileError",
    "load_splats",
    "save_compressed_ply",
    "save_gltf_splats",
    "save_packed",
    "save_splat",
    "to_y_up",
    "to_z_up",
]
