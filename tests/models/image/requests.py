"""Requests to image models, made of little."""

import numpy as np

from wm.synth.backends import Condition, ImageRequest
from wm.types import Camera, View


def image_request(rgb: np.ndarray, *, seed: int = 7, reference: np.ndarray | None = None, task: str = "paint") -> ImageRequest:
    """A request for a view whose condition is this image, [h, w, 3] uint8."""
    height, width = rgb.shape[:2]
    blank = np.zeros((height, width), np.float32)
    camera = Camera(
        T_cam_world=np.eye(4),
        focal=np.full(2, float(width)),
        principal=np.array([width / 2, height / 2]),
        width=width,
        height=height,
    )
    return ImageRequest(
        condition=Condition(rgb=rgb.astype(np.float32) / 255, known=blank, depth=blank),
        reference=None if reference is None else reference.astype(np.float32) / 255,
        prompt="a prompt of the method",
        view=View(camera=camera, room=0, kind="perimeter", name="hall/perimeter0"),
        seed=seed,
        task="paint" if task == "paint" else "furnish",
        theme="a lighthouse keeper's cottage",
        room="kitchen",
        sights=("a doorway on the left",),
    )
