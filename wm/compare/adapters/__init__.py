"""One small module for each system whose files are read; docs/comparison.md has their table.

    registry       adapter_for, identity_of, read_scene: every adapter by name
    files          one_file, reading: files found and read, with errors that name the method
    own_cameras    own_cameras: the transforms.json beside a scene, and which way is up by it
    ours           a run folder
    wonderworld    .splat, and a PLY with activations of its own
    flexworld      PLY with colours as logits
    layerpano3d    the PLY of the last layer
    worldexplorer  PLY, antialiased
    spatialgen     views and depths in an archive of NumPy's
    dreamscene360  PLY of degree 3
    splats         any file of gaussians
    mesh           any textured mesh
"""
