"""What each type of room is for: which functional groups it gets, in which order."""

import math
from collections.abc import Callable

import numpy as np
import shapely

from wm.geometry.plan.site import Site
from wm.offline.arrangement.groups import around_table, dining_group, hearth, rug_under, sitting, sleeping
from wm.offline.arrangement.hangings import wall_piece
from wm.offline.arrangement.job import Job, local
from wm.offline.arrangement.layout import Placed
from wm.offline.arrangement.wet_groups import bathing, cooking, island
from wm.offline.style.finish import PERIOD


def bedroom(job: Job) -> None:
    sleeping(job)
    job.at_wall("wardrobe", where="corner")
    if job.layout.site.polygon.area > 15 and job.chance(0.6):
        writing(job, at_wall=True)


def living(job: Job) -> None:
    sitting(job, hearth(job))


def dining(job: Job) -> None:
    dining_group(job)
    if job.style.form.ornament > 0.5 and job.chance(0.7):
        hearth(job) if job.style.family in PERIOD else None


def kitchen(job: Job) -> None:
    cooking(job)
    if job.layout.site.polygon.area > 9:
        placed = island(job) if job.chance(0.45) else None
        if placed is None:
            dining_group(job, kitchen=True)


def bathroom(job: Job) -> None:
    bathing(job)


def library(job: Job) -> None:
    for _ in range(2):
        job.at_wall("bookshelf", where="any")
    if job.style.form.ornament > 0.5:
        focus = hearth(job) if job.style.family in PERIOD and job.chance(0.6) else None
        if focus is not None:
            sitting(job, focus)
        else:
            around_table(job)
    else:
        around_table(job)
    if job.chance(0.7):
        writing(job, at_wall=False)


def study(job: Job) -> None:
    writing(job, at_wall=job.layout.site.polygon.area < 9 or job.rng.random() < 0.4)
    centre = job.layout.site.centre
    rug_under(job, *centre, 0.0, 2.2, 1.6)


def writing(job: Job, *, at_wall: bool) -> Placed | None:
    """A desk with its chair: facing a wall, or free in the room with the chair behind it."""
    seat = job.piece("office chair" if job.style.family not in PERIOD else "chair")
    table = job.piece("desk")
    mates = frozenset({"office chair", "chair"})
    deep, sit = float(table.size[1]), float(seat.size[1])
    placed = None
    if not at_wall:
        # the desk's front, where one sits, faces the wall: its back shows to the room
        site = job.layout.site
        for k in sorted(range(len(site.lengths)), key=lambda k: -float(site.lengths[k]) + float(job.rng.uniform(0, 2))):
            normal, middle = site.normals[k], site.starts[k] + 0.5 * site.lengths[k] * site.directions[k]
            x, y = (middle + (1.15 + deep / 2) * normal).tolist()
            placed = placed or job.layout.try_at(
                table, x, y, math.atan2(-float(normal[0]), float(normal[1])), front=0.75, mates=mates
            )
    if placed is None:
        placed = job.layout.against_wall(table, job.rng, front=0.75, where="centre", mates=mates)
    if placed is None:
        return None
    job.dressed(placed)
    x, y = local(placed, float(job.rng.uniform(-0.1, 0.05)), -(deep + sit) / 2 - 0.04)
    job.layout.try_at(seat, x, y, placed.yaw + math.pi + math.radians(float(job.rng.uniform(-3, 3))))
    return placed


def hall(job: Job) -> None:
    site = job.layout.site
    if site.polygon.area > 22 and job.style.form.ornament > 0.3:
        focus = hearth(job) if job.style.family in PERIOD else None
        if job.chance(0.8):
            sitting(job, focus)
    elif site.polygon.area > 10 and job.chance(0.7):
        job.dressed(job.layout.on_floor(job.piece("round table"), job.rng, site.centre, yaw=0.0, radius=1.2))
    if site.polygon.area > 7:
        rug_under(job, *site.centre, long_way(site), 2.4, 1.7)


def gallery(job: Job) -> None:
    site = job.layout.site
    if site.polygon.area > 12 and job.chance(0.8):
        job.layout.on_floor(job.piece("bench"), job.rng, site.centre, yaw=long_way(site), radius=1.5)
    rug_under(job, *site.centre, long_way(site), 2.6, 1.4)


def corridor(job: Job) -> None:
    site = job.layout.site
    box = site.polygon.minimum_rotated_rectangle
    sides = (
        sorted(np.linalg.norm(np.diff(np.asarray(box.exterior.coords), axis=0), axis=1).tolist())
        if isinstance(box, shapely.Polygon)
        else [1.0]
    )
    width = 2 * float(shapely.maximum_inscribed_circle(site.polygon, tolerance=0.02).length)
    rug_under(job, *site.centre, long_way(site), min(0.7 * sides[-1], 4.0), max(min(width - 0.5, 1.1), 0.45))
    for _ in range(2):
        wall_piece(job, "wall sconce", 1.75)


def utility(job: Job) -> None:
    writing(job, at_wall=True)
    job.at_wall("bookshelf", where="any")
    wall_piece(job, "wall shelf", 1.55)


def other(job: Job) -> None:
    sitting(job, hearth(job) if job.style.family in PERIOD else None)


def long_way(site: Site) -> float:
    """Direction (radians) of the longest wall."""
    k = int(np.argmax(site.lengths))
    return math.atan2(float(site.directions[k, 1]), float(site.directions[k, 0]))


PROGRAMME: dict[str, Callable[[Job], None]] = {
    "bedroom": bedroom, "living": living, "dining": dining, "kitchen": kitchen, "bathroom": bathroom, "library": library,
    "study": study, "hall": hall, "gallery": gallery, "corridor": corridor, "utility": utility, "other": other,
}  # fmt: skip
