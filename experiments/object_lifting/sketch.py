"""An image model without light: the furniture of a scene in its own colours under a headlight.

The estimator reads depth, masks and labels; colours decide only colours. So where boxes and laws are asked about, a room need
not be dressed and lit before it is drawn, which is half of what lifting it costs.
"""

import dataclasses

import numpy as np

from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.rays.raycast import RayScene, build_ray_scene, cast
from wm.synth.backends import ImageRequest, ImageResult, SceneContext
from wm.synth.condition import make_condition
from wm.types import OUTSIDE


@dataclasses.dataclass(frozen=True, eq=False)
class Sketch:
    """The image backend."""

    context: SceneContext  # with the furniture that the model has in mind
    scene: RayScene

    def generate(self, request: ImageRequest) -> ImageResult:
        """What the request's camera sees of the furnished scene; the condition and the seed change nothing."""
        camera, mesh = request.view.camera, self.scene.mesh
        gbuffer = cast(self.scene, camera)
        seen = make_condition(gbuffer, camera, None, mesh, self.context.objects, (0.0, 20.0))
        thing = np.append(mesh.face_object, np.int32(OUTSIDE))[gbuffer.face]
        labels = tuple(thing.label for thing in self.context.objects)
        return ImageResult(rgb=seen.rgb, drawn_depth=gbuffer.depth, drawn_object=thing, drawn_labels=labels)


def sketch_of(imagined: SceneContext) -> Sketch:
    """The model of a scene."""
    return Sketch(imagined, build_ray_scene(assemble_scene(imagined.structure, imagined.objects)))
