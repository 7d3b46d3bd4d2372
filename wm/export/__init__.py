"""What other programs take of a finished run, one module a target: python -m wm.export RUN to=[...].

    __main__      the command line
    exporting     export, exported_table: several targets of one run
    targets       TARGETS: the targets by name, and the module of each
    records       ExportError, Check
    navmesh       where a body can walk
    scaffold      scaffold.glb: rooms, furniture, lights and cameras
    simulation/   the house for simulators: MJCF, URDF, OpenUSD
    splats/       gaussians in the formats that viewers open
    world         world.json: rooms, openings, objects and spawn points
    words         words of a command line: a folder, and keys with their values
"""
