"""Furniture from images: segmentation, reconstruction, placement (paper, "Object Instantiation").

    lifted        the objects backend: draw, segment, reconstruct, place
    metric_depth  relative depth made metric by the known depth of the empty room
    segments      segments made tidy
    observations  which segments of several images are observations of one instance, and the points that they show
    vocabulary    what labels name, and how large such things usually are
    unlit         colours of surfaces, separated from the room's light
    world_mesh    a mesh of a model as a reconstruction
"""
