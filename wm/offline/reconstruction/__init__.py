"""The offline reconstruction backend: parametric furniture fitted to what images show.

    templates         the backend: an instance reconstructed as the template that fits best
    kinds             labels, and the templates that they select
    template_fit      fit_template: the size and pose of a template, fitted to observations
    template_cost     how badly a template of a given size and pose explains the observations
    template_surface  points on the surface of a template
    coloring          the colours of slots, taken from the images
    texturing         textures of objects, projected from the images
"""
