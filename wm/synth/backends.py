"""What a backend must offer, and the registry that imports the one that was selected.

A backend is a function or a small class behind one of four protocols. Selecting `image=procedural` imports
`wm.synth.image.procedural` and calls its `make(config, context)`; nothing of the others is imported. Real models see only
what the paper's would (condition, reference, prompt, seed); the offline ones may also look at the scene they were made for.
"""

import dataclasses
import importlib
from collections.abc import Sequence
from typing import Any, Protocol, runtime_checkable

import numpy as np

from wm.types import Mesh, SceneObject, View


@dataclasses.dataclass(frozen=True, eq=False)
class SceneContext:
    """The scene a backend is made for."""

    theme: str
    seed: int
    plan: Any  # wm.geometry.FloorPlan
    structure: Mesh  # without objects
    objects: tuple[SceneObject, ...]


@dataclasses.dataclass(frozen=True, eq=False)
class Condition:
    """What the image model is shown of the scaffold from one camera: the X of the paper."""

    rgb: np.ndarray  # [h, w, 3] textured objects, alpha-blended accumulated texture, grayscale depth elsewhere
    known: np.ndarray  # [h, w] float32 in [0, 1]: how far rgb shows appearance and not depth
    depth: np.ndarray  # [h, w] float32 z-depth of the conditioning scaffold, metres, 0 where nothing is hit


@dataclasses.dataclass(frozen=True, eq=False)
class ImageRequest:
    condition: Condition
    reference: np.ndarray | None  # [h, w, 3] a finished view of the scene, for style; None for the first
    prompt: str
    view: View
    seed: int


@dataclasses.dataclass(frozen=True, eq=False)
class ImageResult:
    rgb: np.ndarray  # [h, w, 3] float32 sRGB in [0, 1]
    drawn_depth: np.ndarray | None = None  # [h, w] what an offline model knows it drew; real models have none


@runtime_checkable
class ImageBackend(Protocol):
    def generate(self, request: ImageRequest) -> ImageResult:
        """One image Phi(X, reference, theme; seed)."""
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
        """[h, w, 3] the image that the exact world would show."""
        ...


@runtime_checkable
class LanguageBackend(Protocol):
    def propose(self, theme: str, rooms: list[str], *, seed: int, violations: list[str], previous: str | None) -> str:
        """A floor plan as JSON text; `violations` and `previous` carry what was wrong with the last proposal."""
        ...


@runtime_checkable
class ObjectsBackend(Protocol):
    def furnish(self, context: SceneContext, room: int, *, density: float) -> list[SceneObject]:
        """The objects of one room, placed in world space."""
        ...


@runtime_checkable
class DepthBackend(Protocol):
    def estimate(self, result: ImageResult, *, seed: int) -> np.ndarray | None:
        """[h, w] depth up to scale and shift implied by an image, None where no estimate can be given."""
        ...


CHOICES: dict[str, tuple[str, ...]] = {
    "language": ("grammar",),
    "image": ("procedural",),
    "objects": ("procedural",),
    "depth": ("procedural",),
}


def make_backend(group: str, config: Any, context: SceneContext | None = None) -> Any:
    """The selected backend of a group ("language", "image", "objects", "depth").

    Args:
      group: one of CHOICES.
      config: the group's dataclass of wm.schema; its `name` selects the module.
      context: the scene; None for the language backend, which comes before it.

    Raises:
      ValueError: the name is not one of the group's choices.
    """
    if config.name not in CHOICES[group]:
        raise ValueError(f"unknown {group} backend {config.name!r}; choices: {', '.join(CHOICES[group])}")
    module = importlib.import_module(f"wm.synth.{group}.{config.name}")
    return module.make(config, context)
