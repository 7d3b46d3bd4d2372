"""Reconstruction by real models: an image and a mask become a mesh.

    image_to_3d           the backend: any image-to-3D model, served by a worker in its own interpreter
    sam3d_objects         the same for SAM-3D-Objects, with the script that serves it
    sam3d_objects_worker  that script, run by the interpreter of SAM-3D-Objects
    example_worker        a script to begin a new one from: a box around the points, without any weights
    model_mesh            a model's mesh file as an object: decimated, colours in a texture
    baking                colours of a fine mesh as a texture of a coarse one
    surface_distance      the distance of points from a mesh
    pose                  where the object stands: as the model says, or as its outline and depth in the image say

The two scripts are run by path in other interpreters and import nothing of wm.
"""
