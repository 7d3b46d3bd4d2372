"""Floor plans: what they are, how they are read, and where their walls and openings lie.

    records        FloorPlan, Room, Opening, and the violations of a plan
    layout_json    layout text to records, every syntax fault named
    rules          what rooms mean together, every broken rule named
    loading        load_plan, parse_plan, plan_to_json
    walls          the straight walls and the rooms behind them
    openings       where openings lie on their walls
    footprint      the free floor of each room, and the portals between rooms
    site           one room as furniture meets it
"""
