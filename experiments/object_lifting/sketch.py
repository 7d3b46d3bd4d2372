"""An image model without light: the furniture of a scene in its own colours under a headlight.

The estimator reads depth, masks and labels; colours decide only colours. So where boxes and laws are asked about, a room need
not be dressed and lit before it is drawn, which is half of what lifting it costs.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.rays.raycast import RayScene, build_ray_scene, cast
from wm.offline.arrangement.furnishing import furnish_scene
from wm.synth.backends import ImageRequest, ImageResult, SceneContext
from wm.synth.condition import make_condition
from wm.types import OUTSIDE, SceneObject


@dataclasses.dataclass(frozen=True, eq=False)
class Sketch:
    """The image backend."""

    context: SceneContext  # with the furniture that the model draws
    scene: RayScene

    def imagined(self) -> Sequence[SceneObject]:
        """The furniture that the sketches show."""
        return self.context.objects

    def generate(self, request: ImageRequest) -> ImageResult:
        """What the request's camera sees of the furnished scene; the condition and the seed change nothing."""
        camera, mesh = request.view.camera, self.scene.mesh
        gbuffer = cast(self.scene, camera)
        seen = make_condition(gbuffer, camera, None, mesh, self.context.objects, (0.0, 20.0))
        thing = np.append(mesh.face_object, np.int32(OUTSIDE))[gbuffer.face]
        labels = tuple(thing.label for thing in self.context.objects)
        return ImageResult(rgb=seen.rgb, drawn_depth=gbuffer.depth, drawn_object=thing, drawn_labels=labels)


def sketch_of(context: SceneContext) -> Sketch:
    """The model that furnishes a scene as the offline image model does."""
    objects = furnish_scene(context)
    return Sketch(dataclasses.replace(context, objects=objects), build_ray_scene(assemble_scene(context.structure, objects)))
