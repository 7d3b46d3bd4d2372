"""A room drawn: an image model makes its empty room a furnished one, and a depth model measures what it drew."""

import dataclasses

import numpy as np

from wm.geometry.plan.site import room_site
from wm.geometry.rays.raycast import RayScene, build_ray_scene, cast
from wm.services.faults import RefusedError, ServiceError
from wm.synth.backends import Condition, ImageBackend, ImageRequest, ImageResult, SceneContext, Surroundings
from wm.synth.checked import checked_estimate, checked_image
from wm.synth.condition import depth_grey
from wm.synth.lifting.drawings import drop_drawings, keep_drawing
from wm.synth.lifting.metric_depth import metric_depth
from wm.synth.lifting.models import Models
from wm.synth.prompts import furnish_prompt
from wm.synth.seeds import room_number
from wm.synth.sights import sights
from wm.types import Camera, View

_ATTEMPTS = 4
"""Seeds of a drawing that are tried before the image model's refusals end the run."""


@dataclasses.dataclass(frozen=True, eq=False)
class Drawing:
    """An image of the furnished room and its depth."""

    result: ImageResult
    depth: np.ndarray  # [h, w] metres
    where: Surroundings
    seed: int

    @property
    def camera(self) -> Camera:
        return self.where.view.camera


def drawing_seed(*numbers: int) -> int:
    """The seed of a drawing, of an attempt at one, or of a reconstruction, from the numbers that tell it from others."""
    return int(np.random.SeedSequence([*numbers, 0x11F7]).generate_state(1)[0])


def draw_room(context: SceneContext, room: int, cameras: list[Camera], models: Models) -> list[Drawing]:
    """One drawing a camera, without those whose depth cannot be made metric. The later ones are shown the first.

    Each is kept in the run folder as soon as it is drawn, if there is one.
    """
    bare, number = build_ray_scene(context.structure), room_number(context.plan, room)
    id = context.plan.rooms[room].id
    drawings: list[Drawing] = []
    for k, camera in enumerate(cameras):
        view = View(camera, room, "bootstrap", f"{id}/furnish{k}")
        reference = drawings[0].result.rgb if drawings else None
        seed = drawing_seed(context.seed_of("furnish"), number, k)
        drawing = _draw(context, view, bare, models, reference=reference, seed=seed)
        drawings += [drawing] if drawing is not None else []
    if models.folder is not None:
        names = {drawing.where.view.name for drawing in drawings}
        drop_drawings(models.folder, lambda name: name.rpartition("/")[0] == id and name not in names)
    return drawings


def _draw(
    context: SceneContext, view: View, bare: RayScene, models: Models, *, reference: np.ndarray | None, seed: int
) -> Drawing | None:
    """One image of the room furnished, with its depth; None if that cannot be made metric."""
    gbuffer = cast(bare, view.camera)
    grey = depth_grey(gbuffer, (0.0, max(float(gbuffer.depth.max()), 1e-3)))
    condition = Condition(
        rgb=np.repeat(grey[..., None], 3, axis=-1), known=np.zeros_like(grey), depth=gbuffer.depth, objects="none",
        wall_texture=False,
    )  # fmt: skip
    name = context.plan.rooms[view.room].name
    seen = sights(view.camera, room_site(context.plan, view.room))
    request = ImageRequest(
        condition=condition,
        reference=reference,
        prompt=furnish_prompt(context.theme, name, seen, has_reference=reference is not None),
        view=view,
        seed=seed,
        task="furnish",
        theme=context.theme,
        room=name,
        sights=tuple(seen),
    )
    result = _drawn(models.image, request)
    estimate = checked_estimate(models.depth.estimate(result, camera=view.camera, seed=seed), view)
    depth = metric_depth(estimate, gbuffer.depth, seed=seed) if estimate is not None else None
    if depth is None:
        return None
    if models.folder is not None:
        keep_drawing(models.folder, view.name, name, result.rgb)
    where = Surroundings(theme=context.theme, room=name, view=view, folder=models.folder)
    return Drawing(result=result, depth=depth, where=where, seed=seed)


def _drawn(image: ImageBackend, request: ImageRequest) -> ImageResult:
    """The image of the first attempt that the model does not refuse.

    Raises:
      ServiceError: it refuses every attempt.
    """
    refusals: list[str] = []
    for attempt in range(_ATTEMPTS):
        again = request if attempt == 0 else dataclasses.replace(request, seed=drawing_seed(request.seed, attempt))
        try:
            result = image.generate(again)
        except RefusedError as refusal:
            refusals.append(str(refusal))
            continue
        return dataclasses.replace(result, rgb=checked_image(result.rgb, request.view))
    raise ServiceError(f"view {request.view.name}: the image model refused {_ATTEMPTS} attempts; the last time: {refusals[-1]}")
