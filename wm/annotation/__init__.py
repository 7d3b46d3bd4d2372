"""The annotation page: a person clicks at the furniture in the drawings of a run, and segmentation=sam3_clicks goes by it.

    session  Session: what is marked in each drawing, and the masks that clicks give
    overlay  a mask as a picture that lies over the image
    server   serve: the page and its requests, for this machine only

The page itself is `page/`: HTML, CSS and JavaScript without a build step and without anything from the network. Backends are
reached by name (wm.synth.registry). `python -m wm.annotate RUN` opens it; docs/annotation.md says how it is used.
"""
