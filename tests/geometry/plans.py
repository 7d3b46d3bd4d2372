"""Floor plans for tests: small ones by hand, and random ones of any size by guillotine cuts."""

import dataclasses
import itertools

import numpy as np
import shapely

from wm.geometry.plan.loading import FloorPlan, Opening, Room, parse_plan, plan_to_json
from wm.geometry.plan.walls import plan_walls


def rectangle(name: str, x0: float, y0: float, x1: float, y1: float, *openings: Opening, height: float = 2.8) -> Room:
    return Room(name, name.title(), np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], float), float(height), openings)


def opening(kind: str, start, end, position: float, width: float = 0.9, height: float = 2.1, sill: float = 0.0) -> Opening:
    return Opening(kind, np.array([start, end], float), float(position), float(width), float(height), float(sill))


def window(start, end, position: float, width: float = 1.5) -> Opening:
    return opening("window", start, end, position, width, 1.2, 0.9)


def one_room() -> FloorPlan:
    """5 x 4 m, closed: no door, no window."""
    return FloorPlan((rectangle("cell", 0, 0, 5, 4),))


def two_rooms() -> FloorPlan:
    """A hall of 5 x 4 m and a study of 4 x 4 m, one door between them, a window in either."""
    hall = rectangle("hall", 0, 0, 5, 4, opening("door", (5, 0), (5, 4), 1.5), window((0, 0), (5, 0), 1.75))
    study = rectangle("study", 5, 0, 9, 4, window((9, 0), (9, 4), 1.25))
    return FloorPlan((hall, study))


def l_shaped() -> FloorPlan:
    """An L-shaped hall around a higher library; a passage and a door between them, walls shared in part with a closet."""
    hall = Room(
        "hall",
        "Hall",
        np.array([[0, 0], [8, 0], [8, 3], [3, 3], [3, 7], [0, 7]], float),
        2.6,
        (opening("passage", (3, 3), (8, 3), 1.5, 1.6, 2.2), window((0, 7), (0, 0), 4.0), opening("door", (3, 7), (0, 7), 1.0)),
    )
    library = rectangle("library", 3, 3, 8, 7, opening("door", (3, 3), (3, 7), 2.0), window((8, 3), (8, 7), 1.2), height=3.4)
    closet = rectangle("closet", 0, 7, 4.5, 9, opening("door", (4.5, 7), (3, 7), 0.2))
    return FloorPlan((hall, library, closet))


def random_plan(seed: int, rooms: int) -> FloorPlan:
    """A plan of `rooms` rectangular rooms that keeps every rule: guillotine cuts of a rectangle, doors enough to reach every
    room and some more, listed by one room or both, windows, ceilings of different heights."""
    rng = np.random.default_rng(np.random.SeedSequence([seed, rooms]))
    boxes = _cut(rng, rooms)
    order = rng.permutation(rooms)
    boxes = [boxes[k] for k in order]
    heights = np.round(rng.choice([2.5, 2.8, 3.2], rooms), 2)
    listed: list[list[Opening]] = [[] for _ in range(rooms)]
    joined = np.arange(rooms)
    shared = [touch for touch in _touching(boxes) if np.linalg.norm(touch[2][1] - touch[2][0]) > 1.4]
    for k in rng.permutation(len(shared)):
        a, b, segment = shared[k]
        fresh = joined[a] != joined[b]
        if not fresh and rng.random() > 0.15:
            continue
        joined[joined == joined[b]] = joined[a]
        length = float(np.linalg.norm(segment[1] - segment[0]))
        kind, width = ("passage", 1.0) if rng.random() < 0.2 else ("door", 0.9)
        position = round(float(rng.uniform(0.2, length - 0.2 - width)), 3)
        door = Opening(kind, segment, position, width, 2.1, 0.0)
        listed[a].append(door)
        if rng.random() < 0.5:  # the same door from the other side
            listed[b].append(dataclasses.replace(door, segment=segment[::-1].copy(), position=length - position - width))
    corners = np.array(boxes)
    low, high = corners[:, :2].min(axis=0), corners[:, 2:].max(axis=0)
    for index, (x0, y0, x1, y1) in enumerate(boxes):
        ring = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
        outside = (y0 == low[1], x1 == high[0], y1 == high[1], x0 == low[0])
        for side in np.flatnonzero(outside):
            segment = np.stack([ring[side], ring[(side + 1) % 4]])
            length = float(np.linalg.norm(segment[1] - segment[0]))
            if rng.random() < 0.7:
                listed[index].append(Opening("window", segment, round(length / 2 - 0.5, 3), 1.0, 1.2, 0.9))
    return FloorPlan(
        tuple(
            Room(
                f"room{index}",
                f"Room {index}",
                np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]),
                float(heights[index]),
                tuple(listed[index]),
            )
            for index, (x0, y0, x1, y1) in enumerate(boxes)
        )
    )


def slanted_plan(seed: int, rooms: int) -> FloorPlan:
    """A plan of at most `rooms` rooms with walls at any angle, some concave, doors enough to reach every room, and windows.

    Voronoi cells of random points in a square, some joined; not every draw keeps the rules (cells may be too small).
    """
    rng = np.random.default_rng(np.random.SeedSequence([seed, rooms, 1]))
    side = 4.0 * np.sqrt(rooms)
    square = shapely.box(0, 0, side, side)
    cells = [cell & square for cell in shapely.voronoi_polygons(shapely.MultiPoint(rng.uniform(0, side, (rooms, 2)))).geoms]
    while len(cells) > 2 and rng.random() < 0.5:
        first = cells.pop(int(rng.integers(len(cells))))
        second = max(cells, key=lambda cell: cell.intersection(first).length)
        joined = first | second
        cells = [cell for cell in cells if cell is not second] + ([joined] if not joined.interiors else [first, second])
    rings = [np.asarray(cell.simplify(1e-9).exterior.coords)[:-1] for cell in map(shapely.orient_polygons, cells)]
    bare = FloorPlan(
        tuple(Room(f"room{k}", f"Room {k}", ring, float(rng.choice([2.4, 3.0])), ()) for k, ring in enumerate(rings))
    )
    listed: list[list[Opening]] = [[] for _ in rings]
    joined_to = np.arange(len(rings))
    for wall in itertools.chain(*plan_walls(bare)):
        ends = wall.start, wall.start + wall.length * wall.direction
        if not wall.behind and wall.length > 2.2:
            listed[wall.room].append(window(*ends, wall.length / 2 - 0.5, 1.0))
        for behind in wall.behind:
            if behind.high - behind.low > 1.8 and joined_to[wall.room] != joined_to[behind.room]:
                listed[wall.room].append(opening("door", *ends, (behind.low + behind.high) / 2 - 0.4, 0.8))
                joined_to[joined_to == joined_to[behind.room]] = joined_to[wall.room]
    return FloorPlan(tuple(dataclasses.replace(room, openings=tuple(holes)) for room, holes in zip(bare.rooms, listed)))


def _cut(rng: np.random.Generator, rooms: int) -> list[tuple[float, float, float, float]]:
    """`rooms` boxes, none narrower than 2 m, from a rectangle of about 16 m^2 a room."""
    side = 4.0 * np.sqrt(rooms)
    boxes = [((0.0, 0.0, float(np.round(side * 1.2, 1)), float(np.round(side, 1))), rooms)]
    done = []
    while boxes:
        (x0, y0, x1, y1), count = boxes.pop()
        if count == 1:
            done.append((x0, y0, x1, y1))
            continue
        first = int(rng.integers(max(1, count // 3), count - max(1, count // 3) + 1))
        share = first / count
        if x1 - x0 > y1 - y0:
            cut = float(np.round(x0 + share * (x1 - x0), 1))
            boxes += [((x0, y0, cut, y1), first), ((cut, y0, x1, y1), count - first)]
        else:
            cut = float(np.round(y0 + share * (y1 - y0), 1))
            boxes += [((x0, y0, x1, cut), first), ((x0, cut, x1, y1), count - first)]
    return done


def _touching(boxes: list[tuple[float, float, float, float]]) -> list[tuple[int, int, np.ndarray]]:
    """Pairs of boxes with the segment they share, counter-clockwise for the first."""
    corners = np.array(boxes)
    found = []
    for a, (_, y0, x1, y1) in enumerate(boxes):
        for b in np.flatnonzero(corners[:, 0] == x1):
            low, high = max(y0, corners[b, 1]), min(y1, corners[b, 3])
            if high > low:
                found.append((a, int(b), np.array([[x1, low], [x1, high]])))
    for a, (x0, _, x1, y1) in enumerate(boxes):
        for b in np.flatnonzero(corners[:, 1] == y1):
            low, high = max(x0, corners[b, 0]), min(x1, corners[b, 2])
            if high > low:
                found.append((a, int(b), np.array([[high, y1], [low, y1]])))
    return found


def checked(plan: FloorPlan) -> FloorPlan:
    """The plan after a trip through JSON and all rules."""
    return parse_plan(plan_to_json(plan))
