"""The protocols of backends, one per group, and the records that they take and return.

Real models are given only what the paper gives its models (condition, reference, prompt, seed); the offline stand-ins may also
look at the scene that they were made for. wm.synth.checked checks what a backend returns. wm.synth.registry describes how a
backend is selected and how a model of your own is added.
"""

import dataclasses
import pathlib
from collections.abc import Mapping, Sequence
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np

from wm.geometry.plan.site import Site
from wm.schema import BackendSettings
from wm.services.records import Quote
from wm.services.services import Services
from wm.types import Camera, Mesh, SceneObject, View


@dataclasses.dataclass(frozen=True, eq=False)
class SceneContext:
    """The scene a backend is made for."""

    theme: str
    seed: int
    plan: Any  # wm.geometry.FloorPlan
    structure: Mesh  # without objects
    objects: tuple[SceneObject, ...]  # while the scene is being furnished, those that the plan lists itself
    density: float = 1.0  # 0..1: share of the optional pieces of furniture that are wanted (furnish.density)
    seeds: tuple[tuple[str, int], ...] = ()  # parts of the scene (furnish, finish, light) that draw from a seed of their own

    def seed_of(self, part: str) -> int:
        """The seed that a part of the scene draws from."""
        return dict(self.seeds).get(part, self.seed)


@dataclasses.dataclass(frozen=True, eq=False)
class Condition:
    """What the image model is shown of the scaffold from one camera: the X of the paper."""

    rgb: np.ndarray  # [h, w, 3] float32 sRGB in [0, 1]: textured objects, blended accumulated texture, grayscale depth elsewhere
    known: np.ndarray  # [h, w] float32 in [0, 1]: 1 where rgb shows appearance, 0 where it shows depth
    depth: np.ndarray  # [h, w] float32 z-depth of the conditioning scaffold, metres, 0 where nothing is hit
    objects: str = "textured"  # how the scaffold shows objects: textured | boxes | none
    object: np.ndarray | None = None  # [h, w] bool: where the scaffold has an object or a box; None for nowhere
    wall_texture: bool = True  # whether the scaffold shows the texture that finished views have left on it
    glass: np.ndarray | None = None  # [h, w] bool: where the scaffold has a window pane or a mirror; None for nowhere


@dataclasses.dataclass(frozen=True, eq=False)
class ImageRequest:
    """What an image model is asked for one view."""

    condition: Condition
    reference: np.ndarray | None  # [h, w, 3] float32 sRGB in [0, 1]: a finished view (paint), another image of the room (furnish)
    prompt: str
    view: View
    seed: int
    task: Literal["paint", "furnish"] = "paint"  # draw the scaffold as it is | draw its empty room with furniture
    theme: str = ""  # what `prompt` was written from, for models that want a prompt of their own: the scene in words,
    room: str = ""  # the name of the room,
    sights: tuple[str, ...] = ()  # and the doors and windows in view, such as "a doorway on the left"


@dataclasses.dataclass(frozen=True, eq=False)
class ImageResult:
    """The answer of an image model to a request."""

    rgb: np.ndarray  # [h, w, 3] floating sRGB in [0, 1], of the size of the view's camera (wm.synth.checked)
    drawn_depth: np.ndarray | None = None  # [h, w] the depth that an offline model drew; None from real models
    drawn_object: np.ndarray | None = None  # [h, w] int32, from offline models: index into drawn_labels, OUTSIDE for structure
    drawn_labels: tuple[str, ...] = ()
    record: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    """What made the image, as JSON values: model, model_version, response_id, finish_reason, usage (ServiceAnswer.record)."""


@dataclasses.dataclass(frozen=True, eq=False)
class Segment:
    """One instance in an image."""

    label: str  # what a person would call it
    mask: np.ndarray  # [h, w] bool
    score: float = 1.0  # 0..1, how sure the model is


@dataclasses.dataclass(frozen=True)
class Click:
    """A point of an image that a person says is on a thing, or is not."""

    x: float  # pixels from the left border of the image to the point; the middle of the first pixel is at 0.5
    y: float  # idem, from the upper border
    on: bool = True  # whether the thing is there


@dataclasses.dataclass(frozen=True, eq=False)
class LanguageResult:
    """The answer of a language model."""

    text: str
    record: Mapping[str, Any] = dataclasses.field(default_factory=dict)  # what wrote it, as in `ImageResult.record`


@dataclasses.dataclass(frozen=True, eq=False)
class Surroundings:
    """Where an image was made: what a segmentation or depth model may know beside its pixels."""

    theme: str
    room: str  # name of the room
    view: View  # its name is unique in the scene
    folder: pathlib.Path | None = None  # the run folder, where a person's clicks lie (wm.synth.lifting.clicks)


@dataclasses.dataclass(frozen=True, eq=False)
class Observation:
    """What one image shows of one instance."""

    camera: Camera
    rgb: np.ndarray  # [h, w, 3] float32 sRGB, the whole image
    depth: np.ndarray  # [h, w] float32 z-depth of the whole image, metres, 0 where unknown
    mask: np.ndarray  # [h, w] bool: the pixels of the instance


@dataclasses.dataclass(frozen=True, eq=False)
class Reconstruction:
    """One instance as a mesh of its own."""

    thing: SceneObject  # in the frame of the first observation's camera; its slots have the colours that the images show
    seen: np.ndarray  # [s] bool: slots whose colour an image shows; the others have the usual colour of their material
    usual: np.ndarray  # [s, 3] float32 sRGB: the slots' usual colours
    residual: float  # median distance between the observed points and the mesh, metres


@dataclasses.dataclass(frozen=True, kw_only=True)
class ModelSettings:
    """The settings of the models that an image-driven objects backend uses."""

    image: BackendSettings
    depth: BackendSettings
    segmentation: BackendSettings
    reconstruction: BackendSettings
    language: BackendSettings | None = None  # names what a segmentation model looks for
    services: Services | None = None  # what they ask through
    folder: pathlib.Path | None = None  # the run folder


@dataclasses.dataclass(frozen=True)
class HeardTheme:
    """What a backend made of a theme's words; words and phrases as they were written, in lower case."""

    used: tuple[str, ...]  # those that changed something
    idle: tuple[str, ...] = ()  # those that it knows, and that change nothing beside the others
    unknown: tuple[str, ...] = ()  # those that it does not know; words without meaning of their own are nowhere


@runtime_checkable
class HearingModule(Protocol):
    """A backend's module that can tell what its backends hear of a theme. Models that read the whole text offer no such thing."""

    def heard(self, theme: str) -> HeardTheme:
        """What is used of a theme, and what is not known."""
        ...


@runtime_checkable
class ImageBackend(Protocol):
    def generate(self, request: ImageRequest) -> ImageResult:
        """One image Phi(X, reference, theme; seed). Equal requests give equal images.

        Raises:
          RefusedError: the model gave no image; it counts as a failed attempt (wm.services.faults).
          ServiceError: it cannot be reached, or must not be asked any more.
        """
        ...


@runtime_checkable
class PrefetchingBackend(ImageBackend, Protocol):
    """An image backend that can start work on views before their conditions are known."""

    def prefetch(self, views: Sequence[View]) -> None:
        """Announces the views that will be requested next, in that order."""
        ...


@runtime_checkable
class WorldBackend(ImageBackend, Protocol):
    """An image backend that also knows the world that it paints, and so the ground truth of held-out views."""

    def truth(self, view: View) -> np.ndarray:
        """[h, w, 3] the true image of a view, as in `ImageResult.rgb`. Several threads may call this at the same time."""
        ...


@runtime_checkable
class ImaginingBackend(ImageBackend, Protocol):
    """An image backend that knows in advance which furniture its images for the task "furnish" will show."""

    def imagined(self) -> Sequence[SceneObject]:
        """The furniture of all rooms in world space. Bootstrap cameras of furnished rooms are placed clear of it."""
        ...


@runtime_checkable
class LanguageBackend(Protocol):
    def propose(self, theme: str, rooms: list[str], *, seed: int, violations: list[str], previous: str | None) -> LanguageResult:
        """A floor plan as JSON text. `previous` is the last proposal and `violations` are the rules that it broke.

        Raises:
          RefusedError: the model gave no plan, or a cut one; it counts as an iteration.
          ServiceError: it cannot be reached, or must not be asked any more.
        """
        ...


@runtime_checkable
class NamingBackend(LanguageBackend, Protocol):
    """A language backend that can also say what a segmentation model should look for."""

    def name_things(self, theme: str, room: str, rgb: np.ndarray | None, *, seed: int) -> list[str]:
        """What pieces of furniture stand in a room: short nouns, each once.

        Args:
          theme: the scene in words.
          room: the name of the room.
          rgb: [h, w, 3] sRGB in [0, 1], an image of the room for models that see; None for none.
          seed: of the answer.
        """
        ...


@runtime_checkable
class ObjectsBackend(Protocol):
    def furnish(self, context: SceneContext, room: int) -> list[SceneObject]:
        """The objects of one room in world space; `context.density` says how many."""
        ...


@runtime_checkable
class ImageDrivenBackend(ObjectsBackend, Protocol):
    """An objects backend that furnishes rooms from images of them."""

    def with_models(self, models: "ModelSettings") -> ObjectsBackend:
        """The same backend, which draws, segments and reconstructs by the models that these settings select."""
        ...


@runtime_checkable
class SegmentationBackend(Protocol):
    def segment(self, result: ImageResult, *, where: Surroundings, seed: int) -> list[Segment]:
        """The instances in an image, without structure (walls, doors, windows), each once."""
        ...


@runtime_checkable
class NamedSegmentation(SegmentationBackend, Protocol):
    """A segmentation backend that looks for things by their names, which a language model can propose."""

    def with_language(self, language: LanguageBackend) -> SegmentationBackend:
        """The same backend, which asks this one for names if it can name things (NamingBackend). The caller closes both."""
        ...


@runtime_checkable
class PreparedSegmentation(SegmentationBackend, Protocol):
    """A segmentation backend that is told of all images before it segments the first one."""

    def prepare(self, drawn: Sequence[tuple[ImageResult, Surroundings]]) -> None:
        """Raises InputError if it cannot segment all of these; the message says what a person has to do first."""
        ...


@runtime_checkable
class ClickedSegmentation(PreparedSegmentation, Protocol):
    """A segmentation backend that segments what a person has clicked at (wm.annotation)."""

    def mask_of(self, rgb: np.ndarray, clicks: Sequence[Click]) -> Segment:
        """The thing that these clicks mean in an image of [h, w, 3] uint8 sRGB, without a label. One click at least is on it."""
        ...


@runtime_checkable
class ReconstructionBackend(Protocol):
    def reconstruct(
        self, label: str, observations: Sequence[Observation], site: Site, room: int, *, seed: int
    ) -> Reconstruction | None:
        """One instance reconstructed from one or more observations; None if they show too little of it."""
        ...


@runtime_checkable
class DepthBackend(Protocol):
    def estimate(self, result: ImageResult, *, camera: Camera, seed: int) -> np.ndarray | None:
        """[h, w] floating-point depth of each pixel, of the size of the image; None if no estimate can be given.

        It is z-depth up to an unknown positive scale and an unknown shift: larger is farther, and zero and negative values are
        valid. It is not disparity: a model that predicts inverse depth must return the reciprocal, for which it must know the
        shift of its inverse depth. NaN marks a pixel without an estimate (infinities are read as NaN); verification counts such
        a pixel as one that disagrees.
        """
        ...


@runtime_checkable
class ServedBackend(Protocol):
    """A backend of any group that asks a model through the run's services: kept answers, budget, retries (wm.services)."""

    def with_services(self, services: Services) -> Any:
        """The same backend, which asks through these."""
        ...

    def quote(self) -> Quote:
        """What one request is expected to cost. A local model costs seconds."""
        ...


@runtime_checkable
class ConcurrentBackend(Protocol):
    """A backend of any group whose methods several threads may call at the same time. Others are asked one call at a time."""

    @property
    def at_once(self) -> int:
        """Number of calls that should be under way, at least 1."""
        ...


@runtime_checkable
class ClosableBackend(Protocol):
    """A backend of any group that holds resources which Python does not free by itself, such as processes or device memory."""

    def close(self) -> None:
        """Frees the resources. Whoever made the backend closes it, also after an error; closing it twice is allowed."""
        ...
