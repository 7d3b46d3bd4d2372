"""The offline image backend: it paints the offline world, with the flaws that image models have.

    painter        the backend
    imagination    what it invents where its condition leaves something open
    imperfections  errors of tone, exposure, detail and sharpness
    violations     images that do not keep the structure of the scaffold
"""
