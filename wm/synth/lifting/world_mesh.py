"""A mesh that stands in the world, as the reconstruction that lifting expects of a backend."""

import numpy as np

from wm.geometry.placement.upright import transformed
from wm.synth.backends import Reconstruction
from wm.types import Camera, SceneObject


def as_reconstruction(thing: SceneObject, camera: Camera, *, residual: float = 0.0) -> Reconstruction:
    """The thing in the frame of a camera, for a backend whose model writes mesh files (`wm.geometry.load_object`).

    Args:
      thing: in world space and metres, where the images show it.
      camera: of its first sighting.
      residual: metres between the points seen and the mesh, median.

    Returns:
      All its slots count as seen, in the colours they have. Their usual colours are not known and said to be the same, so that
      the thing counts as one seen in white light (wm.synth.lifting.unlit).
    """
    T_cam_world = np.asarray(camera.T_cam_world, np.float64)
    seen = np.ones(len(thing.slots), bool)
    return Reconstruction(thing=transformed(thing, T_cam_world), seen=seen, usual=thing.slot_colors.copy(), residual=residual)
