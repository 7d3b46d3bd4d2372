"""Objects brought in from files of others and handed to trimesh. trimesh is imported when one of these is called, not before.

    object_file   load_object: a GLB, glTF, OBJ, PLY or other mesh file as one SceneObject
    parts         the triangles of a file, each with what colours it
    gltf_header   what a glTF file says of its materials that trimesh does not hand on
    vertex_color  colours given at vertices, as slots or as a texture
    trimeshes     object_to_trimesh
    mesh_error    MeshError: a file that holds no usable object
    plan_objects  the furniture that a plan lists itself, as objects of the scene
"""
