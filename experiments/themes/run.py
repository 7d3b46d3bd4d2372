"""One room in many themes: a contact sheet, and a table of the words that were heard.

    python experiments/themes/run.py                     docs/themes.jpg and the table of README.md
    python experiments/themes/run.py --theme "an igloo"  one picture, theme.png by default

Plan, camera and seed are the same in every picture, so that only the words differ.
"""

import argparse
import pathlib

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from tabulate import tabulate

from wm.geometry import build_structure, parse_plan
from wm.geometry.rays.pinhole import make_camera
from wm.offline.arrangement.furnishing import furnish_scene
from wm.offline.style.theme import style_of
from wm.offline.style.words import read_theme
from wm.offline.world.room import bake_settings
from wm.offline.world.world import World
from wm.synth.backends import SceneContext

HERE = pathlib.Path(__file__).parent
SHEET = HERE.parents[1] / "docs" / "themes.jpg"
PLAN = """{"metadata": {"units": "meters", "wall_thickness": 0.15, "default_ceiling_height": 2.8}, "rooms": [
 {"id": "living", "name": "living room",
  "floor_polygon": [[0, 0], [6.2, 0], [6.2, 4.8], [0, 4.8]], "ceiling_height": 2.8,
  "openings": [
   {"type": "window", "wall_segment": [[6.2, 4.8], [0, 4.8]], "position": 1.0, "width": 1.5, "height": 1.4, "sill_height": 0.85},
   {"type": "window", "wall_segment": [[6.2, 4.8], [0, 4.8]], "position": 3.8, "width": 1.5, "height": 1.4, "sill_height": 0.85},
   {"type": "door", "wall_segment": [[0, 4.8], [0, 0]], "position": 3.4, "width": 0.9, "height": 2.0, "sill_height": 0}]},
 {"id": "hall", "name": "hall", "floor_polygon": [[-2.4, 0], [0, 0], [0, 4.8], [-2.4, 4.8]], "ceiling_height": 2.8,
  "openings": []}], "objects": []}"""
THEMES = (
    "1970s space station, orange plastic and white curved panels",
    "ramen bar in Tokyo at night, neon, red lanterns",
    "an igloo of ice blocks, furs",
    "submarine, riveted steel and brass",
    "hospital ward, white tiles",
    "pirate ship, dark planks and brass lanterns",
    "wizard's tower, purple velvet",
    "primary school with green boards",
    "French bakery with pink walls",
    "gothic spaceship",
    "bright scandinavian apartment with pale oak, white walls and soft wool",
    "gothic revival mansion with ornate detail and dark wood",
    "roman country estate with marble floors, frescoed walls and warm terracotta",
    "farmhouse with yellow walls, blue ceiling and a green sofa",
    "New York loft, exposed brick, black leather",
    "cave house by candlelight",
    "treehouse in the jungle",
    "1950s American diner, chequered floor",
    "japanese tea house with bamboo, no carpets",
    "candy house, pastel stripes",
)
COLUMNS, WIDTH, HEIGHT, CAPTION = 4, 400, 268, 22


def picture(theme: str, *, texel: float = 0.03, seed: int = 2) -> np.ndarray:
    """[h, w, 3] uint8: the room in a theme."""
    plan = parse_plan(PLAN)
    bare = SceneContext(theme, seed, plan, build_structure(plan), ())
    context = SceneContext(theme, seed, plan, bare.structure, furnish_scene(bare))
    camera = make_camera(np.array([0.55, 0.5, 1.75]), np.array([4.2, 3.6, 0.95]), width=WIDTH, height=HEIGHT, fov_deg=72.0)
    world = World(context, supersampling=2, settings=bake_settings(texel), style=style_of(theme))
    return np.round(world.shoot(camera).rgb * 255).astype(np.uint8)


def captioned(image: np.ndarray, text: str) -> np.ndarray:
    strip = Image.new("RGB", (image.shape[1], CAPTION), "white")
    ImageDraw.Draw(strip).text((4, 4), text, fill="black", font=ImageFont.load_default(12))
    return np.vstack([np.asarray(strip), image])


def table(themes: tuple[str, ...]) -> str:
    """What was read out of each theme, as Markdown."""
    rows = [(t, ", ".join(r.used), ", ".join(r.idle), ", ".join(r.unknown)) for t in themes for r in [read_theme(t)]]
    return tabulate(rows, headers=("theme", "used", "known, without effect", "not known"), tablefmt="github")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--theme", action="append")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("theme.png"))
    parser.add_argument("--plain", action="store_true", help="leave the captions out")
    arguments = parser.parse_args()
    themes = tuple(arguments.theme or THEMES)
    cells = [picture(theme) for theme in themes]
    if not arguments.plain:
        cells = [captioned(cell, theme) for cell, theme in zip(cells, themes)]
    columns = min(COLUMNS, len(cells))
    cells += [np.full_like(cells[0], 255)] * (-len(cells) % columns)
    sheet = Image.fromarray(np.vstack([np.hstack(cells[k : k + columns]) for k in range(0, len(cells), columns)]))
    if arguments.theme:
        sheet.save(arguments.out)
        return
    sheet.save(SHEET, quality=86)
    text = (HERE / "README.md").read_text().split("\n| theme")[0].rstrip()
    (HERE / "README.md").write_text(f"{text}\n\n{table(themes)}\n")


if __name__ == "__main__":
    main()
