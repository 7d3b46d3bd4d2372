"""Furniture out of images: segments, reconstruction, placement (paper, "Object Instantiation").

    lifted        the objects backend: draw, segment, reconstruct, place
    metric_depth  relative depth made metric by the empty room
    segments      segments made tidy
    sightings     which segments of several images show one thing
    unlit         surface colours without the room's light
    world_mesh    a mesh of a model as a reconstruction
"""
