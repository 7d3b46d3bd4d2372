"""Floor plans: what they are, how they are read, and where their walls and openings lie.

    records        FloorPlan, Room, Opening, and the violations of a plan
    layout_json    layout text to records, every syntax fault named
    layout_schema  the JSON schema of layout text, for language models
    object_json    furniture that a plan lists itself
    units          lengths of other units to metres, and other words for openings
    snapping       walls that nearly touch, made to touch
    rules          how rooms fit together, every broken rule named
    loading        load_plan, parse_plan, plan_to_json
    walls          the straight walls and the rooms behind them
    portal         Portal: one opening where it lies in the building
    openings       portals: every opening of a plan on its wall
    footprint      the free floor of each room
    site           one room as furniture meets it, and a portal as one wall shows it
"""
