"""wm: a theme in words becomes a navigable multi-room 3D scene.

`wm.geometry`, `wm.splat` and `wm.synth` can each be used alone from Python; `python -m wm.run` runs them one after another.
Importing `wm` itself loads none of its modules. Each imports only those below it (docs/architecture.md):

    run           the command line: main, one run, a sweep
    annotate      the annotation page's command line: main
    cli           between typed words and a checked configuration: composition, help, completion
    annotation    the page on which a person marks the furniture in a run's drawings
    pipeline      run: the stages of a run in order
    check         proves an exported run with the tools of those who use it
    view          the page on which a finished run is walked through
    compare       scenes of other methods beside ours, on the same trajectories
    study         a study in which people rate and compare videos
    capture       posed images, depth, normals and labels along a trajectory
    export        what other programs take of a finished run, one module a target
    finished      a finished run read back as records
    stages        one stage a module, each with its entry in the run folder
    report        report.html, figures, the video, the table that compares runs
    meter         time and peak memory of each stage
    artifacts     the run folder: entries stored under a key of all their inputs
    codecs        the file formats of entries
    offline       the offline stand-ins for models
    models        backends of real models
    splat         gaussian splatting: rasterizer, fit, metrics
    synth         the method: protocols of backends, condition, verification, painting, lifting, proposing
    quality       CLIP-IQA+ and the aesthetic score of images
    geometry      plans, meshes, rays, texture, cameras, placement
    numerics      guards, each correct in value and gradient
    validate      whether a configuration can be run
    metric_table  METRICS: the name, unit, format and definition of every metric
    services      requests to models: kept answers, retries, budget, prices, what a run has paid
    types         records of data that several packages share
    schema        records of settings
    color         sRGB and linear light
    process       worker processes
    bounds        what a field of a settings record may hold
    memory        resident memory of this process and its children
    compiler_options  options for jax.jit on a CPU
    console       lines for the user, on streams that may be closed or full
    environment   texts of a configuration that come out of the environment, never shown
    host          what the machine has
    errors        InputError and its kinds: what the caller asked for cannot be done
"""

__version__ = "0.1.0"
