"""Furniture from images: segmentation, reconstruction, placement (paper, "Object Instantiation").

    lifted        the objects backend: draw, segment, reconstruct, place
    models        the models that lift a room, made and closed together
    drawing       a room drawn by the image model, and measured by the depth model
    drawings      the drawings that are kept in the run folder
    clicks        what a person has marked in them
    usual_things  the furniture that rooms of a sort usually have
    metric_depth  relative depth made metric by the known depth of the empty room
    segments      segments made tidy
    observations  which segments of several images are observations of one instance, and the points that they show
    vocabulary    what labels name, and how large such things usually are
    unlit         colours of surfaces, separated from the room's light
    world_mesh    a mesh of a model as a reconstruction
"""
