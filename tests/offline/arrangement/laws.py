"""What holds in every furnished room."""

import numpy as np
import shapely
from scipy import ndimage

from wm.geometry.placement.navigation import cells_inside
from wm.offline.arrangement.arrange import scene_object
from wm.schema import NavigationSettings

NAVIGATION = NavigationSettings()


def trunk(placed):
    """What a piece really takes up: the hull of its vertices from above, and its height interval."""
    world = scene_object(placed, 0).vertices
    return shapely.convex_hull(shapely.MultiPoint(world[:, :2])), world[:, 2].min(), world[:, 2].max()


def check_laws(site, placed):
    solids = [trunk(p) for p in placed]
    roomy = site.polygon.buffer(0.001)
    for p, (hull, low, high) in zip(placed, solids):
        name = p.piece.label
        assert roomy.contains(hull) and low > -1e-9 and high < site.ceiling, f"{name} leaves the room"
        assert abs(low - p.z) < 1e-9
        if p.piece.support in ("floor", "flat"):
            assert low < 0.01, f"{name} floats"
        elif p.piece.support == "ceiling":
            assert site.ceiling - high < 0.01, f"{name} hangs on nothing"
        elif p.piece.support == "wall":
            assert shapely.distance(site.polygon.exterior, hull) < 0.01, f"{name} is off its wall"
        else:
            below = [
                q
                for q, (base, _, _) in zip(placed, solids)
                if q is not p and any(abs(q.z + t.z - low) < 0.01 for t in q.piece.tops) and base.contains(hull.centroid)
            ]
            assert below, f"{name} floats"
        if p.piece.support != "flat" and low < 1.9:
            assert not any(zone.intersects(hull) for zone in site.keep), f"{name} stands before a door"
    for i, (p, (a, a0, a1)) in enumerate(zip(placed, solids)):
        for q, (b, b0, b1) in zip(placed[:i], solids[:i]):
            if "flat" in (p.piece.support, q.piece.support) and (p.piece.support != q.piece.support):
                continue  # feet stand 8 mm deep in rugs
            if min(a1, b1) - max(a0, b0) > 0.0 and a.intersects(b):
                raise AssertionError(f"{p.piece.label} and {q.piece.label} share space")
    check_walkable(site, placed, solids)


def check_walkable(site, placed, solids):
    """On the grid of navigation a body of 0.25 m radius reaches every door from every other, and no part of the floor is closed
    off to it: what it cannot reach is less than half a square metre of places for its middle, and 5 % of them. A house's grid
    starts where it likes: so too on that grid half a cell to either side."""
    walkable = site.polygon.buffer(-NAVIGATION.body_radius)
    in_the_way = [hull for p, (hull, low, _) in zip(placed, solids) if p.piece.support == "floor" and low < 1.8]
    blocked = shapely.union_all(in_the_way).buffer(NAVIGATION.body_radius)
    corner = np.array(site.polygon.bounds[:2])
    for shift in np.ndindex(2, 2):
        check_walkable_on(corner - 0.5 * NAVIGATION.cell * np.array(shift), site, walkable, walkable.difference(blocked))


def check_walkable_on(low, site, walkable, unblocked):
    """The same on the grid that starts at one point."""
    columns, rows = (int(n) for n in np.ceil((np.array(site.polygon.bounds[2:]) - low) / NAVIGATION.cell))
    bare, free = (cells_inside(area, low, NAVIGATION.cell, (rows, columns)) for area in (walkable, unblocked))
    labels, _ = ndimage.label(free)
    sizes = np.bincount(labels.ravel())[1:]
    if not len(sizes) or ndimage.label(bare)[1] > 1:
        return
    main = int(np.argmax(sizes)) + 1
    closed = int(sizes.sum() - sizes.max())
    assert closed <= 0.05 * sizes.sum() and closed * NAVIGATION.cell**2 < 0.5
    centres = low + NAVIGATION.cell * (np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), -1) + 0.5)
    for probe in site.probes:
        near = np.abs(centres - probe).max(axis=-1) < 0.2
        assert not bare[near].any() or (labels[near] == main).any(), "a door is blocked"
