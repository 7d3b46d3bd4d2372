"""Names of colours as hexadecimal sRGB codes, and words that change a colour's tone."""

COLORS: dict[str, str] = {
    "red": "a82f2c", "crimson": "8a1f2c", "scarlet": "c4281f", "vermilion": "d0402a", "ruby": "8f1535", "cherry": "9a1b2f",
    "burgundy": "5f1f2c", "maroon": "5c1f24", "wine": "5f1f33", "oxblood": "4f1a1c", "rust": "9a4a26", "brick-red": "9a4432",
    "pink": "e89ab0", "rose": "c97f86", "blush": "ecc4bd", "salmon": "ea9a80", "coral": "e5806a", "peach": "f2bf98",
    "fuchsia": "c8328f", "magenta": "c22f8c", "raspberry": "b02a58", "orange": "d8782f", "tangerine": "e8812a",
    "apricot": "efb27a", "pumpkin": "cf6a1f", "amber": "d99a2b", "ochre": "c08a34", "mustard": "c99a2e", "yellow": "e0b83f",
    "lemon": "efdf6a", "saffron": "e5a823", "canary": "f2dc55", "gold": "c9a040", "golden": "c9a040", "honey": "d3a250",
    "green": "4a7a4a", "emerald": "1f7a5a", "jade": "3f8f6c", "olive": "6b6f3a", "sage": "a0ad8c", "mint": "b5dcc5",
    "lime": "9ac23a", "moss": "6a7a3f", "khaki": "a79e72", "forest-green": "2a5237", "bottle-green": "1d4736", "fern": "5a8550",
    "pistachio": "b6cc8e", "teal": "2f7a7a", "turquoise": "3fb0b0", "aqua": "62c2c4", "aquamarine": "7fd0bb", "cyan": "35b8cf",
    "blue": "3f6a9a", "navy": "24365a", "cobalt": "274f9f", "azure": "4a8fd0", "sapphire": "23478f", "ultramarine": "2c3a94",
    "sky-blue": "9cc6e6", "baby-blue": "b9d6ea", "indigo": "3a3a7a", "denim": "46607f", "petrol": "1f5666",
    "purple": "6a3f8a", "violet": "7a4fa0", "lavender": "b0a0d0", "lilac": "c4add6", "mauve": "a98aa6", "plum": "5e2f54",
    "aubergine": "43243f", "amethyst": "8a62b0", "white": "efeeea", "ivory": "f0e8d6", "cream": "f0e6cc", "eggshell": "ece4d2",
    "vanilla": "f2e6c2", "beige": "d8c8a8", "sand": "d9c49c", "sandy": "d9c49c", "buff": "d6b98a", "tan": "c09a6c",
    "taupe": "8f8172", "brown": "6b4a32", "chocolate": "4c2f20", "coffee": "5a4030", "caramel": "b0773f", "chestnut": "6f3a26",
    "cinnamon": "9a5c34", "mahogany-red": "5a2418", "sepia": "6a4f35", "bronze-brown": "7a5a32", "grey": "8f9194",
    "charcoal": "3a3c40", "slate-grey": "5f6770", "ash": "b5b3ad", "pewter": "7d8285", "graphite": "46484c", "black": "2a2a2c",
    "ebony-black": "23201f", "jet": "1f1f21", "silver": "b8bcc0", "pearl": "e8e4dc", "copper-red": "b0663f",
}  # fmt: skip
"""At least one name for every part of the colour wheel; toned down, as paint and cloth are."""

COLOR_SYNONYMS: dict[str, str] = {
    "gray": "grey", "bordeaux": "burgundy", "reddish": "red", "bluish": "blue", "greenish": "green", "yellowish": "yellow",
    "pinkish": "pink", "purplish": "purple", "brownish": "brown", "whitish": "white", "offwhite": "ivory", "creamy": "cream",
    "snow-white": "white", "whitewashed": "white", "blackened": "black", "rosy": "rose", "gilded": "gold", "gilt": "gold",
    "golden-yellow": "gold", "celadon": "sage", "verdigris": "jade", "terracotta-red": "rust",
}  # fmt: skip

TONES: dict[str, tuple[str, float]] = {
    "dark": ("000000", 0.42), "deep": ("000000", 0.3), "black-stained": ("000000", 0.6), "midnight": ("000010", 0.55),
    "light": ("ffffff", 0.4), "pale": ("ffffff", 0.5), "pastel": ("ffffff", 0.5), "soft": ("ffffff", 0.22),
    "faded": ("b8b4aa", 0.4), "dusty": ("b0aaa2", 0.35), "muted": ("8f8c86", 0.35), "bleached": ("f4eee2", 0.5),
    "warm": ("d98a40", 0.08), "cool": ("5a8ad0", 0.08),
}  # fmt: skip
"""Word -> the colour that is mixed in, and its share."""
VIVID: frozenset[str] = frozenset({"bright", "vivid", "vibrant", "bold", "hot", "electric", "acid", "neon", "fluorescent"})
"""Words before a colour that make it purer."""
