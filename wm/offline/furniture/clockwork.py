"""Clockwork: gear trains, a skeleton clock, an orrery, pipes. The teeth of neighbouring wheels mesh."""

import dataclasses
import itertools
import math

import numpy as np

from wm.offline.furniture.common import COLUMN, frame_wood
from wm.offline.furniture.outlines import circle, gear, meshed
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of
from wm.offline.furniture.solids import Point3, Real, Solid, ball, box, extrude, lathe, rod, shift, tube, turn
from wm.offline.furniture.walls import dial
from wm.offline.style.finish import Rgb, Style

COPPER: Rgb = (0.68, 0.40, 0.25)
VERDIGRIS: Rgb = (0.36, 0.56, 0.48)
METALS: tuple[tuple[str, Rgb | None], ...] = (("brass", None), ("brass", COPPER), ("brass", VERDIGRIS), ("dark_metal", None))
"""Slots and colours of wheels: brass, copper, green copper, iron."""


@dataclasses.dataclass(frozen=True)
class Wheel:
    """A wheel of a train, in the train's plane."""

    x: float
    z: float
    radius: float  # of the pitch circle
    teeth: int
    turned: float
    metal: int  # index into METALS


def train(rng: np.random.Generator, first: Wheel, links: tuple[tuple[int, float, float], ...]) -> list[Wheel]:
    """The wheels of a gear train.

    Args:
      links: for each wheel after the first: the index of the wheel that drives it, its number of teeth relative to that of the
        first wheel, and its direction from the driving wheel in degrees.
    """
    wheels = [first]
    for k, (index, share, degrees) in enumerate(links):
        driver = wheels[index]
        teeth = max(8, round(share * first.teeth))
        radius = driver.radius * teeth / driver.teeth
        towards = math.radians(degrees + float(rng.uniform(-8, 8)))
        reach = driver.radius + radius
        x, z = driver.x + reach * math.cos(towards), driver.z + reach * math.sin(towards)
        wheels.append(
            Wheel(x, z, radius, teeth, meshed(driver.turned, driver.teeth, teeth, towards), (first.metal + k + 1) % len(METALS))
        )
    return wheels


def fitted(wheels: list[Wheel], w: Real, h: Real) -> list[Wheel]:
    """The train scaled to fit a width and a height, centred horizontally, with its lowest tooth at height 0."""
    tip = [1 + 2.0 / wheel.teeth for wheel in wheels]
    low_x = min(wheel.x - t * wheel.radius for wheel, t in zip(wheels, tip))
    high_x = max(wheel.x + t * wheel.radius for wheel, t in zip(wheels, tip))
    low_z = min(wheel.z - t * wheel.radius for wheel, t in zip(wheels, tip))
    high_z = max(wheel.z + t * wheel.radius for wheel, t in zip(wheels, tip))
    scale = min(w / (high_x - low_x), h / (high_z - low_z))
    middle = (low_x + high_x) / 2
    return [dataclasses.replace(k, x=(k.x - middle) * scale, z=(k.z - low_z) * scale, radius=k.radius * scale) for k in wheels]


def wheels_upright(wheels: list[Wheel], y: Real, thick: Real, back: Real) -> list[Part]:
    """The wheels upright in the plane y, `thick` deep. Each has a boss and an axle that extends to y = `back`."""
    parts: list[Part] = []
    for k in wheels:
        slot, color = METALS[k.metal]
        spokes = 6 if k.teeth > 20 else (5 if k.teeth > 13 else 4)
        outline = gear(k.radius, k.teeth, turned=k.turned, at=(k.x, k.z), spokes=spokes)
        parts += of(slot, extrude(outline, y - thick / 2, y + thick / 2, "y"), color=color)
        boss = lathe([(0.2 * k.radius, -0.75 * thick), (0.17 * k.radius, 0.9 * thick), (0.09 * k.radius, 1.1 * thick)], 16)
        parts += of("dark_metal", shift(turn(boss, "x", 90), (k.x, y, k.z)))
        parts += of("dark_metal", rod((k.x, y, k.z), (k.x, back, k.z), 0.35 * thick + 0.05 * k.radius))
    return parts


def wall_gears(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A gear train of wheels of different sizes on the wall."""
    w, d, h = size
    first = Wheel(0.0, 0.0, 1.0, int(rng.integers(22, 29)), float(rng.uniform(0, 1)), 0)
    links = ((0, 0.6, 28.0), (1, 0.42, -48.0), (0, 0.4, 140.0 if rng.random() < 0.5 else 205.0))
    wheels = fitted(train(rng, first, links), w, h)
    if rng.random() < 0.5:
        wheels = [dataclasses.replace(k, x=-k.x, turned=math.pi - k.turned) for k in wheels]
    return Model(wheels_upright(wheels, -0.1 * d, 0.028, d / 2))


def skeleton_clock(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A large wall clock with a visible movement: chapter ring, twelve hours, hands, and wheels behind them."""
    w, d, _ = size
    r, back = w / 2, d / 2
    parts = of("brass", ring(r, 0.94 * r, -0.5 * d, back), ring(0.58 * r, 0.54 * r, -0.42 * d, back - 0.004))
    parts += of("paper", ring(0.95 * r, 0.57 * r, -0.3 * d, back - 0.002))
    for k in range(60):
        long = 0.035 if k % 5 else 0.05
        mark = box((-0.004 * r, -0.34 * d, (0.92 - long) * r), (0.004 * r, -0.26 * d, 0.92 * r), 0.0)
        parts += of("dark_metal", turn(mark, "y", 6.0 * k))
    for k in range(12):
        bars = 1 if k % 3 else 2
        for j in range(bars):
            x = (j - (bars - 1) / 2) * 0.05 * r
            mark = box((x - 0.016 * r, -0.36 * d, 0.64 * r), (x + 0.016 * r, -0.26 * d, 0.83 * r), 0.0)
            parts += of("dark_metal", turn(mark, "y", 30.0 * k))
    movement = train(rng, Wheel(0.0, 0.0, 1.0, 24, 0.1, 1), ((0, 0.55, 35.0), (0, 0.5, 160.0), (0, 0.6, 275.0)))
    scale = 0.24 * r
    movement = [dataclasses.replace(k, x=k.x * scale, z=k.z * scale, radius=k.radius * scale) for k in movement]
    parts += wheels_upright(movement, 0.12 * d, 0.014, back)
    minute = float(rng.uniform(0, 360))
    hour = 30.0 * int(rng.integers(12)) + minute / 12
    for angle, long, y in ((hour, 0.66, -0.4), (minute, 0.9, -0.46)):
        half = [(0.022, -0.18), (0.022, 0.6 * long), (0.065, 0.72 * long), (0.0, long)]
        hand = [(r * a, r * b) for a, b in (*half, *((-a, b) for a, b in half[2::-1]))]
        parts += of("soot", turn(extrude(hand, y * d, (y + 0.05) * d, "y"), "y", angle))
    parts += of("brass", shift(turn(lathe([(0.05 * r, 0.0), (0.03 * r, 0.12 * d)], 16), "x", 90), (0, -0.38 * d, 0)))
    return Model([Part(p.slot, shift(p.solid, (0, 0, r)), p.color) for p in parts])


def ring(outer: Real, inner: Real, y0: Real, y1: Real) -> Solid:
    """A flat ring about the origin that faces -y."""
    return extrude(circle(outer, segments=48).difference(circle(inner, segments=48)), y0, y1, "y")


def orrery(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A model of the planets on a stand: a glowing sun, worlds on arms, hoops about them, driven by wheels below."""
    w, _, h = size
    reach, level = w / 2 - 0.02, 0.72 * h
    wood = frame_wood(style)
    parts = of(wood, lathe([(0.34 * w, 0.0), (0.33 * w, 0.03), (0.24 * w, 0.05), (0.22 * w, 0.075)], 28))
    parts += of(wood, lathe([(0.05 * q + 0.012, 0.07 + z * (level - 0.34)) for q, z in COLUMN], 18))
    for k, (radius, teeth, z) in enumerate(((0.21 * w, 26, level - 0.26), (0.14 * w, 18, level - 0.21))):
        slot, color = METALS[k]
        parts += of(slot, extrude(gear(radius, teeth, turned=0.2 * k), z, z + 0.022, "z"), color=color)
    parts += of("brass", rod((0, 0, level - 0.3), (0, 0, level), 0.011))
    parts += of("bulb", ball((0, 0, level), 0.11 * w, 20))
    worlds = ((0.34, 0.035), (0.52, 0.045), (0.7, 0.06), (0.86, 0.05))
    for k, (share, radius) in enumerate(worlds):
        a = float(rng.uniform(0, 2 * math.pi))
        x, y, z = share * reach * math.cos(a), share * reach * math.sin(a), level - 0.15 + 0.025 * k
        parts += of("brass", tube([(0, 0, z - 0.03), (0.9 * x, 0.9 * y, z - 0.03), (x, y, z)], 0.005, 6, smooth=1))
        parts += of("brass", rod((x, y, z - 0.01), (x, y, level), 0.004, 6))
        parts += of("ceramic", ball((x, y, level), radius * w, 14), color=style.accents[k % len(style.accents)])
    turns = np.linspace(0.02, 2 * math.pi, 45)
    hoop = tube(np.stack([reach * np.cos(turns), reach * np.sin(turns), 0 * turns], -1), 0.008, 6)
    parts += of("brass", shift(turn(hoop, "x", 23), (0, 0, level)))
    parts += of("brass", shift(turn(turn(hoop, "y", 90), "z", 40), (0, 0, level)), color=COPPER)
    return Model(parts)


def gear_sculpture(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A great wheel on a plinth, with others in mesh above it."""
    w, d, h = size
    plinth = 0.2 * h
    wood = frame_wood(style)
    parts = of(wood, box((-w / 2, -d / 2, 0.0), (w / 2, d / 2, 0.06), 0.012))
    parts += of(wood, box((-0.44 * w, -0.42 * d, 0.055), (0.44 * w, 0.42 * d, plinth), 0.008))
    parts += of("brass", box((-0.46 * w, -0.46 * d, plinth - 0.03), (0.46 * w, 0.46 * d, plinth), 0.006))
    first = Wheel(0.0, 0.0, 1.0, int(rng.integers(24, 29)), float(rng.uniform(0, 1)), 0)
    wheels = fitted(train(rng, first, ((0, 0.55, 62.0), (1, 0.4, 125.0))), 0.96 * w, h - plinth - 0.02)
    wheels = [dataclasses.replace(k, z=k.z + plinth + 0.015) for k in wheels]
    parts += wheels_upright(wheels, -0.02, 0.04, 0.07)
    big = wheels[0]
    for s in (-1.0, 1.0):  # the trestle that carries the axles
        foot = (big.x + s * 0.3 * w, 0.07, plinth - 0.02)
        parts += of("dark_metal", rod(foot, (big.x, 0.07, big.z), 0.018))
    for a, b in itertools.pairwise(wheels):
        parts += of("dark_metal", rod((a.x, 0.07, a.z), (b.x, 0.07, b.z), 0.015))
    return Model(parts)


def wall_pipes(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """Copper pipes up a wall, with flanges, a hand wheel and a gauge."""
    w, d, h = size
    parts: list[Part] = []
    count = max(3, round(w / 0.16))
    for k in range(count):
        x, r = (k + 0.5 - count / 2) * (w - 0.08) / count, (0.028, 0.04, 0.022)[k % 3]
        color = (COPPER, None, VERDIGRIS)[k % 3]
        y, top = d / 2 - 0.02 - r, h * (1.0, 0.86, 0.93)[k % 3]
        path: list[Point3] = [(x, y, 0.0), (x, y, top - 0.08), (x, y + 0.02, top)]
        parts += of("brass", tube(path, r, 12, smooth=2), color=color)
        for z in (0.12, 0.5, 0.82):
            flange = lathe([(1.45 * r, -0.016), (1.5 * r, 0.0), (1.45 * r, 0.016)], 14)
            parts += of("dark_metal", shift(flange, (x, y, z * top)))
            parts += of("dark_metal", box((x - 0.012, y, z * top + 0.03), (x + 0.012, d / 2, z * top + 0.05), 0.0))
    cross = h * 0.36
    parts += of("brass", rod((-w / 2 + 0.03, d / 2 - 0.06, cross), (w / 2 - 0.03, d / 2 - 0.06, cross), 0.02, 10), color=COPPER)
    hub = (0.22 * w, -d / 2 + 0.02, cross)
    parts += of("dark_metal", rod((hub[0], d / 2 - 0.06, cross), hub, 0.01))
    spoked = gear(0.09, 12, spokes=4, tooth=0.012)
    parts += of("brass", shift(extrude(spoked, -0.009, 0.009, "y"), hub), color=(0.55, 0.2, 0.14))
    gauge = dial(0.1, (-0.2 * w, -d / 2 + 0.03, 0.62 * h))
    parts += of("dark_metal", rod((-0.2 * w, d / 2 - 0.05, 0.62 * h), (-0.2 * w, -d / 2 + 0.03, 0.62 * h), 0.03))
    return Model(parts + gauge)


KINDS = {
    "wall gears": FurnitureKind(wall_gears, "wall", (0.85, 0.09, 0.7), (1.3, 0.12, 1.0)),
    "skeleton wall clock": FurnitureKind(skeleton_clock, "wall", (0.8, 0.1, 0.8), (1.15, 0.12, 1.15)),
    "wall pipes": FurnitureKind(wall_pipes, "wall", (0.5, 0.16, 1.3), (0.8, 0.2, 1.9)),
    "orrery": FurnitureKind(orrery, "floor", (0.7, 0.7, 1.3), (0.9, 0.9, 1.5)),
    "gear sculpture": FurnitureKind(gear_sculpture, "floor", (0.7, 0.34, 1.3), (0.95, 0.4, 1.7)),
}
