"""Sorts of rooms, told by a room's name.

One vocabulary for all that propose a plan, check it, or finish and furnish its rooms.
"""

import re

ROOM, OTHER = "room", "other"

# The last word that says what a room is decides ("hall bathroom" is a bathroom); phrases come before words.
PHRASES = {
    "great hall": "great hall", "grand hall": "great hall", "throne room": "great hall", "dining hall": "dining",
    "banquet hall": "dining", "breakfast nook": "dining", "guest room": "bedroom", "cloak room": "service",
}  # fmt: skip
WORDS = {
    "corridor": "corridor hallway passage passageway landing walkway tunnel",
    "hall": "hall foyer lobby vestibule entry entrance entryway rotunda",
    "great hall": "throne",
    "gallery": "gallery arcade colonnade museum exhibition",
    "atrium": "atrium courtyard patio court cloister peristyle",
    "living": "living lounge sitting salon parlour parlor drawing sunken family media exedra",
    "dining": "dining diner refectory triclinium breakfast banquet",
    "kitchen": "kitchen kitchenette galley scullery culina",
    "conservatory": "conservatory sunroom greenhouse orangery veranda solarium terrace aquarium garden",
    "leisure": "leisure music game games billiard theatre theater cinema gym playroom",
    "ballroom": "ballroom chapel",
    "library": "library archive reading bibliotheca scriptorium",
    "workshop": "workshop garage attic",
    "studio": "studio laboratory lab observatory atelier",
    "study": "study office den nook snug tablinum workroom workspace",
    "bedroom": "bedroom chamber nursery dormitory suite cubiculum bed guestroom boudoir bunk",
    "bathroom": "bathroom bath bathhouse washroom wc toilet shower ensuite thermae spa lavatory restroom balneum sauna powder",
    "service": "service pantry larder laundry utility closet storage store storeroom cellar mudroom dressing wardrobe cloakroom",
}
SORTS = (*WORDS, ROOM, OTHER)
"""Every sort of room; ROOM is one whose name says no more than that ("tea room"), OTHER one whose name has no known word."""
CONNECTING = frozenset(("corridor", "hall", "great hall", "gallery", "atrium"))
"""Sorts of rooms that lead to others. A plan may add rooms of these sorts to those that were asked for."""
_SORT_OF_WORD = {word: sort for sort, words in WORDS.items() for word in words.split()}


def room_sort(name: str) -> str:
    """The sort of room, one of SORTS, that a name speaks of: by whole words, so that "Bathsheba" is no bathroom by accident."""
    words = re.findall(r"[a-z]+", name.lower())
    for end in range(len(words), 0, -1):
        sort = PHRASES.get(" ".join(words[max(end - 2, 0) : end])) or _SORT_OF_WORD.get(words[end - 1])
        if sort:
            return sort
    return ROOM if ROOM in words else OTHER
