"""wm: a theme in words becomes a navigable multi-room 3D scene.

`wm.geometry`, `wm.splat` and `wm.synth` can each be used alone from Python; `python -m wm.run` runs them one after another.
Importing `wm` itself loads none of its modules. Each imports only those below it (docs/architecture.md):

    run           the command line
    completion    words that TAB completes
    help          what --help prints
    command_line  plain words translated into overrides
    keys          every key that can be set, and what it means
    composition   the YAML of conf/ and overrides composed into one checked RunConfig
    pipeline      run: the stages of a run in order
    stages        one stage a module, each with its entry in the run folder
    report        report.html, figures, the video, the table that compares runs
    neighbours    the reuse cache: finished stages taken over from other run folders
    artifacts     the run folder: entries stored under a key of all their inputs
    codecs        the file formats of entries
    meter         time and peak memory of each stage
    offline       the offline stand-ins for models
    models        backends of real models
    splat         gaussian splatting: rasterizer, fit, metrics
    synth         the method: protocols of backends, condition, verification, painting, lifting, proposing
    geometry      plans, meshes, rays, texture, cameras, placement
    numerics      guards, each correct in value and gradient
    validate      whether a configuration can be run
    metric_table  METRICS: the name, unit, format and definition of every metric
    types         records of data that several packages share
    schema        records of settings
    color         sRGB and linear light
    process       worker processes
    bounds        what a field of a settings record may hold
    memory        resident memory of this process and its children
    host          what the machine has
    errors        InputError: an error that the user can mend
"""

__version__ = "0.1.0"
