"""Moods: time of day, weather, light, and how ornate a place is; each word to the change that it makes."""

MOODS: dict[str, tuple[str, ...]] = {
    "night": ("night", "nocturnal", "midnight", "moonlit", "moonlight", "nighttime", "starlit", "starry"),
    "dusk": ("sunset", "dusk", "dawn", "sunrise", "evening", "twilight", "autumn", "autumnal"),
    "dim": ("dark", "gloomy", "moody", "dim", "haunted", "shadowy", "murky", "eerie", "spooky", "creepy", "sombre", "somber",
            "scary", "noir", "sinister", "mysterious"),
    "bright": ("bright", "airy", "sunny", "sunlit", "light", "luminous", "radiant", "cheerful", "summery", "summer", "fresh"),
    "candlelit": ("candlelit", "candlelight", "firelit", "romantic", "intimate", "cosy-lit"),
    "neon": ("neon", "fluorescent", "electric", "glowing-signs", "blacklight", "ultraviolet"),
    "foggy": ("foggy", "misty", "hazy", "cloudy", "overcast", "rainy", "rain", "grey-sky", "fog", "mist"),
    "stormy": ("stormy", "storm", "thunder", "thunderstorm", "tempest"),
    "cold": ("cold", "winter", "wintry", "chilly", "arctic-light", "clinical", "sterile"),
    "warm": ("warm", "glowing", "toasty", "golden-hour", "welcoming", "cosy", "cozy", "snug", "hygge"),
    "ornate": ("ornate", "elaborate", "lavish", "maximalist", "opulent", "sumptuous", "intricate", "grand", "luxurious",
               "extravagant", "eclectic"),
    "plain": ("plain", "simple", "sparse", "austere", "minimalist", "minimal", "uncluttered", "bare", "spartan", "functional"),
    "worn": ("worn", "derelict", "abandoned", "decayed", "ruined", "ruin", "dilapidated", "weathered", "rusty", "grimy", "dirty",
             "crumbling", "aged", "distressed", "shabby"),
    "pastel": ("pastel", "soft-toned"),
    "vivid": ("colourful", "colorful", "vivid", "vibrant", "playful", "children", "kid", "kids", "childrens", "rainbow", "joyful",
              "psychedelic"),
    "muted": ("muted", "faded", "subdued", "monochrome", "desaturated", "earthy"),
    "soft": ("soft", "fluffy", "plush", "comfortable", "comfy", "cushy"),
}  # fmt: skip
"""Mood -> words that ask for it."""
MOOD_OF_WORD: dict[str, str] = {word: mood for mood, words in MOODS.items() for word in words}
