"""The prompts of image models, in our own words: one for painting a view, one for furnishing an empty room."""

import dataclasses
from collections.abc import Sequence


@dataclasses.dataclass(frozen=True)
class ViewPrompt:
    """The prompt of a view, and what it was written from, for models that want a prompt of their own (`ImageRequest`)."""

    text: str
    theme: str = ""  # the scene in words
    room: str = ""  # name of the room
    sights: tuple[str, ...] = ()  # doors and windows in view

_FURNITURE = {
    "textured": "Furniture stays exactly where the guide shows it, at the same size and angle.",
    "boxes": "Every grey box in the guide stands for one piece of furniture: draw in its place a piece that fills it and suits "
    "the room. No box remains, and no furniture stands where there is none.",
    "none": "The guide shows the room empty. Furnish it as such a room would be, and keep doorways free.",
}
"""The sentence about furniture for each value of `condition.objects`."""
_PLAIN = "No people, no lettering, no frame; natural exposure, everything in focus."


def image_prompt(
    theme: str, room: str, sights: Sequence[str] = (), *, objects: str = "textured", has_reference: bool = True
) -> str:
    """The prompt for painting one view.

    Args:
      theme: the scene in words.
      room: the name of the room the camera stands in.
      sights: the doors and windows in the view, such as "a doorway on the left" (wm.synth.sights).
      objects: how the guide shows furniture: textured | boxes | none.
      has_reference: whether a finished view of the same place is sent with the guide.
    """
    parts = [
        f"A photograph taken inside the {room} of this place: {theme}.",
        "The guide image fixes the geometry: camera, walls and openings stay exactly where it shows them. Where it is in colour, "
        "those surfaces are already decided, so keep their colours and materials and draw them crisply; where it is grey it "
        "shows distance only, so choose materials that suit the place.",
        _FURNITURE[objects],
    ]
    parts += _in_view(sights)
    if has_reference:
        parts.append(
            "The second picture is another photograph from the same building. Match its materials, palette and light, but not "
            "its viewpoint" + (", and take no object from it that the guide does not have." if objects != "none" else ".")
        )
    return "\n\n".join([*parts, _PLAIN])


def furnish_prompt(theme: str, room: str, sights: Sequence[str] = (), *, has_reference: bool = False) -> str:
    """The prompt for drawing furniture into an empty room, from which it is then lifted.

    Args:
      theme: the scene in words.
      room: the name of the room.
      sights: the doors and windows in the view.
      has_reference: whether an image of the same furnished room from another camera is sent with the guide.
    """
    parts = [
        f"A photograph taken inside the {room} of this place: {theme}.",
        "The guide image shows this room empty, and of it distance only: nearer is brighter. Camera, walls and openings stay "
        "exactly where it shows them; choose materials that suit the place.",
        "Furnish the room as such a room would be, with whole pieces that can be told apart: on the floor, on one another, at "
        "the walls or from the ceiling. Keep doorways free.",
    ]
    parts += _in_view(sights)
    if has_reference:
        parts.append(
            "The second picture shows the same room furnished, from another spot. Its furniture stands in the same places here: "
            "draw of it what this camera sees, with the same materials, palette and light, and add only what that picture "
            "cannot show."
        )
    return "\n\n".join([*parts, _PLAIN])


def _in_view(sights: Sequence[str]) -> list[str]:
    return [f"In view: {'; '.join(sights)}."] if sights else []
