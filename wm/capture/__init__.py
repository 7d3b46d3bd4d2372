"""Posed images, depth, normals and labels along a trajectory through a run: python -m wm.capture RUN.

    __main__      the command line
    request       CaptureRequest, parse_request: what is asked, from words
    trajectories  stations: cameras of a walk, an orbit, the run's views or a file
    labels        label_table: instances and classes
    frames        FrameMaker: what a camera sees
    png           depth, normals and numbers as PNG files
    nerfstudio    a folder with transforms.json and a point cloud
    tum           a folder as those of the TUM RGB-D benchmark
    npz           one file a frame
    capturing     capture: a trajectory in all formats
"""
