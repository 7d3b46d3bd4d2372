"""The method: from a theme to a plan, and from a scaffold to images of it. Models are reached through protocols only.

    backends       the protocol of each group of backends, and the records that go in and come out
    registry       make_backend: the module that a configuration names, imported and checked
    checked        what a backend returns, checked where it comes in
    room_names     the sort of room that a name speaks of
    proposing      propose_plan: the language model asked for a plan until its answer is valid
    furnished      Furnisher: the objects of a room, from the objects backend
    lifting        the image-driven objects backend: furniture out of images
    condition      the condition X: what the image model is shown of the scaffold
    order          the order in which views are painted, the reference of each, and the anchors of a scene
    prompts        the prompts of the image model
    sights         the doors and windows that a view shows, in words
    canny          depth edges
    alignment      depth estimates brought to the scale and shift of the scaffold
    scale_field    the drift of an estimate's scale over the image
    verify         whether an image keeps the structure of the scaffold
    agreement      the pixels at which an image that failed may still be used
    attempt        paint_view: one view generated, verified, and tried again
    room_painting  the views of one room: condition, generate, verify, project into the texture
    side_by_side   several rooms at once, which end as a whole
    painting       paint_scene: the anchors, then all rooms, their texture joined in one atlas
    object_ids     with_ids: one id an object, by its room and label
    plan_text      the floor plan in a language model's answer, whatever is wrapped around it
    seeds          the seed that each part of a scene draws from, and the number of a room
"""

from wm.synth.backends import Condition, ImageRequest, ImageResult, SceneContext
from wm.synth.registry import make_backend

__all__ = ["Condition", "ImageRequest", "ImageResult", "SceneContext", "make_backend"]
