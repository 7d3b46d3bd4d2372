"""From words and a scaffold to pictures of it: backends for language, images, objects and depth, and the painting loop.

    backends     what a backend must offer, and the registry that imports the selected one
    condition    X, what the image model is shown of the scaffold
    order        in which order views are painted, and where each takes its style from
    canny        depth edges
    verify       does an image keep the scaffold's structure?
    agreement    where a failed one may still be used
    attempt      one view: generate, verify, try again
    paint        the loop: condition, generate, verify, project back
"""

from wm.synth.backends import Condition, ImageRequest, ImageResult, SceneContext
from wm.synth.registry import make_backend

__all__ = ["Condition", "ImageRequest", "ImageResult", "SceneContext", "make_backend"]
