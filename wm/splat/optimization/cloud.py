"""The initial gaussians of a room: the scaffold's surfaces as its views see them, thinned to a spacing.

Every pixel that shows the room's own surface is a world point with a normal and a colour. Points are binned into cells of the
wanted spacing and by the direction that their surface faces (so a corner keeps one gaussian per wall), and a cell becomes one
gaussian: the mean of its points, their mean normal, and the mean of the usable colours over all views. Cells are smaller where
there is detail, on objects and on the near side of every silhouette: there a gaussian that reaches past the edge costs depth and
normals most. Views are folded in one at a time, so memory is bounded by the room's surface.

Surface that none of the room's views shows would stay a black hole wherever another view sees it: from the next room, or in the
corner behind a chair. `vacant` finds the points where the cloud does not cover a surface, `extended` adds them to the cloud.
"""

import dataclasses
from collections.abc import Callable, Iterable

import jax
import numpy as np
from jaxtyping import Float, Int
from scipy.ndimage import maximum_filter
from scipy.sparse import csr_array
from scipy.spatial import KDTree

from wm.geometry.rays.pinhole import camera_rotation, unproject_depth
from wm.schema import FitSettings
from wm.splat.optimization.checks import check_fit
from wm.splat.optimization.padding import CULLED_LOGIT
from wm.splat.optimization.training import TrainingView
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians

TANGENTIAL, TANGENTIAL_DETAIL, NORMAL = 0.65, 0.5, 0.05
"""Standard deviations along and across the surface, as shares of the spacing: plain surfaces want no gaps, detail sharp edges
(experiments/fit_defaults)."""

BESIDE = 8 / 688
"""Share of the image's width that counts as beside a silhouette."""

DROP, RELATIVE_DROP = 0.1, 0.08
"""How much farther, in metres and as a share of the depth, a surface must be to make a silhouette of the one before it."""

RANDOM_OPACITY = 0.5
"""Initial opacity of the `random` variant, as in the prototype's figures: opaque ones in free air hide each other."""

HIDDEN_OPACITY = 0.97
"""Initial opacity of what no view of the room shows, at least: the fit hardly raises it, and its gaussians overlap less."""

_BITS = 19
_SHIFT = 0.381966
"""The grid of cells is shifted by this share of a cell, so that walls at round coordinates do not lie between two."""
_LOOKALIKES, _TURN = 4, 0.5
"""A point of unknown colour takes the mean of so many others, the nearest: opposite normals count as twice _TURN metres."""


@dataclasses.dataclass(frozen=True, eq=False)
class Cloud:
    """Oriented, coloured points on the host."""

    points: np.ndarray  # [n, 3] float64, metres
    normals: np.ndarray  # [n, 3] float64 unit
    colors: np.ndarray  # [n, 3] float64 in [0, 1]
    spacings: np.ndarray  # [n] float64, metres: edge of the cell that each stands for
    extents: np.ndarray  # [n, 2] float64, metres: standard deviations along the surface
    shown: np.ndarray  # [n] bool: whether a view of the room shows it


def surface_cloud(views: Iterable[TrainingView], spacing: float, detail_spacing: float | None = None) -> Cloud:
    """The surface of a room as oriented points about `spacing` metres apart, sorted by cell: the same views, the same bytes.

    Args:
        views: views of the room; only their own pixels with a scaffold depth are used. A cell whose colour no usable pixel shows
            takes that of the nearest others.
        spacing: edge of a cell, metres.
        detail_spacing: the same where the surface has detail (`TrainingView.detailed`, and beside silhouettes); None: nowhere.

    Raises:
        ValueError: a spacing is not positive, or the surface spans more than 2^19 cells.
    """
    edges = np.array([spacing, spacing if detail_spacing is None else detail_spacing])
    if not (edges > 0).all():
        raise ValueError(f"the spacing of the initial cloud must be positive, not {spacing} and {detail_spacing}")
    cells = _SumsByKey(columns=11)
    for view in views:
        own = view.depth > 0 if view.own is None else (view.depth > 0) & view.own
        points = unproject_depth(view.camera, view.depth)[own]
        normals = (depth_normals(view) if view.normal is None else view.normal)[own].astype(np.float64)
        usable = view.mask[own].astype(np.float64)[:, None]
        colors = view.rgb[own] / 255.0 * usable
        rows = np.concatenate([points, normals, colors, usable, np.ones_like(usable)], axis=1)
        fine = np.zeros(len(points), np.int64) if detail_spacing is None else _detailed(view)[own].astype(np.int64)
        cells.add(_cells(points, normals, edges[fine], fine), rows)
    keys, sums = cells.sums()
    seen = sums[:, 9:10]
    length = np.linalg.norm(sums[:, 3:6], axis=1, keepdims=True)
    cloud = Cloud(
        points=sums[:, :3] / sums[:, 10:11],
        normals=np.where(length > 0, sums[:, 3:6] / np.where(length > 0, length, 1), [0.0, 0.0, 1.0]),
        colors=np.where(seen > 0, sums[:, 6:9] / np.where(seen > 0, seen, 1), np.nan),
        spacings=edges[keys >> 3 * _BITS + 3],
        extents=np.repeat((edges * [TANGENTIAL, TANGENTIAL_DETAIL])[keys >> 3 * _BITS + 3][:, None], 2, axis=1),
        shown=np.ones(len(keys), bool),
    )
    return _with_all_colors(cloud)


def vacant(
    cloud: Cloud,
    points: Float[np.ndarray, "n 3"],
    normals: Float[np.ndarray, "n 3"],
    spacings: Float[np.ndarray, "n"],
) -> Int[np.ndarray, "k"]:
    """Which points are where the cloud leaves a surface bare, in their order: none of the cloud that faces much the same way is
    within the edge of their cells.

    Args:
        points, normals: on the surface the cloud should cover, metres and unit.
        spacings: edges of their cells, metres.
    """
    if not len(points) or not len(cloud.points):
        return np.arange(len(points))
    widest = spacings.max()
    tree = KDTree(np.concatenate([cloud.points, widest * cloud.normals], axis=1))
    away, _ = tree.query(np.concatenate([points, widest * normals], axis=1), distance_upper_bound=widest)
    return np.flatnonzero(away > spacings)


def one_a_cell(
    points: Float[np.ndarray, "n 3"], normals: Float[np.ndarray, "n 3"], spacings: Float[np.ndarray, "n"]
) -> Int[np.ndarray, "k"]:
    """The point of each cell that is nearest to the mean of its points, in their order; arguments as for `vacant`.

    Neighbours then lie about a cell apart; the first points of two cells may leave a gap of nearly two.
    """
    fine = (spacings < spacings.max(initial=0)).astype(np.int64)
    _, cell, count = np.unique(_cells(points, normals, spacings, fine), return_inverse=True, return_counts=True)
    means = np.column_stack([np.bincount(cell, points[:, axis]) / count for axis in range(3)])
    order = np.lexsort((np.linalg.norm(points - means[cell], axis=1), cell))
    return np.sort(order[np.cumsum(count) - count])


def extended(cloud: Cloud, more: Cloud) -> Cloud:
    """Both clouds, `more` last; its colours that are NaN become those of the nearest points that face much the same way."""
    names = [field.name for field in dataclasses.fields(Cloud)]
    return _with_all_colors(Cloud(**{name: np.concatenate([getattr(cloud, name), getattr(more, name)]) for name in names}))


def initial_gaussians(
    views: Iterable[TrainingView],
    *,
    settings: FitSettings,
    rng: np.random.Generator,
    complete: Callable[[Cloud], Cloud] = lambda cloud: cloud,
) -> Gaussians:
    """The gaussians from which the fit of one room starts (NumPy float32 leaves).

    Args:
        views: the room's views.
        settings: `init` is "flat" (discs in the surface), "isotropic" (balls on it) or "random" (as many balls anywhere in the
            room's bounding box, of random colours); the spacings, `opacity` and `sh_degree` are read too, and, where gaussians
            are refined, `refine_spare`.
        rng: read by "random" only.
        complete: from the cloud of the views that of the whole room.

    Raises:
        ValueError: a number of the settings is out of its range, or `init` is none of these.

    Source: paper, "Geometry-Regularized 3DGS Scene Reconstruction"; "flat" is ours.
    """
    check_fit(settings)
    cloud = complete(surface_cloud(views, settings.spacing, settings.detail_spacing))
    n = len(cloud.points)
    size = np.column_stack([cloud.extents, cloud.extents.mean(axis=1)])
    points, colors, quats, opacity = cloud.points, cloud.colors, np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)), settings.opacity
    match settings.init:
        case "flat":
            size[:, 2] = cloud.spacings * NORMAL
            quats = quats_from_normals(cloud.normals)
        case "isotropic":
            size = np.repeat(size[:, 2:], 3, axis=1)
        case "random":
            low, high = (points.min(0), points.max(0)) if n else (np.zeros(3), np.zeros(3))
            points, colors, opacity = low + rng.random((n, 3)) * (high - low), rng.random((n, 3)), RANDOM_OPACITY
    opacities = np.where(cloud.shown | (settings.init == "random"), opacity, max(opacity, HIDDEN_OPACITY))
    sh = np.zeros((n, (settings.sh_degree + 1) ** 2, 3))
    sh[:, 0] = (colors - 0.5) / SH_C0
    gaussians = Gaussians(
        means=points.astype(np.float32),
        quats=quats.astype(np.float32),
        log_scales=np.log(size).astype(np.float32),
        opacity_logits=np.log(opacities / (1 - opacities)).astype(np.float32),
        sh=sh.astype(np.float32),
    )
    return with_spare(gaussians, settings.refine_spare) if settings.refine_every > 0 else gaussians


def with_spare(gaussians: Gaussians, share: float) -> Gaussians:
    """The gaussians (NumPy) and a share of them more that no view shows: refinement gives those away first."""
    n = len(gaussians.opacity_logits)
    spare = int(share * n)
    rows = np.concatenate([np.arange(n), np.arange(spare) * n // max(spare, 1)])
    gaussians = jax.tree.map(lambda leaf: leaf[rows], gaussians)
    gaussians.opacity_logits[n:] = CULLED_LOGIT
    return gaussians


def quats_from_normals(normals: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 4"]:
    """Unit quaternions (wxyz) of the shortest rotations that take the z axis to unit normals (to -z: half a turn about x)."""
    x, y, z = normals.T
    quats = np.stack([1 + z, -y, x, np.zeros_like(z)], axis=1)  # (1 + z . n, z cross n)
    quats = np.where((z < -1 + 1e-9)[:, None], [0.0, 1.0, 0.0, 0.0], quats)
    return quats / np.linalg.norm(quats, axis=1, keepdims=True)


def depth_normals(view: TrainingView) -> Float[np.ndarray, "h w 3"]:
    """World normals of the scaffold from its depth, facing the camera: differences to the neighbour whose depth is nearer.

    Beside a depth edge that neighbour is on the same surface. Where no neighbour is hit, the normal faces the camera.
    """
    points = unproject_depth(view.camera, view.depth)
    along = [_nearer_difference(points, view.depth, axis) for axis in (0, 1)]
    normal = np.cross(along[0], along[1])
    to_camera = points - unproject_depth(view.camera, np.zeros_like(view.depth))
    normal = np.where((normal * to_camera).sum(-1, keepdims=True) > 0, -normal, normal)
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    facing = -camera_rotation(view.camera)[2]
    return np.where(length > 0, normal / np.where(length > 0, length, 1), facing)


def _nearer_difference(points, depth, axis: int):
    """Difference along an image axis, ahead or back, whichever crosses the smaller step in depth; 0 where neither exists."""
    pad = [(0, 0), (0, 0)]
    pad[axis] = (1, 1)
    bounded = np.pad(np.where(depth > 0, depth, np.nan), pad, constant_values=np.nan)
    step = np.nan_to_num(np.abs(np.diff(bounded, axis=axis)), nan=np.inf)
    move = np.pad(np.diff(points, axis=axis), [*pad, (0, 0)])
    size = depth.shape[axis]
    back, ahead = (np.take(step, range(i, i + size), axis) for i in (0, 1))
    move_back, move_ahead = (np.take(move, range(i, i + size), axis) for i in (0, 1))
    nearer = np.where((ahead <= back)[..., None], move_ahead, move_back)
    return np.where(np.isfinite(np.minimum(back, ahead))[..., None], nearer, 0.0)


def _detailed(view: TrainingView) -> np.ndarray:
    """[h, w] bool: pixels of what has detail, and those of which something much farther away is near on the image."""
    reach = max(round(BESIDE * view.camera.width), 1)
    farthest = maximum_filter(view.depth, size=2 * reach + 1)
    beside = farthest > view.depth * (1 + RELATIVE_DROP) + DROP
    return beside if view.detailed is None else beside | view.detailed


def _with_all_colors(cloud: Cloud) -> Cloud:
    """The cloud with its NaN colours taken from the nearest others; mid grey where no point has one."""
    known = ~np.isnan(cloud.colors[:, 0])
    if known.all():
        return cloud
    colors = np.where(known[:, None], cloud.colors, 0.5)
    if known.any():
        places = np.concatenate([cloud.points, _TURN * cloud.normals], axis=1)
        _, found = KDTree(places[known]).query(places[~known], k=min(_LOOKALIKES, int(known.sum())))
        nearest = np.asarray(found).reshape(int((~known).sum()), -1)
        colors[~known] = cloud.colors[known][nearest].mean(axis=1)
    return dataclasses.replace(cloud, colors=colors)


def _cells(points, normals, spacing, fine):
    """One integer per point: is its cell fine, which cell, and to which of the six axis directions its normal is nearest."""
    index = np.floor(points / spacing[:, None] + _SHIFT).astype(np.int64) + (1 << (_BITS - 1))
    if index.size and (index.min() < 0 or index.max() >= 1 << _BITS):
        raise ValueError(
            f"the surface reaches {np.abs(points).max():.3g} m from the origin: with {spacing.min()} m spacing at most "
            f"{spacing.min() * 2 ** (_BITS - 1):.3g} m are covered"
        )
    axis = np.abs(normals).argmax(axis=1)
    facing = 2 * axis + (np.take_along_axis(normals, axis[:, None], axis=1)[:, 0] > 0)
    x, y, z = index.T
    return (((fine << _BITS | x) << _BITS | y) << _BITS | z) << 3 | facing


class _SumsByKey:
    """Sums of rows by key. Memory is bounded by a few times what there are keys, and sorting by a few times what arrives."""

    def __init__(self, columns: int) -> None:
        self._folded, self._pending, self._waiting = (np.zeros(0, np.int64), np.zeros((0, columns))), [], 0

    def add(self, keys, rows) -> None:
        """Adds rows of keys, pixel by pixel: most have the key of the one before."""
        self._pending.append(_fold(keys, rows, np.arange(len(keys))))
        self._waiting += len(self._pending[-1][0])
        if self._waiting > len(self._folded[0]):
            self.sums()

    def sums(self):
        """Keys in ascending order, and the sum of the rows of each."""
        keys, rows = (np.concatenate(parts) for parts in zip(self._folded, *self._pending))
        self._folded, self._pending, self._waiting = _fold(keys, rows, np.argsort(keys, kind="stable")), [], 0
        return self._folded


def _fold(keys, rows, order):
    """In an order, rows of equal keys that follow each other, summed: a sparse matrix of ones does it four times as fast as
    `np.add.reduceat` along the first axis."""
    keys = keys[order]
    first = np.flatnonzero(np.diff(keys, prepend=keys[:1] - 1))
    sums = csr_array((np.ones(len(keys)), order, np.append(first, len(keys))), shape=(len(first), len(keys)))
    return keys[first], sums @ rows
