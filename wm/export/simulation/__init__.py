"""The house for simulators: rigid bodies in a fixed building, as MuJoCo's MJCF, URDF and OpenUSD.

    mjcf         target mjcf: write, check
    urdf         target urdf: write, check
    usd          target usd: write, check
    usd_stage    the stage: prims of rooms, objects, colliders and materials
    usd_splats   the gaussians as OpenUSD's own prims
    settling     settle: does everything that stands stay where it stands
    house        simulated: bodies, building and looks of a run
    bodies       rigid_body: mass, inertia and hulls of an object
    substances   how heavy materials are
    parts        the pieces of which an object is put together
    hulls        convex_hull
    shell        the building as a prism behind each triangle
    looks        colours and textures of objects and of the building
    wavefront    meshes as OBJ and STL
    rotations    rotations as the formats write them
    identifiers  names that every format takes
    library      library: mujoco, usd-core and yourdfpy, when they are needed
    files        the files of one target, written whole
"""
