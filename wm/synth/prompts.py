"""What models are told, in our own words: one text for an image, one for a floor plan."""

from collections.abc import Sequence

PLAN_SAMPLE = """\
{"metadata": {"units": "meters", "coordinate_system": "z_up", "wall_thickness": 0.15, "default_ceiling_height": 2.8},
 "rooms": [
  {"id": "hall", "name": "hall", "floor_polygon": [[0, 0], [5, 0], [5, 4], [0, 4]], "ceiling_height": 2.8, "openings": [
    {"type": "door", "wall_segment": [[5, 0], [5, 4]], "position": 0.5, "width": 0.9, "height": 2.1, "sill_height": 0},
    {"type": "window", "wall_segment": [[0, 0], [5, 0]], "position": 1.8, "width": 1.4, "height": 1.4, "sill_height": 0.9}]},
  {"id": "kitchen", "name": "kitchen", "floor_polygon": [[5, 0], [9, 0], [9, 4], [5, 4]], "ceiling_height": 2.8, "openings": [
    {"type": "window", "wall_segment": [[9, 0], [9, 4]], "position": 1.2, "width": 1.4, "height": 1.3, "sill_height": 1.0}]}
 ],
 "objects": []}"""
"""A valid floor plan (design.md, "Floor plan JSON")."""

PLAN_FORMAT = f"""\
{PLAN_SAMPLE}
Lengths are metres. "id": letters, digits and underscores, no two alike; "name": as it is called in the list of rooms.
"floor_polygon": corners counter-clockwise, seen from above; it may have more than four of them.
"type": door or passage between two rooms, window to the outside; a door or passage is listed by one of its rooms.
"wall_segment": the side of floor_polygon that the opening lies on; "position": from the start of that side to the near edge of
the opening. "objects" stays empty."""
"""The JSON that is wanted, by example."""


_FURNITURE = {
    "textured": "Furniture stays exactly where the guide shows it, at the same size and angle.",
    "boxes": "Every grey box in the guide stands for one piece of furniture: draw in its place a piece that fills it and suits "
    "the room. No box remains, and no furniture stands where there is none.",
    "none": "The guide shows the room empty. Furnish it as such a room would be, and keep doorways free.",
}
"""By `condition.objects`: what the guide shows of them."""


def image_prompt(
    theme: str, room: str, sights: Sequence[str] = (), *, objects: str = "textured", has_reference: bool = True
) -> str:
    """What an image model is asked for one view.

    Args:
      theme: the scene in words.
      room: the name of the room the camera stands in.
      sights: what the view shows of doors and windows, e.g. "a doorway to the library on the left".
      objects: what the guide shows of furniture: textured | boxes | none.
      has_reference: whether a finished view of the same place goes with the guide.
    """
    parts = [
        f"A photograph taken inside the {room} of this place: {theme}.",
        "The guide image fixes the geometry: camera, walls and openings stay exactly where it shows them. Where it is in colour, "
        "those surfaces are already decided, so keep their colours and materials and draw them crisply; where it is grey it "
        "shows distance only, so choose materials that suit the place.",
        _FURNITURE[objects],
    ]
    if sights:
        parts.append(f"In view: {'; '.join(sights)}.")
    if has_reference:
        parts.append(
            "The second picture is another photograph from the same building. Match its materials, palette and light, but not "
            "its viewpoint, and take no object from it that the guide does not have."
        )
    parts.append("No people, no lettering, no frame; natural exposure, everything in focus.")
    return "\n\n".join(parts)


def plan_prompt(theme: str, rooms: Sequence[str], violations: Sequence[str] = ()) -> str:
    """What a language model is asked for a floor plan.

    For language backends that ask a model, which say these words in their `propose` and send its answer back; the grammar needs
    none, and a backend of this kind is not in this version.

    Args:
      theme: the scene in words.
      rooms: the programme, one entry a room.
      violations: what was wrong with its last answer; none the first time.
    """
    listed = "\n".join(f"- {room}" for room in rooms)
    parts = [
        f"Design one storey of a building. Theme: {theme}.",
        f"It has these rooms, one for each line:\n{listed}\nYou may add corridors or halls that connect them, nothing else.",
        "Answer with one JSON object and no other text, in this form:\n" + PLAN_FORMAT,
        "Neighbouring rooms share their wall's line exactly and never overlap; there are no gaps between them. The outline of a "
        "room is the middle of a shared wall and the outer face of an outside wall. Doors and passages lie where two rooms "
        "touch, windows where nothing is behind the wall. Keep 0.3 m of wall beside every opening and between openings, and "
        "every opening below the ceiling. One can walk from every room to every other. Sizes suit the use of the room and the "
        "theme; most rooms have windows; the whole is compact.",
    ]
    if violations:
        faults = "\n".join(f"- {violation}" for violation in violations)
        parts.append(f"Your last answer broke these rules. Keep what was right and mend them all:\n{faults}")
    return "\n\n".join(parts)
