"""Offline stand-ins for every model: deterministic, without weights, keys or network.

What the stand-ins share:

    style        what a theme looks like
    furniture    parametric furniture
    arrangement  rooms furnished by functional groups
    world        the furnished scene, textured and lit

The backends, one folder per group:

    language        a seeded grammar of floor plans
    image           a painter of the offline world
    objects         parametric furniture for every room
    depth           the depth that the painter drew, with the errors of an estimator
    segmentation    the instances that the painter drew
    reconstruction  parametric furniture fitted to images
"""
