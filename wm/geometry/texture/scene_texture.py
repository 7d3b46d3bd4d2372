"""The texture of a scene whose rooms are painted side by side: each room sees and writes a copy of its part.

Views of a room write the room's own surfaces and reveals, which two rooms share. Beside these they see the surfaces of the first
room, as the anchor views (the first of all, wm.synth.order) have left them. A room starts from a copy of those charts, so that
what it sees does not depend on which other rooms are under way or finished.

What a room has painted of its own surfaces is copied back. On a reveal, the anchors leave weight w and colour c, and room r ends
with w_r and c_r. The mean over the views of all rooms is
    W = w + sum_r (w_r - w),    C = (w c + sum_r (w_r c_r - w c)) / W,
summed in float64 in the order of the rooms: that of `accumulate` over all views, but for rounding.
"""

import dataclasses
from collections.abc import Iterable

import numpy as np
from jaxtyping import Int

from wm.geometry.texture.atlas import chart_image
from wm.types import Atlas, SurfaceKind

_Texels = tuple[np.ndarray, np.ndarray]  # weight [rows, columns] float32, colour [rows, columns, 3] float32


class SceneTexture:
    """The texture of a scene, with parts for its rooms. Several threads may ask for parts and finish them at the same time.

    Args:
      atlas: the scene's atlas, with the texture of the anchors on the first room's surfaces and on reveals. It is changed.
      first: the first room.
    """

    def __init__(self, atlas: Atlas, first: int):
        self.atlas = atlas
        # Charts that parts of several rooms show, and by room and chart what the room has added to those.
        self._shared = (atlas.chart_kind == SurfaceKind.REVEAL) | (atlas.chart_room == first)
        self._waiting: dict[int, dict[int, _Texels]] = {}

    def part(self, room: int) -> Atlas:
        """What the views of a room see and write, as an atlas with a colour and weight of its own.

        It has the charts of the room, those of the first room, and all reveals. No other surface has a chart in it.
        """
        return _part(self.atlas, self._charts(room))

    def finish(self, room: int, part: Atlas) -> None:
        """Takes what a room has painted. What it has added to charts that parts of other rooms show waits for `join`."""
        waiting = {}
        for local, chart in enumerate(map(int, self._charts(room))):
            painted = _texels(part, local)
            if not self._shared[chart]:
                _write(self.atlas, chart, painted)
            elif not np.array_equal(painted[0], _texels(self.atlas, chart)[0]):  # else no view of the room has added to it
                waiting[chart] = (painted[0].copy(), painted[1].copy())
        self._waiting[room] = waiting

    def join(self) -> Atlas:
        """The atlas of the scene with what every finished room has painted. To be called once, after the last room."""
        added: dict[int, list[_Texels]] = {}
        for room in sorted(self._waiting):
            for chart, painted in self._waiting[room].items():
                added.setdefault(chart, []).append(painted)
        for chart, painted in added.items():
            one = len(painted) == 1
            _write(self.atlas, chart, painted[0] if one else _mean(_texels(self.atlas, chart), painted))
        return self.atlas

    def _charts(self, room: int) -> Int[np.ndarray, "k"]:
        return np.flatnonzero(self._shared | (self.atlas.chart_room == room))


def _part(atlas: Atlas, charts: np.ndarray) -> Atlas:
    """A copy of some charts [k] as an atlas of its own, in which they are 0 to k - 1."""
    texels = atlas.chart_shape[charts].prod(axis=1, dtype=np.int64)
    place = np.full(len(atlas.chart_start) + 1, -1, np.int32)  # of each chart in the part; that of chart -1 is the last entry
    place[charts] = np.arange(len(charts), dtype=np.int32)
    flat = [slice(start, start + count) for start, count in zip(atlas.chart_start[charts], texels, strict=True)]
    by_chart = ("chart_origin", "chart_u", "chart_v", "chart_normal", "chart_shape", "chart_room", "chart_kind")
    by_texel = ("inside", "color", "weight")
    return dataclasses.replace(
        atlas,
        chart_start=np.cumsum(texels) - texels,
        face_chart=place[atlas.face_chart],
        **{name: getattr(atlas, name)[charts] for name in by_chart},
        **{name: np.concatenate([getattr(atlas, name)[run] for run in (slice(0), *flat)]) for name in by_texel},
    )


def _texels(atlas: Atlas, chart: int) -> _Texels:
    """Views of a chart's part of the atlas."""
    return chart_image(atlas, chart, atlas.weight), chart_image(atlas, chart, atlas.color)


def _write(atlas: Atlas, chart: int, texels: _Texels) -> None:
    weight, color = _texels(atlas, chart)
    weight[...], color[...] = texels


def _mean(anchors: _Texels, painted: Iterable[_Texels]) -> _Texels:
    """The weighted mean over the views of all rooms, each of which started from what the anchors had left."""
    before, colored = anchors[0].astype(np.float64), _weighted(anchors)
    total, mixed = before.copy(), colored.copy()
    for one in painted:
        total += one[0] - before
        mixed += _weighted(one) - colored
    known = (total > 0)[..., None]
    color = np.where(known, mixed / np.where(known, total[..., None], 1), anchors[1])
    return total.astype(np.float32), color.astype(np.float32)


def _weighted(texels: _Texels) -> np.ndarray:
    """[rows, columns, 3] float64 weight * colour."""
    return texels[0].astype(np.float64)[..., None] * texels[1]
