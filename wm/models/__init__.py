"""Backends of real models: a module for each, in the folder of its group, and what they share.

    depth           depth of images
    reconstruction  meshes of pieces of furniture
    worker          models in an interpreter of their own

Nothing but what the standard library and wm's own dependencies offer is imported before a model is asked.
"""
