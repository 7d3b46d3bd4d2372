"""Reconstruction by an image-to-3D model in its own interpreter: an image, a mask and the points that it shows become a mesh.

    worker    is given the image that shows most of the thing, the mask, and the points of its pixels; answers with a GLB file
              and, if it knows, where the points of the file lie
    mesh      is read, decimated, its colours put into slots or a texture (model_mesh)
    pose      is the model's, if the points that the images show lie near the mesh then; else it is fitted (pose)
    seed      is drawn again if the model refuses or its mesh explains nothing; then the thing is left out

docs/workers.md says what a worker is asked and answers. The light of the image stays in the colours.
"""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely
from jaxtyping import Float

from wm.bounds import number, setting
from wm.geometry.placement.upright_box import box_of
from wm.geometry.plan.site import Site
from wm.geometry.rays.pinhole import unproject_depth
from wm.models.reconstruction.model_mesh import model_mesh
from wm.models.reconstruction.pose import ModelPose, fitted, posed
from wm.models.reconstruction.surface_distance import surface_distance
from wm.models.worker.asking import WorkerModel, answer_arrays, answer_values
from wm.models.worker.settings import WorkerSettings
from wm.services.faults import RefusedError, ServiceError
from wm.services.records import Quote, ServiceAnswer
from wm.services.services import Services
from wm.synth.backends import Observation, Reconstruction, SceneContext
from wm.synth.lifting.observations import near_together, observation_points, trimmed
from wm.synth.lifting.vocabulary import largest_size
from wm.synth.lifting.world_mesh import as_reconstruction
from wm.types import SceneObject

VERSION = "1"
SERVED = True
MESH = "mesh.glb"
"""The file of an answer that holds the mesh."""
_POINTS = 2000
"""Points of an observation from which the residual is taken."""
_LEAST = 12
"""Smallest number of observed points for a reconstruction."""
_OUTSIDE = 0.25
"""Metres by which the middle of a thing may lie outside the room: what hangs on a wall is moved to it later."""


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class ImageTo3DSettings(WorkerSettings):
    """What every image-to-3D backend has."""

    checkpoint: str = setting("", "Weights that the script loads: a file, a folder, or a name of the hub.")
    faces: int = number(10_000, 100, 5_000_000, "Faces above which a mesh is decimated.")
    texels: int = number(360_000, 1000, 50_000_000, "Pixels of the texture of a decimated mesh, about.")
    tolerance: float = number(0.12, 0.001, 10, "Median distance of the observed points up to which a mesh fits them.", unit="m")
    attempts: int = number(2, 1, 20, "Seeds that are tried before a thing is left out.")


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(ImageTo3DSettings):
    """Reconstruction by an image-to-3D model that a script of your own serves."""

    backend: str = setting(__name__, "An image-to-3D model in its own interpreter.")


class ImageTo3D:
    """The backend. It holds a process, and with it the memory of a device, until it is closed."""

    def __init__(self, settings: ImageTo3DSettings, model: WorkerModel):
        self.settings, self.model = settings, model

    def with_services(self, services: Services) -> "ImageTo3D":
        """The same backend, which asks through these. Both ask the same worker."""
        return ImageTo3D(self.settings, self.model.with_services(services))

    def quote(self) -> Quote:
        """A local model costs no money, and nobody knows how many seconds."""
        return self.model.quote()

    def close(self) -> None:
        """Ends the worker."""
        self.model.close()

    def reconstruct(
        self, label: str, observations: Sequence[Observation], site: Site, room: int, *, seed: int
    ) -> Reconstruction | None:
        """One thing, in the frame of the first observation's camera.

        Args:
          label: the name of the thing in any words.
          observations: of the thing. The model is given the one that shows most pixels of it, and all of them judge its mesh.
          site: the room in which the thing stands.
          room: index of the room, which is stored in the result.
          seed: of the model.

        Returns:
          The reconstruction; None if too few points are observed, or no attempt gave a mesh that explains them.

        Raises:
          ServiceError: the worker cannot be run, or breaks its protocol.
          MissingExtraError: the mesh must be decimated, and the package for it is not installed.
        """
        points = np.concatenate([trimmed(observation_points(one, limit=_POINTS, seed=seed)) for one in observations])
        points = near_together(points, largest_size(label))
        best = max(observations, key=lambda one: int((one.mask & (one.depth > 0)).sum()))
        if len(points) < _LEAST or not (best.mask & (best.depth > 0)).any():
            return None
        fault = ""
        for attempt in range(self.settings.attempts):
            try:
                thing, residual = self._attempt(label, best, points, site, room, _seed(seed, attempt))
            except RefusedError as refusal:
                fault = str(refusal)
                continue
            return as_reconstruction(thing, observations[0].camera, residual=residual)
        self.model.services.say(f"{label}: left out after {self.settings.attempts} attempts; the last: {fault}")
        return None

    def _attempt(
        self, label: str, seen: Observation, points: np.ndarray, site: Site, room: int, seed: int
    ) -> tuple[SceneObject, float]:
        """(the thing in the world, its residual). Raises: RefusedError if another seed may give a better one."""
        request, arrays = question(label, seen, seed)
        answer = self.model.ask(request, arrays)
        if MESH not in answer.files:
            raise ServiceError(f"{self.model.script}: an answer has no {MESH}, but {', '.join(answer.files) or 'nothing'}")
        thing = model_mesh(
            answer.files[MESH], label=label, room=room, most_faces=self.settings.faces, texels=self.settings.texels
        )
        placed, residual = self._placed(thing, told_pose(answer), seen, points)
        if not shapely.contains_xy(site.polygon.buffer(_OUTSIDE), *box_of(placed).center):
            raise RefusedError("its mesh stands outside the room")
        return placed, residual

    def _placed(
        self, thing: SceneObject, pose: ModelPose | None, seen: Observation, points: np.ndarray
    ) -> tuple[SceneObject, float]:
        """(the thing in the world, its residual), by its model's pose or by a fitted one. Raises: RefusedError if neither is near
        the points."""
        placed = None if pose is None else posed(thing, pose, seen.camera)
        residual = _residual(placed, points)
        if residual > self.settings.tolerance:
            other = fitted(thing, seen)
            placed, residual = min(((placed, residual), (other, _residual(other, points))), key=lambda one: one[1])
        if placed is None or not np.isfinite(residual):
            raise RefusedError("its mesh fits nowhere into the image")
        if residual > self.settings.tolerance:
            raise RefusedError(f"its mesh lies {residual:.2f} m from the points that the images show")
        return placed, residual


def make(settings: ImageTo3DSettings, context: SceneContext | None = None) -> ImageTo3D:
    """The backend of a script of the user's own. It does not use the scene."""
    return ImageTo3D(settings, WorkerModel(settings, {"checkpoint": settings.checkpoint}))


def question(label: str, seen: Observation, seed: int) -> tuple[dict[str, Any], Mapping[str, np.ndarray]]:
    """What a worker is asked about an observation: (JSON values, arrays), as docs/workers.md lists them."""
    camera = seen.camera
    request = {
        "task": "image_to_3d", "label": label, "seed": seed,
        "focal": np.asarray(camera.focal, np.float64).tolist(), "principal": np.asarray(camera.principal, np.float64).tolist(),
        "up": np.asarray(camera.T_cam_world, np.float64)[:3, 2].tolist(),
    }  # fmt: skip
    rgb = np.round(255 * np.clip(seen.rgb, 0, 1)).astype(np.uint8)
    return request, {"rgb": rgb, "mask": seen.mask, "points": camera_points(seen)}


def camera_points(seen: Observation) -> Float[np.ndarray, "h w 3"]:
    """[h, w, 3] float32 the points of an image's pixels in its camera (x right, y down, z forward), metres, NaN where unknown."""
    T_cam_world = np.asarray(seen.camera.T_cam_world, np.float64)
    points = unproject_depth(seen.camera, seen.depth) @ T_cam_world[:3, :3].T + T_cam_world[:3, 3]
    return np.where(seen.depth[..., None] > 0, points, np.nan).astype(np.float32)


def told_pose(answer: ServiceAnswer) -> ModelPose | None:
    """Where an answer says that its mesh lies; None if it says nothing.

    Raises:
      RefusedError: it says something that is no pose, such as a scale that is not finite.
    """
    values = answer_values(answer) | answer_arrays(answer)
    told = [values.get(name) for name in ("scale", "rotation", "translation")]
    if all(one is None for one in told):
        return None
    try:
        scale, rotation, translation = (np.asarray(one, np.float64) for one in told)
        scale = np.broadcast_to(scale.reshape(-1), 3)
        rotation, translation = rotation.reshape(3, 3), translation.reshape(3)
    except (ValueError, TypeError) as error:
        raise RefusedError(f"its pose is no scale, rotation [3, 3] and translation [3]: {error}") from error
    if not all(np.isfinite(one).all() for one in (scale, rotation, translation)):
        raise RefusedError("its pose is not finite")
    turned = np.abs(rotation @ rotation.T - np.eye(3)).max() < 1e-3 and np.linalg.det(rotation) > 0
    if not (turned and (scale > 0).all()):
        raise RefusedError("its pose is no rotation and positive scale")
    return ModelPose(scale=scale, rotation=rotation, translation=translation)


def _residual(thing: SceneObject | None, points: np.ndarray) -> float:
    """Median distance of points from a thing, metres; infinite for none."""
    return np.inf if thing is None else float(np.median(surface_distance(points, thing.vertices, thing.faces)))


def _seed(seed: int, attempt: int) -> int:
    return seed if attempt == 0 else int(np.random.SeedSequence([seed, attempt, 0x3D]).generate_state(1)[0])
