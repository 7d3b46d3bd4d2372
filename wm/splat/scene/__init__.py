"""A scene of many rooms: each room is a fit of its own beside frozen neighbours.

    scene_fit       fit_scene: all rooms, round by round, through an executor
    scene_rooms     SceneRooms: the states of all rooms, and what takes one through a round
    room_task       RoomTask, RoomOutcome, fit_room: the fit of one room in one round, for any executor
    scene_progress  SceneProgress, Checkpoints: called from several threads
    scene_render    SceneRenderer: only the rooms that a camera may see are projected
"""
