"""Furnished rooms: functional groups by room type, at walls, in the middle, on surfaces.

    furnishing        a plan's rooms furnished, in world space
    arrange           furnish_site: everything in one room
    room_type         the type of a room, by its name
    programmes        the functional groups of each type of room
    inventory         what else a room of each type may hold, and what each style family has
    groups            pieces that belong together, around an anchor
    wet_groups        kitchens and bathrooms
    hangings          lamps, pictures, mirrors, cupboards, curtains
    clutter           small things on surfaces
    room_arrangement  RoomArrangement: one room while it is being furnished
    layout            where one more piece may stand
    floor             what a piece leaves of the floor, and what it closes off
"""
