"""Moods of a theme: what they make of a style's light, shapes and wear."""

import dataclasses
import math

from wm.offline.style.finish import Finish, Form, Light, Style, Surfaces
from wm.offline.style.style_sheet import mix_rgb, rgb


def relit(light: Light, moods: tuple[str, ...]) -> Light:
    """Time of day, weather, dim and bright, candles and neon."""
    if "night" in moods:
        light = dataclasses.replace(light, sun_color=rgb("b8c8ff"), sun_strength=0.12, sky_color=rgb("3a4a78"), sky_strength=0.2,
                                    lamp_strength=1.0)  # fmt: skip
    elif "dusk" in moods:
        light = dataclasses.replace(
            light,
            sun_color=rgb("ffb070"),
            sun_elevation=math.radians(9),
            sky_color=rgb("e0a8a0"),
            sky_strength=light.sky_strength * 0.7,
            lamp_strength=max(light.lamp_strength, 0.8),
        )
    if "foggy" in moods or "stormy" in moods:
        strength = 0.75 if "foggy" in moods else 0.4
        light = dataclasses.replace(light, sun_strength=0.08 * light.sun_strength, sky_color=rgb("c4ccd4"), sky_strength=strength)
    if "dim" in moods:
        light = dataclasses.replace(light, sun_strength=light.sun_strength * 0.6, sky_strength=light.sky_strength * 0.7)
    if "candlelit" in moods:
        light = dataclasses.replace(light, sun_strength=light.sun_strength * 0.4, sky_strength=light.sky_strength * 0.5,
                                    lamp_color=rgb("ff9d42"), lamp_strength=1.0)  # fmt: skip
    if "neon" in moods:
        outlook = "city" if light.outlook == "country" else light.outlook
        light = dataclasses.replace(light, sky_color=rgb("4a3a8a"), sky_strength=min(light.sky_strength, 0.25), sun_strength=0.05,
                                    lamp_strength=1.0, outlook=outlook)  # fmt: skip
    for mood, color in (("cold", "bcd8ff"), ("warm", "ffc890")):
        if mood in moods:
            light = dataclasses.replace(
                light,
                sun_color=mix_rgb(light.sun_color, rgb(color), 0.4),
                sky_color=mix_rgb(light.sky_color, rgb(color), 0.4),
                lamp_color=mix_rgb(light.lamp_color, rgb(color), 0.4),
            )
    if "bright" in moods:
        light = dataclasses.replace(
            light, sun_strength=min(light.sun_strength * 1.3, 1.0), sky_strength=min(light.sky_strength * 1.2, 1.0)
        )
    return light


def reshaped(form: Form, moods: tuple[str, ...]) -> Form:
    """Finials, mouldings and clutter for "ornate", fewer for "plain"; candles; softer cushions."""
    if "ornate" in moods:
        form = dataclasses.replace(form, ornament=min(form.ornament + 0.3, 1.0))
    elif "plain" in moods:
        form = dataclasses.replace(form, ornament=form.ornament * 0.4)
    if "candlelit" in moods:
        form = dataclasses.replace(form, lamp="candle")
    if "soft" in moods:
        form = dataclasses.replace(form, softness=min(form.softness + 0.3, 1.0))
    return form


def in_mood(style: Style, moods: tuple[str, ...]) -> Style:
    """The style in the moods of its theme."""
    rooms = tuple((kind, _surfaces(own, moods)) for kind, own in style.rooms)
    slots = tuple((name, _finish(own, moods)) for name, own in style.slots)
    return dataclasses.replace(style, light=relit(style.light, moods), form=reshaped(style.form, moods), rooms=rooms, slots=slots)


def _surfaces(own: Surfaces, moods: tuple[str, ...]) -> Surfaces:
    trim = Finish("glow", (rgb("e0309a"),), 0.05) if "neon" in moods else _finish(own.trim, moods)
    wainscot = _finish(own.wainscot, moods) if own.wainscot else None
    return dataclasses.replace(
        own, wall=_finish(own.wall, moods), floor=_finish(own.floor, moods), ceiling=_finish(own.ceiling, moods), trim=trim,
        wainscot=wainscot,
    )  # fmt: skip


def _finish(own: Finish, moods: tuple[str, ...]) -> Finish:
    """Worn, paler, purer or greyer."""
    if own.material == "glow":
        return own
    if "worn" in moods:
        own = dataclasses.replace(
            own, wear=max(own.wear, 0.75), colors=tuple(mix_rgb(c, rgb("6a6052"), 0.18) for c in own.colors)
        )
    for mood, color, share in (("pastel", "ffffff", 0.4), ("muted", "9a9890", 0.35)):
        if mood in moods:
            own = dataclasses.replace(own, colors=tuple(mix_rgb(c, rgb(color), share) for c in own.colors))
    if "vivid" in moods:
        own = dataclasses.replace(own, colors=tuple(_purer(c) for c in own.colors))
    return own


def _purer(color: tuple[float, float, float]) -> tuple[float, float, float]:
    grey = sum(color) / 3
    r, g, b = (min(max(grey + (c - grey) * 1.45, 0.0), 1.0) for c in color)
    return r, g, b
