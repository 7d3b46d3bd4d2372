"""Triangle meshes of a scene: the structure carved from solids, objects added to it, and both written to files.

    axes             y up for z up, OpenGL's cameras for OpenCV's
    scene_mesh       assemble_scene, check_mesh, normals and boxes
    labelled_solids  solids with a label on every plane, and how they are carved
    slivers          triangles without height removed
    structure        build_structure: the watertight building
    object_colors    base colours at points of objects
    glb              save_glb
    glb_nodes        GlbNode, GlbLight, object_nodes
    glb_lights       house_lights: point lights of things that glow, and of rooms where nothing does
"""
