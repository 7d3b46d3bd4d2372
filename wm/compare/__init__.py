"""Scenes of other methods beside ours, on the same trajectories: python -m wm.compare METHOD=PATH ...

    __main__              the command line
    words                 parse: what its words ask for
    comparison            compare: every method on every trajectory
    adapters              one module for each system whose files are read
    inputs                what other systems start from, made of a run
    records               Source, System, ComparedScene
    axes                  upright: which way is up
    bilinear              bilinear: an image between its pixels
    painted_mesh          see: a textured mesh as rays see it
    drawing               drawer_of: what a camera sees of any scene
    trajectories          Trajectory, Picture: names and files of camera paths
    trajectories_ours     RunPaths: in the free air of a run's rooms
    trajectories_foreign  ForeignPaths: in a scene of which nothing is known
    measuring             measure: the frames of a path and their figures
    consistency           consistency: whether depths tell what the next frames show
    agreement             agreement: reprojection errors by the scene's own depths
    store                 Store: what is measured already
    table                 markdown, as_csv, as_json: the table
    paper                 the paper's figures
    errors                CompareError
"""
