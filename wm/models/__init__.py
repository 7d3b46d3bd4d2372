"""Backends of real models.

    image        images of views
    depth        depth of images
    extras       packages that are not installed, and what installs them
    local_model  LocalModel: a PyTorch model in this process: loaded once, asked one call at a time, freed
    weights      Weights: which weights a local model has, and how they are loaded whole

Packages that only they need are extras of wm, imported when the first request is sent.
"""
