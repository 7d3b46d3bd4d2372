"""The type of a room, by which it is finished and furnished: rooms that differ only in size or place are of one type."""

from wm.synth.room_names import room_sort

ROOM_TYPES = {
    "corridor": "corridor", "hall": "hall", "great hall": "hall", "gallery": "gallery", "atrium": "hall", "living": "living",
    "dining": "dining", "kitchen": "kitchen", "conservatory": "living", "leisure": "living", "ballroom": "hall",
    "library": "library", "workshop": "utility", "studio": "study", "study": "study", "bedroom": "bedroom",
    "bathroom": "bathroom", "service": "utility", "room": "living", "other": "other",
}  # fmt: skip
"""The type of each sort of room (wm.synth.room_names)."""


def room_type(name: str) -> str:
    """Type of the room called `name`: a value of ROOM_TYPES, "other" where no word tells."""
    return ROOM_TYPES[room_sort(name)]
