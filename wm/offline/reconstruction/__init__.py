"""The offline reconstruction backend: parametric furniture fitted to what images show.

    templates         the backend
    kinds             labels and the templates they ask for
    template_fit      size and pose; template_cost: how well they explain the images; template_surface: points on a template
    coloring          colours of slots
    texturing         textures from the images
"""
