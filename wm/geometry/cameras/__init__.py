"""Where cameras stand and what they see.

    views            place_cameras: the training views of every room
    heldout          place_heldout: views that are never trained on
    walk             walkthrough: the path of the video
    gaze             what its visitor looks at
    air              the free air of a room
    stations         positions along the walls
    aim              where each camera looks
    exposed_surface  what an eye may see from anywhere in a room
    visibility       coverage: which surfaces the views see
    sightlines       visible_rooms: which rooms a view looks into
    camera_file      load_cameras: views from cameras.json or any transforms.json
    colmap           save_colmap: views and points as COLMAP's sparse model
"""
