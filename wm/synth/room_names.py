"""Sorts of rooms, told by a room's name.

One vocabulary for all that propose a plan, check it, or finish and furnish its rooms.
"""

import re
import unicodedata
from collections.abc import Iterable

ROOM, OTHER = "room", "other"

# The last word that says what a room is decides ("hall bathroom" is a bathroom); phrases come before words.
PHRASES = {
    "great hall": "great hall", "grand hall": "great hall", "dining hall": "dining", "banquet hall": "dining",
    "mess hall": "restaurant", "breakfast nook": "dining", "guest room": "bedroom", "cloak room": "cloakroom",
    "store room": "storage", "box room": "storage", "boot room": "cloakroom", "garden room": "conservatory",
    "home office": "study", "operating theatre": "surgery", "operating theater": "surgery", "hair salon": "barber",
    "beauty salon": "barber", "garde manger": "pantry", "green house": "greenhouse",
}  # fmt: skip
WORDS = {
    "corridor": "corridor hallway passage passageway landing walkway tunnel stairwell staircase",
    "hall": "hall foyer lobby rotunda",
    "entrance": "entrance entry entryway vestibule porch",
    "great hall": "palas",
    "throne room": "throne",
    "gallery": "gallery arcade colonnade",
    "museum": "museum exhibition",
    "atrium": "atrium courtyard patio court cloister peristyle",
    "garden": "garden",
    "balcony": "balcony terrace veranda loggia deck",
    "living": "living lounge sitting salon parlour parlor drawing sunken family media exedra smoking",
    "tea room": "tea",
    "dining": "dining diner refectory triclinium breakfast banquet",
    "restaurant": "restaurant cafe bistro canteen cafeteria eatery ramen trattoria brasserie coffee",
    "bar": "bar pub tavern taproom saloon speakeasy",
    "kitchen": "kitchen kitchenette galley scullery culina",
    "pantry": "pantry larder buttery",
    "bakery": "bakery bakehouse patisserie confectionery",
    "conservatory": "conservatory sunroom orangery solarium",
    "greenhouse": "greenhouse glasshouse hothouse potting",
    "aquarium": "aquarium",
    "leisure": "leisure recreation",
    "music": "music rehearsal band piano recording",
    "games": "games game arcades darts",
    "billiard": "billiard snooker",
    "cinema": "cinema theatre theater movie screening projection",
    "gym": "gym gymnasium fitness weights exercise workout training",
    "yoga": "yoga meditation pilates",
    "dance": "dance ballet",
    "ballroom": "ballroom",
    "chapel": "chapel church shrine oratory temple sanctuary",
    "crypt": "crypt tomb mausoleum catacomb",
    "library": "library archive reading bibliotheca scriptorium",
    "classroom": "classroom schoolroom school lecture seminar",
    "workshop": "workshop hobby toolroom craft",
    "forge": "forge smithy blacksmith",
    "garage": "garage carport",
    "boiler room": "boiler engine machine furnace",
    "studio": "studio",
    "atelier": "atelier art painting painter",
    "laboratory": "laboratory lab research",
    "observatory": "observatory planetarium telescope",
    "study": "study den nook snug tablinum map",
    "office": "office workspace workroom coworking bullpen",
    "meeting": "meeting conference boardroom council war",
    "control room": "control bridge cockpit command",
    "server room": "server datacenter data computer",
    "reception": "reception waiting",
    "shop": "shop boutique store market grocery supermarket bookshop bookstore pharmacy",
    "barber": "barber hairdresser barbershop",
    "bedroom": "bedroom chamber suite cubiculum bed guestroom boudoir guest cabin",
    "dormitory": "dormitory bunk barracks hostel dorm bunkroom",
    "nursery": "nursery baby",
    "kids": "kid child children teenager",
    "playroom": "playroom play toy",
    "hospital": "hospital ward infirmary patient sickbay",
    "surgery": "surgery clinic doctor examination consulting treatment massage",
    "cell": "cell prison jail dungeon gaol",
    "bathroom": "bathroom bath bathhouse washroom shower ensuite thermae balneum",
    "wc": "wc toilet lavatory restroom powder loo latrine",
    "sauna": "sauna steam",
    "pool": "pool spa swimming hammam",
    "laundry": "laundry washhouse washing",
    "service": "service utility",
    "closet": "closet wardrobe dressing",
    "cloakroom": "cloakroom mudroom coat",
    "changing room": "locker changing",
    "storage": "storage storeroom attic loft lumber warehouse stockroom shed",
    "cellar": "cellar basement wine brewery",
    "vault": "vault treasury strongroom treasure",
    "armoury": "armoury armory arsenal weapon guardroom",
    "stable": "stable barn stall tack horse",
}
FOREIGN = {
    # German, French and Spanish, without accents
    "corridor": "flur gang couloir pasillo",
    "hall": "diele vestibulo",
    "entrance": "eingang entree entrada",
    "living": "wohnzimmer wohnen sejour sala stube",
    "dining": "esszimmer comedor manger",
    "kitchen": "kuche kueche cuisine cocina",
    "pantry": "speisekammer speis cellier despensa",
    "bedroom": "schlafzimmer schlaf gastezimmer chambre dormitorio habitacion",
    "kids": "kinderzimmer enfant",
    "bathroom": "bad badezimmer bain bano dusche",
    "wc": "klo toilette aseo servicio",
    "study": "arbeitszimmer despacho",
    "office": "buro buero bureau oficina",
    "laundry": "waschkuche waschkueche buanderie lavadero",
    "storage": "abstellraum abstellkammer dachboden grenier lager trastero",
    "cellar": "keller cave sotano bodega",
    "garage": "garaje",
    "workshop": "werkstatt taller hobbyraum",
    "library": "bibliothek bibliotheque biblioteca",
    "balcony": "balkon terrasse balcon terraza",
    "garden": "garten jardin",
    "closet": "ankleide ankleidezimmer vestidor",
    "cloakroom": "garderobe",
    "gym": "gimnasio turnhalle",
    "classroom": "klassenzimmer aula",
    "chapel": "kapelle chapelle capilla",
    "stable": "ecurie establo",
    "shop": "laden tienda",
    "playroom": "spielzimmer jeux",
    "greenhouse": "gewachshaus serre invernadero",
    ROOM: "raum zimmer salle piece cuarto",
}
SORTS = (*WORDS, ROOM, OTHER)
"""Every sort of room; ROOM is one whose name says no more than that ("blue room"), OTHER one whose name has no known word."""
CONNECTING = frozenset(("corridor", "hall", "entrance", "great hall", "gallery", "atrium"))
"""Sorts of rooms that lead to others. A plan may add rooms of these sorts to those that were asked for."""
_SORT_OF_WORD = {word: sort for words in (FOREIGN, WORDS) for sort, listed in words.items() for word in listed.split()}
_ENDINGS = ("room", "zimmer", "raum")
_PLURALS = (("s", ""), ("es", ""), ("ies", "y"))


def room_sort(name: str) -> str:
    """The sort of room, one of SORTS, that a name speaks of: by whole words, so that "Bathsheba" is no bathroom by accident.

    Accents, case and plurals do not matter; of a compound with "room" ("musicroom") the part before it is read too.
    """
    words = re.findall(r"[a-z]+", _plain(name))
    for end in range(len(words), 0, -1):
        sort = PHRASES.get(" ".join(words[max(end - 2, 0) : end])) or _sort_of(words[end - 1])
        if sort and sort != ROOM:
            return sort
    return ROOM if any(_sort_of(word) == ROOM for word in words) else OTHER


def unknown_rooms(names: Iterable[str]) -> list[str]:
    """Of rooms' names those that do not say what the room is for, each once, in their order. Such rooms get sparse furniture."""
    return [name for name in dict.fromkeys(names) if room_sort(name) in (ROOM, OTHER)]


def _plain(name: str) -> str:
    return unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode().lower()


def _sort_of(word: str) -> str | None:
    """The sort that a word, its singular, or what stands before its "room" names."""
    if word in _ENDINGS:
        return ROOM
    singular = [word, *(word[: -len(end)] + one for end, one in _PLURALS if word.endswith(end))]
    stems = [stem[: -len(ending)] for stem in singular for ending in _ENDINGS if stem.endswith(ending)]
    return next((_SORT_OF_WORD[stem] for stem in (*singular, *stems) if stem in _SORT_OF_WORD), None)
