"""The offline language backend: a seeded grammar of floor plans.

    grammar    the backend: a plan in the JSON format that a language model is asked for
    programme  what each named room is, and how large it is
    building   what a theme says of the shell: walls, ceilings, doors, windows
    massing    where the rooms lie: a layout of rows, a cluster or bars is chosen and drawn
    rows       rooms side by side in one row
    cluster    rooms around one central room
    bars       a central room with corridors, and rooms along each
    facades    the stretches of wall that two rooms share, or that face the open air
    openings   doors, passages and windows
"""
