"""What of the fitted gaussians goes to `splats.ply`."""

import numpy as np

from tests.splat.ply.files import some
from wm.splat.rasterizer.rendering import render
from wm.stages.reconstruction import visible_gaussians
from wm.types import Camera


def test_gaussians_that_nothing_draws_are_left_out_and_the_image_stays():
    rooms = [some(30, 1, seed) for seed in range(2)]
    for room in rooms:
        room.means[:, 2] += 4
        room.opacity_logits[::3] = -9
    kept = visible_gaussians(rooms)
    assert len(kept.means) == 40
    np.testing.assert_array_equal(kept.means, np.concatenate([np.delete(room.means, np.s_[::3], 0) for room in rooms]))
    camera = Camera(T_cam_world=np.eye(4), focal=np.full(2, 20.0), principal=np.array([16.0, 12.0]), width=32, height=24)
    everything = type(kept)(**{name: np.concatenate([getattr(room, name) for room in rooms]) for name in vars(kept)})
    np.testing.assert_array_equal(render(kept, camera).rgb, render(everything, camera).rgb)
