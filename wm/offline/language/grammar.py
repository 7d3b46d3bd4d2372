"""The offline language backend: a seeded grammar that answers with a floor plan as JSON, as a language model does.

A proposal is drafted from the theme (building.py), the programme (programme.py), a massing (rows.py, massing.py) and openings
(openings.py). It may break rules, as the proposal of a model may. The grammar is then asked again with the violations: if only
openings broke rules, it keeps the rooms and draws new openings; otherwise it drafts another house.
"""

import dataclasses
import json
import zlib
from typing import Any

import numpy as np

from wm.bounds import setting
from wm.geometry.plan.records import WALL_THICKNESS
from wm.offline.language.building import Building, building_of, building_words, draw
from wm.offline.language.massing import draft
from wm.offline.language.openings import Hole, draw_openings
from wm.offline.language.programme import CIRCULATION, Space, read_programme, room_kind_of
from wm.offline.style.lexicon import words_of
from wm.schema import BackendSettings
from wm.synth.backends import HeardTheme, LanguageResult, SceneContext

VERSION = "2"
_OF_OPENINGS = ("opening", "door", "window", "passage")


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """The grammar has no settings of its own."""

    backend: str = setting(__name__, "The offline grammar of houses.")


class Grammar:
    """The grammar as a `LanguageBackend`. It has no state: equal arguments give equal text."""

    def propose(self, theme: str, rooms: list[str], *, seed: int, violations: list[str], previous: str | None) -> LanguageResult:
        """A floor plan as JSON text. Its rooms are in the order of the programme; corridors that were added come after them."""
        building = building_of(theme)
        asked_again = zlib.crc32(previous.encode()) if previous is not None else 0
        # The theme's text is not drawn from: only what its words mean for the building changes the house.
        rng = np.random.default_rng(np.random.SeedSequence([seed, asked_again]))
        kept = _read_back(previous) if previous is not None and violations and _only_openings(violations) else None
        if kept is not None:
            spaces, polygons, ceilings = kept
        else:
            spaces = read_programme(rooms, building, rng)
            spaces, polygons = draft(spaces, building, rng)
            ceilings = _ceilings(spaces, building, rng)
        holes = draw_openings(polygons, spaces, ceilings, building, rng)
        return LanguageResult(_as_json(spaces, polygons, ceilings, holes))


def make(settings: Settings, context: SceneContext | None = None) -> Grammar:
    """The backend. It uses neither settings nor a scene."""
    return Grammar()


def _ceilings(spaces: list[Space], building: Building, rng: np.random.Generator) -> list[int]:
    """Ceiling heights in cm: one height for the house; halls and atria may be higher, depending on the theme."""
    common = round(100 * draw(building.ceiling, rng))
    lofty = round(20 * building.lofty * rng.uniform(0.4, 1.0)) * 5
    return [common + (lofty if s.kind.zone == CIRCULATION and s.kind.name != "corridor" else 0) for s in spaces]


def _only_openings(violations: list[str]) -> bool:
    """Whether all violations ("room <id>: <rule>: <message>") are about openings, or about rooms that became unreachable."""
    rules = [violation.split(": ")[1] if violation.count(": ") >= 2 else violation for violation in violations]
    of_openings = [any(word in rule for word in _OF_OPENINGS) for rule in rules]
    return any(of_openings) and all(ours or rule == "unreachable" for ours, rule in zip(of_openings, rules))


def _read_back(previous: str) -> tuple[list[Space], list[np.ndarray], list[int]] | None:
    """The rooms of a proposal of this grammar; None if the text is not such a proposal."""
    try:
        rooms = json.loads(previous)["rooms"]
        polygons = [np.round(100 * np.array(room["floor_polygon"], float)).astype(np.int64) for room in rooms]
        heights = [round(100 * room["ceiling_height"]) for room in rooms]
        names = [(str(room["id"]), str(room["name"])) for room in rooms]
    except (ValueError, KeyError, TypeError):
        return None
    spaces = []
    for (room_id, name), polygon in zip(names, polygons):
        x, y = polygon.T / 100
        area = float(abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))) / 2
        spaces.append(Space(id=room_id, name=name, kind=room_kind_of(name), area=area))
    return spaces, polygons, heights


def _as_json(spaces: list[Space], polygons: list[np.ndarray], ceilings: list[int], holes: list[Hole]) -> str:
    rooms = [
        {
            "id": space.id,
            "name": space.name,
            "floor_polygon": [[x / 100, y / 100] for x, y in polygon.tolist()],
            "ceiling_height": ceiling / 100,
            "openings": [_opening(hole) for hole in holes if hole.side.room == room],
        }
        for room, (space, polygon, ceiling) in enumerate(zip(spaces, polygons, ceilings))
    ]
    metadata = {
        "units": "meters",
        "coordinate_system": "z_up",
        "wall_thickness": WALL_THICKNESS,
        "default_ceiling_height": min(ceilings) / 100,
    }
    return json.dumps({"metadata": metadata, "rooms": rooms, "objects": []}, indent=1, ensure_ascii=False)


def _opening(hole: Hole) -> dict[str, Any]:
    side = hole.side
    forward = side.end[1 - side.axis] > side.start[1 - side.axis]
    position = hole.low - side.low if forward else side.high - hole.high
    return {
        "type": hole.kind,
        "wall_segment": [[c / 100 for c in side.start], [c / 100 for c in side.end]],
        "position": position / 100,
        "width": (hole.high - hole.low) / 100,
        "height": hole.height / 100,
        "sill_height": hole.sill / 100,
    }


def heard(theme: str) -> HeardTheme:
    """What the grammar of houses makes of a theme's words."""
    used = building_words(theme)
    others = [word for word in words_of(theme) if word not in used]
    return HeardTheme(used=tuple(word.text for word in used), unknown=tuple(word.text for word in others))
