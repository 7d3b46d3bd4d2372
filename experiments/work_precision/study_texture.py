"""The texture of a furnished room's walls: what held-out cameras see of it, against the truth, over the size of its texels."""

import pathlib
import time
from collections.abc import Iterator

import bench
import numpy as np

from wm.geometry import build_atlas, cast
from wm.geometry.texture.accumulation import accumulate_in_place
from wm.geometry.texture.sampling import pixel_charts, sample_atlas
from wm.schema import TextureSettings
from wm.splat import psnr

TEXELS = (0.005, 0.01, 0.02, 0.04, 0.08)
PANELS = [("view_ms", "psnr", "linear"), ("view_ms", "mib", "log")]


def rows(tiny: bool, world: pathlib.Path) -> Iterator[dict]:
    room = bench.furnished_room(world, tiny=tiny)
    scene = room.scene
    gbuffers = [cast(scene.rays, view.camera) for view in scene.views]
    for texel in (0.08, 0.16) if tiny else TEXELS:
        settings, atlas = TextureSettings(texel_size=texel), build_atlas(scene.context.structure, texel)
        times = []
        for view, target, gbuffer in zip(scene.views, room.views, gbuffers):
            started = time.perf_counter()
            accumulate_in_place(
                atlas, gbuffer, view.camera, target.rgb / np.float32(255), view.room, settings, usable=target.mask
            )
            times.append((time.perf_counter() - started) * 1e3)
        size = (atlas.color.nbytes + atlas.weight.nbytes) / 2**20
        labels = {"vary": "texel", "value": texel, "default": settings == TextureSettings()}
        yield labels | {"view_ms": float(np.median(times)), "mib": size} | errors(atlas, room, settings)


def errors(atlas, room: bench.Room, settings: TextureSettings) -> dict[str, float]:
    """PSNR over the pixels of held-out views that show known texels, and how many of those that show the atlas do."""
    ratios, known = [], []
    for view, target in zip(room.cameras, room.heldout):
        gbuffer = cast(room.scene.rays, view.camera)
        rgb, alpha = sample_atlas(atlas, gbuffer, view.camera, settings)
        ratios.append(psnr(rgb, target.rgb / np.float32(255), alpha >= 1))
        known.append((alpha >= 1).sum() / max((pixel_charts(atlas, gbuffer) >= 0).sum(), 1))
    return {"psnr": float(np.mean(ratios)), "known": float(np.mean(known))}
