"""The ids of objects: the same in `objects.json`, in the names of GLB nodes, and wherever else an object is spoken of."""

import dataclasses
import re
from collections.abc import Sequence

from wm.types import SceneObject


def with_ids(objects: Sequence[SceneObject], rooms: Sequence[str]) -> tuple[SceneObject, ...]:
    """The objects named by room, label and a number that counts within the room: `library-floor_lamp-2`.

    Ids hold only letters, digits, `_` and `-`, which every viewer keeps, and those of one room do not depend on the others.
    """
    taken: set[str] = set()
    named = []
    for thing in objects:
        stem = f"{rooms[thing.room]}-{re.sub(r'[^a-z0-9]+', '_', thing.label.lower()).strip('_') or 'object'}"
        k = 1
        while f"{stem}-{k}" in taken:
            k += 1
        taken.add(f"{stem}-{k}")
        named.append(dataclasses.replace(thing, id=f"{stem}-{k}"))
    return tuple(named)
