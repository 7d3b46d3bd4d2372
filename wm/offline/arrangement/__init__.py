"""Furnished rooms: functional groups by room type, at walls, in the middle, on surfaces.

    arrange      furnish_site: one room
    room_type    what kind of room a name means; programmes, inventory: what stands in it
    groups, wet_groups, hangings, clutter   what is placed together
    layout       where one more piece may stand; floor: what it closes off
    room_arrangement   RoomArrangement: the room being furnished
"""
