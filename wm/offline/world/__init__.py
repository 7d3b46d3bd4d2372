"""The exact offline world of a scene: every room dressed and lit, seen from any camera.

    world       World; worker: in a process of its own
    room        a room baked; pieces: its furniture; edit: changes of one image
    surfaces/   walls, floors, ceilings as sheets of texels
    materials/  procedural functions of position and normal; noise: what they are made of
    light/      daylight and lamps, baked
    pyramid     textures at several sizes
    tone        the tone curve
"""
