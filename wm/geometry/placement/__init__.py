"""Furniture in a room: where it may stand, what it rests on, and where people can still walk.

    placing        place_objects: reconstructed things become furniture
    laws           the laws of a furnished room, checked on meshes
    clearances     the metres that furniture keeps; why "may this stand here?" has two engines
    occupancy      what of a room is taken, and whether one more measured box may stand there
    stacking       one thing on another
    support        what a thing rests on, told by its label
    upright        setting things upright and moving them
    upright_box    boxes that stand upright
    navigation     navigability: the occupancy grid and its largest component
    navmesh        build_navmesh: where a body can be, as triangles by room
    spawn          standing places to begin at: of the house, of each room
"""
