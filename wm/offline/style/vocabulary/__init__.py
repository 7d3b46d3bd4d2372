"""The words of themes that the offline backends know, as tables.

    colors     names of colours, and words that change a colour's tone
    materials  names of materials, and what surfaces and furniture are made of them
    targets    what a colour or a material may be asked for: walls, floors, sofas, curtains
    moods      time of day, weather, light, and how ornate a place is
    phrases    words that belong together, and words that carry no meaning of their own

The words that choose a style family or a place stand with each sheet in wm.offline.style.families.
"""
