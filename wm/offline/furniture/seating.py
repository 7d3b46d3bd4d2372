"""Seats: armchair, sofa, chair, office chair, stool, ottoman, bench."""

import numpy as np

from wm.offline.furniture.classical import couch, klismos_armchair, klismos_back, sabre_legs
from wm.offline.furniture.common import finial, frame_wood, leg, legs, tracery
from wm.offline.furniture.outlines import arch, frame, rounded
from wm.offline.furniture.piece import FurnitureKind, Model, Part, Size, of, pick
from wm.offline.furniture.solids import Real, box, extrude, lathe, puff, rod, rounded_box, shift, tube, turn
from wm.offline.style.finish import Style


def lounge(style: Style, rng: np.random.Generator, size: Size, seats: int) -> Model:
    """An upholstered seat for one or more: armchair, loveseat, sofa."""
    w, d, h = size
    form = style.form
    wood = frame_wood(style)
    framed = form.legs == "tapered" or form.legs == "hairpin"
    cloth = "leather" if style.family in ("industrial", "cyberpunk") or rng.random() < 0.15 else "fabric"
    foot = {"slab": 0.04, "tapered": 0.16, "hairpin": 0.16, "cabriole": 0.14}.get(form.legs, 0.11)
    seat = 0.44 * form.low
    arm_top = seat + 0.2
    arm = 0.07 if framed else 0.11 + 0.07 * form.softness
    back = 0.16
    soft = 0.02 + 0.04 * form.softness
    parts: list[Part] = legs(style, w - 0.04, d - 0.04, foot + 0.02, 0.055, slot=wood)
    parts += of(cloth, rounded_box((-w / 2 + 0.02, -d / 2 + 0.03, foot), (w / 2 - 0.02, d / 2 - 0.02, seat - 0.12), 0.03))
    parts += arms(style, w, d, foot, arm_top, arm, framed=framed, cloth=cloth, wood=wood)
    inner = w - 2 * arm - 0.008
    pitch = inner / seats
    for k in range(seats):
        x0, x1 = -inner / 2 + k * pitch + 0.003, -inner / 2 + (k + 1) * pitch - 0.003
        parts += of(cloth, rounded_box((x0, -d / 2 + 0.005, seat - 0.135), (x1, d / 2 - back - 0.01, seat), soft))
        parts += lounge_back(style, (x0 + x1) / 2, x1 - x0, d, seat, h, back, soft, cloth=cloth, wood=wood)
    parts += of(
        cloth,
        rounded_box(
            (-w / 2 + 0.025, d / 2 - back * 0.7, foot + 0.02), (w / 2 - 0.025, d / 2, min(arm_top + 0.03, h - 0.1)), 0.03
        ),
    )
    for k in range(seats if seats < 3 else 2):
        if rng.random() < 0.75:
            side = -1 if k == 0 else 1
            upright = turn(turn(puff((-0.19, -0.19, -0.065), (0.19, 0.19, 0.065)), "x", 72), "z", -side * 12)
            x = side * (inner / 2 - 0.22) if seats > 1 else 0.0
            lift = -upright.vertices[:, 2].min() + seat - 0.012
            parts += of("fabric_accent", shift(upright, (x, d / 2 - back - 0.14, lift)), color=pick(rng, style.accents))
    return Model(parts)


def arms(style: Style, w: Real, d: Real, foot: Real, top: Real, arm: Real, *, framed: bool, cloth: str, wood: str) -> list[Part]:
    """Two arms: open wooden ones, rolled or square upholstered ones."""
    parts: list[Part] = []
    for s in (-1.0, 1.0):
        x = s * (w / 2 - arm / 2)
        if framed:
            parts += of(wood, rounded_box((x - 0.035, -d / 2 + 0.02, top - 0.03), (x + 0.035, d / 2 - 0.1, top), 0.014, 1))
            parts += of(wood, tube([(x, -d / 2 + 0.06, foot), (x, -d / 2 + 0.08, top - 0.015)], [0.02, 0.017], 10))
            parts += of(wood, tube([(x, d / 2 - 0.16, foot), (x, d / 2 - 0.14, top - 0.015)], [0.02, 0.017], 10))
            continue
        parts += of(
            cloth,
            rounded_box(
                (x - arm / 2, -d / 2 + 0.02, foot), (x + arm / 2, d / 2 - 0.03, top - 0.01), 0.02 + 0.03 * style.form.softness
            ),
        )
        if style.form.softness > 0.55 and style.form.ornament > 0.25:
            roll = arm * 0.62
            parts += of(cloth, tube([(x, -d / 2 + 0.012, top - 0.02), (x, d / 2 - 0.05, top - 0.02)], roll, 16))
            parts += of(wood, tube([(x, -d / 2, top - 0.02), (x, -d / 2 + 0.02, top - 0.02)], roll * 0.45, 14))
    return parts


def lounge_back(
    style: Style, x: Real, width: Real, d: Real, seat: Real, h: Real, back: Real, soft: Real, *, cloth: str, wood: str
) -> list[Part]:
    """The back of one seat: a padded arch in a carved frame, or a leaning cushion."""
    kind = {"pointed_arch": "pointed", "round_arch": "round", "wave": "wave"}.get(style.form.back)
    if kind:
        tall = h - seat + 0.14
        outline = arch(kind, width + 0.03, tall, at=(x, seat - 0.14))
        carved = extrude(frame(outline, 0.045), d / 2 - back * 0.62, d / 2 - 0.006, "y")
        pad = extrude(outline.buffer(-0.04), d / 2 - back * 0.5, d / 2 - 0.02, "y")
        swell = extrude(outline.buffer(-0.075), d / 2 - back * 0.72, d / 2 - 0.03, "y")
        return [*of(wood, carved), *of(cloth, pad, swell)]
    cushion = rounded_box((x - width / 2, d / 2 - back - 0.03, seat - 0.02), (x + width / 2, d / 2 - 0.02, h), soft + 0.015)
    return of(cloth, turn(cushion, "x", -7, (x, d / 2 - back, seat)))


def armchair(style: Style, rng: np.random.Generator, size: Size) -> Model:
    if style.form.back == "klismos":
        return klismos_armchair(style, rng, size, wood=frame_wood(style))
    return lounge(style, rng, size, 1)


def sofa(style: Style, rng: np.random.Generator, size: Size) -> Model:
    if style.form.back == "klismos":
        return couch(style, rng, size, wood=frame_wood(style))
    return lounge(style, rng, size, 2 if size[0] < 1.75 else 3)


def chair(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A dining chair: seat, legs, and a back in the shape of the style."""
    w, d, h = size
    form = style.form
    wood = frame_wood(style)
    seat = 0.46 * form.low
    parts: list[Part] = []
    if form.back == "klismos":
        parts += of(wood, *sabre_legs(w, d, seat))
    else:
        parts += legs(style, w, d, seat - 0.03, 0.042, slot=wood)
    parts += of(wood, rounded_box((-w / 2, -d / 2, seat - 0.05), (w / 2, d / 2, seat), 0.014, 1))
    if form.softness > 0.4:
        parts += of(
            "fabric", puff((-w / 2 + 0.02, -d / 2 + 0.015, seat - 0.015), (w / 2 - 0.02, d / 2 - 0.05, seat + 0.045), square=0.25)
        )
    if form.legs in ("turned", "straight") and form.ornament > 0.25:
        z = 0.16
        parts += of(
            wood, *(rod((s * (w / 2 - 0.035), -d / 2 + 0.03, z), (s * (w / 2 - 0.035), d / 2 - 0.03, z), 0.011) for s in (-1, 1))
        )
        parts += of(wood, rod((-w / 2 + 0.035, 0, z), (w / 2 - 0.035, 0, z), 0.011))
    lean = 4 if form.back == "pointed_arch" else 9
    backs = [
        Part(p.slot, turn(p.solid, "x", -lean, (0, d / 2 - 0.02, seat)), p.color) for p in chair_back(style, w, d, seat, h, wood)
    ]
    return Model(parts + backs)


def chair_back(style: Style, w: Real, d: Real, seat: Real, h: Real, wood: str) -> list[Part]:
    """The upright back of a chair from the seat to the height h, before it is tilted."""
    y0, y1 = d / 2 - 0.045, d / 2 - 0.012
    tall = h - seat + 0.02
    kind = style.form.back
    base = seat - 0.02
    if kind == "pointed_arch":
        parts = of(wood, extrude(tracery(w - 0.02, tall, 0.042, at=(0, base)), y0, y1, "y"))
        for s in (-1.0, 1.0):
            parts += of(
                wood,
                box((s * (w / 2 - 0.02) - 0.018, y0 - 0.006, base), (s * (w / 2 - 0.02) + 0.018, y1 + 0.006, base + 0.72 * tall)),
            )
            if style.form.ornament > 0.5:
                parts += of(wood, finial(s * (w / 2 - 0.02), (y0 + y1) / 2, base + 0.72 * tall - 0.003, 0.055))
        return parts
    if kind in ("round_arch", "wave"):
        outline = arch("round" if kind == "round_arch" else "wave", w - 0.02, tall, at=(0, base))
        pad = outline.buffer(-0.035)
        return [
            *of(wood, extrude(frame(outline, 0.045), y0, y1, "y")),
            *of("fabric", extrude(pad, y0 + 0.004, y1 - 0.006, "y"), extrude(pad.buffer(-0.03), y0 - 0.012, y1 - 0.01, "y")),
        ]
    if kind == "klismos":
        return of(wood, *klismos_back(w, d, seat, h))
    posts = [
        tube([(s * (w / 2 - 0.025), d / 2 - 0.03, base), (s * (w / 2 - 0.025), d / 2 - 0.03, h - 0.01)], [0.019, 0.014], 10)
        for s in (-1.0, 1.0)
    ]
    if kind == "slats":
        rails = [
            box((-w / 2 + 0.02, y0 + 0.006, z), (w / 2 - 0.02, y1 - 0.006, z + 0.06), 0.006)
            for z in np.linspace(seat + 0.14, h - 0.08, 3)
        ]
        return of(wood, *posts, *rails)
    if kind == "spindle":
        crest = rounded_box((-w / 2, y0 - 0.004, h - 0.07), (w / 2, y1 + 0.004, h), 0.014, 1)
        bars = [
            tube(
                [(x, d / 2 - 0.03, seat - 0.01), (x, d / 2 - 0.03, seat + 0.5 * (h - seat)), (x, d / 2 - 0.03, h - 0.06)],
                [0.007, 0.011, 0.007],
                8,
                smooth=2,
            )
            for x in np.linspace(-w / 2 + 0.08, w / 2 - 0.08, 5)
        ]
        return of(wood, *posts, crest, *bars)
    panel = extrude(rounded(w - 0.03, 0.55 * tall, 0.05, at=(0, h - 0.55 * tall)), y0, y1, "y")
    return [*of(wood, *posts), *of("fabric" if style.form.softness > 0.5 else wood, panel)]


def office_chair(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A swivel chair: five-spoked base on castors, gas column, padded seat and back, arms."""
    w, d, h = size
    seat, radius = 0.48, min(w, d) / 2 - 0.03
    parts: list[Part] = []
    for k in range(5):
        angle = 2 * np.pi * (k + 0.25) / 5
        x, y = radius * float(np.cos(angle)), radius * float(np.sin(angle))
        parts += of("chrome", tube([(0, 0, 0.1), (x, y, 0.065)], [0.025, 0.014], 8))
        wheel = turn(turn(lathe([(0.026, -0.016), (0.028, 0.0), (0.026, 0.016)], 12), "x", 90), "z", float(np.degrees(angle)))
        parts += of("dark_metal", shift(wheel, (x, y, 0.028)))
    parts += of("chrome", lathe([(0.032, 0.06), (0.032, 0.2), (0.02, 0.2), (0.02, seat - 0.07)], 16))
    cloth = "leather" if style.form.ornament > 0.15 else "fabric"
    parts += of(cloth, rounded_box((-w * 0.38, -d * 0.4, seat - 0.08), (w * 0.38, d * 0.34, seat), 0.035))
    rest = rounded_box((-w * 0.35, d * 0.3, seat + 0.12), (w * 0.35, d * 0.3 + 0.07, h), 0.033)
    parts += of(cloth, turn(rest, "x", -8, (0, d * 0.3, seat)))
    parts += of(
        "dark_metal", tube([(0, d * 0.1, seat - 0.075), (0, d * 0.33, seat - 0.06), (0, d * 0.4, seat + 0.2)], 0.018, 8, smooth=2)
    )
    for s in (-1.0, 1.0):
        x = s * w * 0.42
        parts += of(
            "dark_metal",
            tube([(s * w * 0.3, 0.02, seat - 0.06), (x, 0.02, seat - 0.03), (x, 0.02, seat + 0.19)], 0.013, 8, smooth=2),
        )
        parts += of("dark_metal", rounded_box((x - 0.035, -0.13, seat + 0.18), (x + 0.035, 0.15, seat + 0.21), 0.014, 1))
    return Model(parts)


def stool(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A round seat on four legs."""
    w, _, h = size
    parts = legs(style, w * 0.7, w * 0.7, h - 0.03, 0.04, slot=frame_wood(style))
    parts += of(
        frame_wood(style), lathe([(w / 2 - 0.01, h - 0.045), (w / 2, h - 0.035), (w / 2, h - 0.012), (w / 2 - 0.012, h)], 24)
    )
    return Model(parts)


def ottoman(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A padded footstool."""
    w, d, h = size
    parts = legs(style, w, d, 0.1, 0.045, slot=frame_wood(style))
    parts += of("fabric", rounded_box((-w / 2, -d / 2, 0.08), (w / 2, d / 2, h - 0.05), 0.04))
    return Model(
        parts
        + of("fabric", puff((-w / 2 + 0.005, -d / 2 + 0.005, h - 0.14), (w / 2 - 0.005, d / 2 - 0.005, h), square=0.2, flat=0.6))
    )


def bench(style: Style, rng: np.random.Generator, size: Size) -> Model:
    """A long seat without a back: marble for the ancients, a board with a cushion for others."""
    w, d, h = size
    if style.form.legs == "column":
        parts = of("marble", box((-w / 2, -d / 2, h - 0.08), (w / 2, d / 2, h), 0.012))
        for s in (-1.0, 1.0):
            parts += of(
                "marble",
                extrude(
                    [
                        (-0.16, 0.0),
                        (0.16, 0.0),
                        (0.11, 0.08),
                        (0.08, h - 0.14),
                        (0.14, h - 0.07),
                        (-0.14, h - 0.07),
                        (-0.08, h - 0.14),
                        (-0.11, 0.08),
                    ],
                    s * (w / 2 - 0.22) - 0.06,
                    s * (w / 2 - 0.22) + 0.06,
                    "x",
                ),
            )
        return Model(parts)
    wood = frame_wood(style)
    parts = legs(style, w, d, h - 0.08, 0.06, slot=wood) + of(
        wood, box((-w / 2, -d / 2, h - 0.09), (w / 2, d / 2, h - 0.04), 0.006)
    )
    if w > 1.3 and style.form.legs not in ("hairpin", "slab"):
        for y in (-d / 2 + 0.05, d / 2 - 0.05):
            parts += of(wood, *leg(style.form.legs, 0.0, y, h - 0.08, 0.055))
    return Model(
        parts + of("fabric", rounded_box((-w / 2 + 0.015, -d / 2 + 0.01, h - 0.045), (w / 2 - 0.015, d / 2 - 0.01, h), 0.02))
    )


KINDS = {
    "armchair": FurnitureKind(armchair, "floor", (0.78, 0.78, 0.86), (0.92, 0.9, 1.05), front=0.4),
    "sofa": FurnitureKind(sofa, "floor", (1.55, 0.82, 0.8), (2.2, 0.95, 0.95), front=0.4),
    "chair": FurnitureKind(chair, "floor", (0.43, 0.46, 0.88), (0.48, 0.52, 1.02), front=0.0),
    "office chair": FurnitureKind(office_chair, "floor", (0.6, 0.6, 0.95), (0.66, 0.66, 1.12)),
    "stool": FurnitureKind(stool, "floor", (0.34, 0.34, 0.44), (0.4, 0.4, 0.5)),
    "ottoman": FurnitureKind(ottoman, "floor", (0.5, 0.45, 0.38), (0.7, 0.55, 0.44)),
    "bench": FurnitureKind(bench, "floor", (1.0, 0.38, 0.43), (1.4, 0.45, 0.48)),
}
