"""The stages of a run: each is a function of the run's context and of the results of the stages before it.

    run_context     RunContext: the configuration, the run folder and the meter, which every stage needs
    asking          open_services: what backends ask models through, and what that will cost
    scene           build_scene: the stages plan, structure, furnish and cameras
    unfurnished     unfurnished: rooms that stay empty although their furniture should come out of images
    painting        paint: an image for every training view
    heldout         render_heldout: the true image of each held-out view
    reconstruction  reconstruct: gaussians from the painted views
    starting        starting_gaussians: the initial gaussians of a room
    tucked          tucked: discs on unseen surface that no view sees
    warm_up         warming_up: what the fit will run is compiled while views are painted
    executors       room_executor: the executor that fits rooms, by its name in the configuration
    evaluation      evaluate: the metrics, measured on held-out views
    scoring         scores_of: what CLIP makes of the pictures of held-out views
    reporting       report: metrics.json, the fly-through and report.html
    ordered         in_order: a parallel map over threads that yields its results in order
    hearing         hear: what the backends make of the theme's words, and `theme.json`
    edits           files that a user has changed by hand are used, and never overwritten without a copy
    arranged        the rows of an edited `objects.json` applied to the objects of a run
    history         the error curve of the fit as a file
    progress        a bar on a terminal, plain lines elsewhere
"""
