"""Whether a frame's depths tell what the next frames show: what no score of single images can see.

    p = unproject_t(D_t),  moved into frame s = t + STEP: depth z, pixel u
    seen      p lies in frame s, and nothing stands before it there: z <= (1 + OCCLUSION) D_s(u)
    colour    mean |I_t - I_s(u)| over what is seen, channels in sRGB from 0 to 1
    still     the same at the same pixel instead of u: what a scene without any depth would give
    explained 1 - colour / still: the share of the change between the frames that the depths account for. Blur and low contrast,
              which make `colour` small, make `still` small too
    depth     mean of |z - D_s(u)| / D_s(u) over what is seen, each at most MOST
    lost      share of what is seen at which frame s shows something far behind: z < (1 - OCCLUSION) D_s(u). A surface
              that is there from one place and not from the next

Where gaussians hang in the air, or images of one wall do not agree, colours do not move as depths say.
"""

import dataclasses

import numpy as np
from jaxtyping import Float

from wm.compare.bilinear import bilinear
from wm.geometry.rays.pinhole import project_points, unproject_depth
from wm.splat.reprojection import every, sample_depth
from wm.types import Camera

STEP = 4
"""Frames from one to the one it is compared with: a sixth of a second. Between neighbours hardly anything moves by a pixel."""
STRIDE = 2
"""Every so many rows and columns are moved."""
OCCLUSION = 0.05
"""Share of the depth by which something nearer hides a point; twice what depths between pixels are off by, and more."""
MOST = 1.0
"""Largest relative error of one pixel, so that a single hole in a wall does not decide a mean."""
HOLE = 0.5
"""Opacity below which a pixel shows nothing."""


@dataclasses.dataclass(frozen=True, eq=False)
class DrawnFrame:
    """A rendered frame: colours clipped to [0, 1], and depths that are 0 where less than HOLE of the pixel is covered."""

    camera: Camera
    rgb: np.ndarray  # [h, w, 3] float32
    depth: np.ndarray  # [h, w] float32
    holes: float  # share of its pixels that show nothing


@dataclasses.dataclass(frozen=True)
class Consistency:
    """Sums over the pixels that two frames both see."""

    color: float
    still: float
    depth: float
    lost: float
    pixels: int


def frame_of(
    camera: Camera, rgb: Float[np.ndarray, "h w 3"], depth: Float[np.ndarray, "h w"], alpha: Float[np.ndarray, "h w"]
) -> DrawnFrame:
    """A frame of what was rendered."""
    covered = alpha >= HOLE
    return DrawnFrame(
        camera=camera,
        rgb=np.clip(rgb, 0, 1).astype(np.float32),
        depth=np.where(covered, depth, 0).astype(np.float32),
        holes=float(1 - covered.mean()),
    )


def consistency(frame: DrawnFrame, later: DrawnFrame, *, stride: int = STRIDE) -> Consistency:
    """What a frame's depths explain of a later frame."""
    depth, camera = every(stride, frame.depth, frame.camera)
    first = stride // 2
    rgb = frame.rgb[first::stride, first::stride]
    uv, z = project_points(later.camera, unproject_depth(camera, depth).reshape(-1, 3))
    uv = np.where((depth.reshape(-1) > 0)[:, None], uv, np.nan)
    there = sample_depth(later.depth, uv)
    seen = (there > 0) & (z <= (1 + OCCLUSION) * there)
    if not seen.any():
        return Consistency(color=0.0, still=0.0, depth=0.0, lost=0.0, pixels=0)
    own, still = rgb.reshape(-1, 3)[seen], later.rgb[first::stride, first::stride].reshape(-1, 3)[seen]
    shown = bilinear(later.rgb, uv[seen])
    apart = np.abs(z[seen] - there[seen]) / there[seen]
    return Consistency(
        color=float(np.abs(own - shown).mean(axis=1).sum()),
        still=float(np.abs(own - still).mean(axis=1).sum()),
        depth=float(np.minimum(apart, MOST).sum()),
        lost=float((z[seen] < (1 - OCCLUSION) * there[seen]).sum()),
        pixels=int(seen.sum()),
    )


def means(parts: list[Consistency]) -> dict[str, float]:
    """The means over all pixels of all pairs, by key; nothing where no pixel was seen twice."""
    pixels = sum(part.pixels for part in parts)
    if not pixels:
        return {}
    total = {name: sum(getattr(part, name) for part in parts) / pixels for name in ("color", "still", "depth", "lost")}
    explained = 1 - total["color"] / total["still"] if total["still"] > 0 else None
    rows = {"warp_color": total["color"], "warp_explained": explained, "warp_depth": total["depth"], "warp_lost": total["lost"]}
    return {name: value for name, value in rows.items() if value is not None}
