"""Fifty themes furnished and finished without an exception, each in another way."""

import numpy as np
import pytest

from tests.offline.arrangement.test_wishes import plan_of
from wm.geometry import build_structure
from wm.geometry.rays.pinhole import make_camera
from wm.offline.arrangement.furnishing import furnish_scene
from wm.offline.world.light import BakeSettings
from wm.offline.world.world import World
from wm.synth.backends import SceneContext

COARSE = BakeSettings(cell=0.3, spacing=0.6, probe_spacing=0.5, rays=8, sun_rays=1, bounces=1)
THEMES = [
    "1970s space station, orange plastic and white curved panels", "ramen bar in Tokyo at night, neon, red lanterns", "igloo",
    "submarine", "hospital", "pirate ship", "wizard's tower", "school", "bakery", "yellow walls", "gothic spaceship",
    "no carpets",
    "children's library, bright", "cabin without wood", "art deco cinema, black and gold", "moroccan riad with blue tiles",
    "loft",
    "1950s diner with chequered floor", "candy house, pastel stripes", "cave by candlelight", "treehouse in the jungle", "sauna",
    "egyptian temple with gold columns", "chinese palace, red lacquer", "circus at dusk", "prison", "castle with stone walls",
    "underwater palace", "desert pueblo with adobe walls", "irish pub with dark green walls", "pink dollhouse", "1980s, neon",
    "victorian greenhouse", "art nouveau salon", "mexican hacienda, colourful", "abandoned hospital, foggy", "haunted victorian",
    "scandinavian japanese flat", "steampunk submarine", "baroque cyberpunk, no red", "minimalist concrete bunker", "tiki bar",
    "roman villa with mosaic floors", "oak floors and white brick walls", "velvet curtains and leather sofas", "all in lilac",
    "steel kitchen, glass tables", "frobnicated glimmerwick", "", "¿qué? 茶室 à la mode",
]  # fmt: skip


def scene(theme, seed, *names):
    plan = plan_of(*names)
    bare = SceneContext(theme, seed, plan, build_structure(plan), ())
    return SceneContext(theme, seed, plan, bare.structure, furnish_scene(bare))


@pytest.mark.slow
@pytest.mark.parametrize("theme", THEMES)
def test_every_theme_can_be_furnished_finished_and_lit(theme):
    for seed in (1, 2, 0):
        context = scene(theme, seed, *(("living room", "bathroom") if seed == 0 else ("bedroom",)))
        assert all(np.isfinite(thing.vertices).all() and np.isfinite(thing.slot_colors).all() for thing in context.objects)
    camera = make_camera(np.array([0.6, 0.6, 1.6]), np.array([4.0, 3.5, 1.0]), width=24, height=16, fov_deg=70.0)
    rgb = World(context, supersampling=1, settings=COARSE).shoot(camera).rgb
    assert np.isfinite(rgb).all() and 0.02 < rgb.mean() < 0.98


@pytest.mark.parametrize(
    "pair", [("1970s space station", "ramen bar at night"), ("igloo", "submarine"), ("yellow walls", "blue walls")]
)
def test_two_themes_give_two_visibly_different_pictures(pair):
    camera = make_camera(np.array([0.6, 0.6, 1.6]), np.array([4.0, 3.5, 1.0]), width=24, height=16, fov_deg=70.0)
    a, b = (World(scene(theme, 0, "living room"), supersampling=1, settings=COARSE).shoot(camera).rgb for theme in pair)
    assert np.abs(a - b).mean() > 0.08
