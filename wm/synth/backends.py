"""What a backend must offer: one protocol a group, and the records that go in and come out.

Real models see only what the paper's would (condition, reference, prompt, seed); the offline ones may also look at the scene they
were made for. What a backend returns is checked where it comes in (wm.synth.checked); how one is selected, and how a model of
one's own is plugged in, says wm.synth.registry.
"""

import dataclasses
from collections.abc import Sequence
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np

from wm.geometry.plan.site import Site
from wm.schema import BackendSettings
from wm.types import Camera, Mesh, SceneObject, View


@dataclasses.dataclass(frozen=True, eq=False)
class SceneContext:
    """The scene a backend is made for."""

    theme: str
    seed: int
    plan: Any  # wm.geometry.FloorPlan
    structure: Mesh  # without objects
    objects: tuple[SceneObject, ...]  # none while the scene is being furnished
    density: float = 1.0  # 0..1: share of the optional pieces of furniture that are wanted (furnish.density)
    seeds: tuple[tuple[str, int], ...] = ()  # parts of the scene (furnish, finish, light) that draw from a seed of their own

    def seed_of(self, part: str) -> int:
        """The seed that a part of the scene draws from."""
        return dict(self.seeds).get(part, self.seed)


@dataclasses.dataclass(frozen=True, eq=False)
class Condition:
    """What the image model is shown of the scaffold from one camera: the X of the paper."""

    rgb: np.ndarray  # [h, w, 3] float32 sRGB in [0, 1]: textured objects, blended accumulated texture, grayscale depth elsewhere
    known: np.ndarray  # [h, w] float32 in [0, 1]: how far rgb shows appearance and not depth
    depth: np.ndarray  # [h, w] float32 z-depth of the conditioning scaffold, metres, 0 where nothing is hit
    objects: str = "textured"  # how the scaffold shows objects: textured | boxes | none; so that a box is not taken for a crate
    object: np.ndarray | None = None  # [h, w] bool: where the scaffold has an object, boxes included; None for nowhere
    wall_texture: bool = True  # whether the scaffold shows texture where views have left some: what one view decides, others see


@dataclasses.dataclass(frozen=True, eq=False)
class ImageRequest:
    """What an image model is asked for one view."""

    condition: Condition
    reference: np.ndarray | None  # [h, w, 3] float32 sRGB in [0, 1], for style a finished view; to furnish, the room furnished
    prompt: str
    view: View
    seed: int
    task: Literal["paint", "furnish"] = "paint"  # the view as the scaffold has it | the empty room that it has, furnished


@dataclasses.dataclass(frozen=True, eq=False)
class ImageResult:
    """What an image model made of it."""

    rgb: np.ndarray  # [h, w, 3] floating sRGB in [0, 1], of the size of the view's camera (wm.synth.checked)
    drawn_depth: np.ndarray | None = None  # [h, w] what an offline model knows it drew; real models have none
    drawn_object: np.ndarray | None = None  # [h, w] int32 likewise: index into drawn_labels, OUTSIDE for structure
    drawn_labels: tuple[str, ...] = ()


@dataclasses.dataclass(frozen=True, eq=False)
class Segment:
    """One instance in an image."""

    label: str  # what a person would call it
    mask: np.ndarray  # [h, w] bool


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

    thing: SceneObject  # in the frame of the first observation's camera; its slots in the colours that the images show
    seen: np.ndarray  # [s] bool: slots whose colour an image shows; the others have their usual one
    usual: np.ndarray  # [s, 3] float32 sRGB: the slots' usual colours
    residual: float  # metres between the points seen and the mesh, median


@dataclasses.dataclass(frozen=True, kw_only=True)
class ModelSettings:
    """The settings of the models that an image-driven objects backend asks."""

    image: BackendSettings
    depth: BackendSettings
    segmentation: BackendSettings
    reconstruction: BackendSettings


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
        """One image Phi(X, reference, theme; seed); the same request gives the same image."""
        ...


@runtime_checkable
class PrefetchingBackend(ImageBackend, Protocol):
    """An image backend that can begin on views before their conditions are known."""

    def prefetch(self, views: Sequence[View]) -> None:
        """The views that come next, soonest first."""
        ...


@runtime_checkable
class WorldBackend(ImageBackend, Protocol):
    """An image backend that also knows the world it paints: the ground truth of held-out views."""

    def truth(self, view: View) -> np.ndarray:
        """[h, w, 3] the image that the exact world would show, as `ImageResult.rgb`. Several threads call it at once."""
        ...


@runtime_checkable
class ImaginingBackend(ImageBackend, Protocol):
    """An image backend that can tell beforehand which furniture its answers to the task "furnish" will show."""

    def imagined(self) -> Sequence[SceneObject]:
        """The furniture of all rooms in world space. Cameras that are to see a room furnished are kept clear of it."""
        ...


@runtime_checkable
class LanguageBackend(Protocol):
    def propose(self, theme: str, rooms: list[str], *, seed: int, violations: list[str], previous: str | None) -> str:
        """A floor plan as JSON text; `violations` and `previous` carry what was wrong with the last proposal."""
        ...


@runtime_checkable
class ObjectsBackend(Protocol):
    def furnish(self, context: SceneContext, room: int) -> list[SceneObject]:
        """The objects of one room, placed in world space, as densely as the context wants them."""
        ...


@runtime_checkable
class ImageDrivenBackend(ObjectsBackend, Protocol):
    """An objects backend that furnishes rooms from images of them."""

    def with_models(self, models: "ModelSettings") -> ObjectsBackend:
        """The same backend, its images drawn, segmented and turned into meshes by the backends that these select."""
        ...


@runtime_checkable
class SegmentationBackend(Protocol):
    def segment(self, result: ImageResult, *, seed: int) -> list[Segment]:
        """The instances in an image; none of them is structure (walls, doors, windows)."""
        ...


@runtime_checkable
class ReconstructionBackend(Protocol):
    def reconstruct(
        self, label: str, observations: Sequence[Observation], site: Site, room: int, *, seed: int
    ) -> Reconstruction | None:
        """One instance from one or more observations of it; None where they show too little."""
        ...


@runtime_checkable
class DepthBackend(Protocol):
    def estimate(self, result: ImageResult, *, seed: int) -> np.ndarray | None:
        """[h, w] floating, of the image's size: how far away each pixel is; None where no estimate can be given.

        It is z-depth up to a positive scale and a shift, neither of which is known: larger is farther, and zero and negative
        values are as good as others. So it is not disparity: a model that gives inverse depth gives its reciprocal here, which
        takes one that knows the shift of its inverse depth. NaN, and nothing else, says that a pixel has no estimate (infinities
        are taken for it); verification counts such a pixel as one that disagrees.
        """
        ...


@runtime_checkable
class ClosableBackend(Protocol):
    """A backend of any group that holds more than Python frees by itself, such as processes or a device's memory."""

    def close(self) -> None:
        """Ends what it holds. Whoever made the backend closes it, also after an error; closing twice is closing once."""
        ...
