"""What was read out of a theme, before it is turned into looks."""

import dataclasses


@dataclasses.dataclass(frozen=True)
class Request:
    """A colour or a material that a theme asks for something, or does not want there."""

    target: str  # key of vocabulary.targets.TARGETS
    color: str = ""  # hexadecimal code
    second: str = ""  # another colour of the same thing: "red and white walls"
    material: str = ""  # key of vocabulary.materials.MATERIAL_WORDS
    absent: bool = False  # the thing is not wanted
    room: str = ""  # sort of room (wm.synth.room_names) whose surface it is; "" for all rooms


@dataclasses.dataclass(frozen=True)
class ThemeReading:
    """The meaning of a theme's words."""

    families: tuple[tuple[str, float], ...] = ()  # families and places that were named with their weights, the strongest first
    palette: tuple[str, ...] = ()  # hexadecimal codes of colours that were asked for nothing in particular
    unwanted_colors: tuple[str, ...] = ()  # hexadecimal codes
    unwanted_materials: tuple[str, ...] = ()  # sorts of vocabulary.materials.SORTS
    requests: tuple[Request, ...] = ()
    wood_tone: str = ""  # dark | light: "dark wood"
    moods: tuple[str, ...] = ()  # keys of vocabulary.moods.MOODS
    used: tuple[str, ...] = ()  # words and phrases that changed something, as they were written
    idle: tuple[str, ...] = ()  # words that are known but change nothing here
    unknown: tuple[str, ...] = ()  # words that are not known
