"""Furnished rooms: functional groups by room type, at walls, in the middle, on surfaces.

    furnishing        a plan's rooms furnished, in world space
    arrange           furnish_site: everything in one room
    room_type         the type of a room, by its name
    programmes        the functional groups of the rooms that most houses have
    rooms_equipped    what stands in every other type of room: a table
    equipped          what a row of that table says
    equipment         single things: at walls, on them, in the middle, spread over the floor
    assemblies        rows, tables with chairs, counters, benches with seats, beds
    writing           a desk with its chair
    inventory         what else a room of each type may hold, and what each style family has
    groups            pieces that belong together, around an anchor
    wet_groups        kitchens and bathrooms
    hangings          lamps, pictures, mirrors, cupboards, curtains
    clutter           small things on surfaces
    room_arrangement  RoomArrangement: one room while it is being furnished
    layout            where one more piece may stand
    floor             what a piece leaves of the floor, and what it closes off
    wishes            what a theme asks of some kinds of furniture, done to a furnished room
"""
