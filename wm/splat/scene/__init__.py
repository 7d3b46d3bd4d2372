"""A scene of many rooms: each a fit of its own beside frozen neighbours.

    scene_fit       fit_scene
    room_task       what the fit of one room reads
    room_worker     rooms in processes of their own
    scene_progress  progress and checkpoints
    scene_render    SceneRenderer: only the rooms that a camera may see are projected
"""
