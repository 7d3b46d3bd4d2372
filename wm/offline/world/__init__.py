"""The exact offline world of a scene: every room dressed and lit, seen from any camera.

    world       World: the image and the G-buffer of a camera
    worker      a world in a process of its own
    room        one room, dressed and lit
    pieces      the look of its objects
    edit        changes of the world for one image
    surfaces/   walls, floors, ceilings, reveals and panes as sheets of texels
    materials/  procedural materials, functions of position
    light/      daylight, sun and lamps, baked
    noise       the noise and pattern primitives that materials are made of
    _noise_sum  octaves of gradient noise, compiled
    pyramid     textures at several resolutions
    tone        the tone curve
"""
