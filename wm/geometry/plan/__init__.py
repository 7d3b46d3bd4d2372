"""Floor plans: what they are, how they are read, and where their walls and openings lie.

    records        FloorPlan, Room, Opening, and the violations of a plan
    layout_json    layout text to records, every syntax fault named
    layout_schema  the JSON schema of layout text, for language models
    object_json    furniture that a plan lists itself
    units          lengths of other units to metres, and other words for openings
    outlines       rings of points: direction, holes drawn as slits
    snapping       walls that nearly touch, made to touch
    repair         walls drawn as gaps and rooms drawn over others, mended where that is asked for
    fitting        openings moved or narrowed to where they fit
    adapting       what is carried in another form, and what may not be meant
    rules          how rooms fit together, every broken rule named
    files          plans of IFC, DXF, ProcTHOR, Infinigen and polygons, as layouts
    loading        load_plan, parse_plan, plan_to_json
    walls          the straight walls and the rooms behind them
    portal         Portal: one opening where it lies in the building
    openings       portals: every opening of a plan on its wall
    connected      connected_parts, entrances: where people walk, and where they come in
    footprint      the free floor of each room
    site           one room as furniture meets it, and a portal as one wall shows it
"""
