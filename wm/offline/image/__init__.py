"""The offline image backend.

    painter        the backend: paints the offline world, and behaves as an image model does
    imagination    what it invents where its condition leaves something open
    imperfections  tone, exposure, detail, sharpness
    violations     how it leaves the scaffold
"""
