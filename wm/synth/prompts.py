"""What models are told, in our own words: one text for an image, one for a floor plan."""

from collections.abc import Sequence

PLAN_FORMAT = """\
{
  "metadata": {"units": "meters", "coordinate_system": "z_up", "wall_thickness": 0.15, "default_ceiling_height": 2.8},
  "rooms": [
    {
      "id": "kitchen",              letters, digits and underscores; no two alike
      "name": "kitchen",            as it is called in the list of rooms
      "floor_polygon": [[x, y], ...],  corners in metres, counter-clockwise, not crossing
      "ceiling_height": 2.8,
      "openings": [
        {
          "type": "door",           door or passage between two rooms, window to the outside
          "wall_segment": [[x, y], [x, y]],  the side of floor_polygon it lies on
          "position": 0.5,          metres from the start of that side to the near edge of the opening
          "width": 0.9, "height": 2.1, "sill_height": 0.0
        }
      ]
    }
  ],
  "objects": []
}"""
"""A commented sample of the floor plan JSON (design.md, "Floor plan JSON")."""


def image_prompt(theme: str, room: str, sights: Sequence[str] = (), *, has_reference: bool = True) -> str:
    """What an image model is asked for one view.

    Args:
      theme: the scene in words.
      room: the name of the room the camera stands in.
      sights: what the view shows of doors and windows, e.g. "a doorway to the library on the left".
      has_reference: whether a finished view of the same place goes with the guide.
    """
    parts = [
        f"A photograph taken inside the {room} of this place: {theme}.",
        "The guide image fixes the geometry: camera, walls, openings and furniture stay exactly where it shows them, at the "
        "same size and angle. Where the guide is in colour, those surfaces are already decided, so keep their colours and "
        "materials and draw them crisply; where it is grey it shows distance only, so choose materials that suit the place.",
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


def plan_prompt(theme: str, rooms: Sequence[str], violations: Sequence[str] = (), *, plan_format: str = PLAN_FORMAT) -> str:
    """What a language model is asked for a floor plan.

    Args:
      theme: the scene in words.
      rooms: the programme, one entry a room.
      violations: what was wrong with its last answer; none the first time.
      plan_format: a description of the JSON that is wanted.
    """
    listed = "\n".join(f"- {room}" for room in rooms)
    parts = [
        f"Design one storey of a building. Theme: {theme}.",
        f"It has these rooms, one for each line:\n{listed}\nYou may add corridors or halls that connect them, nothing else.",
        "Answer with one JSON object and no other text, in this form (the remarks are not part of it):\n" + plan_format,
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
