"""Backends of real models: a module for each, in the folder of its group, and what they share.

    image           images of views
    language        floor plans, and names of things
    depth           depth of images
    segmentation    things in images, by names or by clicks
    reconstruction  things of images as meshes, by a model in an interpreter of its own
    worker          models in interpreters of their own: a process that is asked by lines of JSON
    access          packages of extras and secrets of the environment, when they are needed and not before
    http_client     an HTTP client whose time limit holds for a whole request
    http_faults     what goes wrong between here and a service, told apart by whether a later try helps
    local_model     LocalModel: a PyTorch model in this process: loaded once, asked one call at a time, freed
    prompt_files    Prompts: what models are told, in files of wm/models/prompts that a user's own can replace
    weights         Weights: which weights a local model has, and how they are loaded whole

Nothing but what the standard library and wm's own dependencies offer is imported before a model is asked.
"""
