"""Furnishes the scene of a configuration, for the furnish stage and for callers without a run folder."""

import contextlib
import dataclasses
import pathlib
from collections.abc import Callable
from typing import Any

from wm.geometry import FloorPlan, build_structure, load_plan
from wm.geometry.exchange.plan_objects import plan_objects
from wm.schema import RunConfig
from wm.services.services import Services
from wm.synth.backends import ImageDrivenBackend, ObjectsBackend, SceneContext
from wm.synth.object_ids import with_ids
from wm.synth.proposing import propose_plan
from wm.synth.registry import backend_key, backend_module, close_backend, make_backend, model_settings
from wm.synth.seeds import PARTS, seed_of
from wm.types import SceneObject


@dataclasses.dataclass(frozen=True, eq=False)
class Furnisher:
    """The objects backend of a configuration."""

    backend: ObjectsBackend
    keys: tuple[Any, ...]  # for a stage's key: the backend, and the models that it uses, since they shape the furniture

    def furnish(self, context: SceneContext, *, done: Callable[[], object] = lambda: None) -> list[SceneObject]:
        """The objects that the plan lists, then those of all rooms, furnished around them.

        `done` is called after each room. The backend is closed at the end, also after an error.
        """
        with contextlib.ExitStack() as held:
            held.callback(close_backend, self.backend)
            objects = list(context.objects)
            for room in range(len(context.plan.rooms)):
                objects += self.backend.furnish(context, room)
                done()
            return objects


def make_furnisher(
    config: RunConfig, context: SceneContext, services: Services | None = None, folder: pathlib.Path | None = None
) -> Furnisher:
    """The Furnisher of the selected objects backend. An image-driven backend uses the selected models.

    Args:
      config, context: the configuration and its scene.
      services: what models ask through; None: kept nowhere and without limits.
      folder: the run folder, where drawings are kept and a person's clicks are read; None without one.
    """
    backend: ObjectsBackend = make_backend("objects", config.objects, context, services)
    own = backend_key(config.objects)
    if not isinstance(backend, ImageDrivenBackend):
        return Furnisher(backend, own)
    models = model_settings(config, services, folder)
    asked = [models.image, models.depth, models.segmentation, models.reconstruction]
    if "language" in getattr(backend_module(config.segmentation.backend), "USES", ()):
        asked.append(config.language)
    drawn = (config.finish, config.light)  # what an image shows of furniture depends on these
    keys = (part for settings in asked for part in backend_key(settings, folder))
    return Furnisher(backend.with_models(models), (*own, *drawn, *keys))


def bare_context(config: RunConfig, plan: FloorPlan) -> SceneContext:
    """The scene of a configuration before it is furnished; it holds what the plan lists itself."""
    return SceneContext(
        theme=config.scene.theme, seed=config.seed, plan=plan, structure=build_structure(plan), objects=plan_objects(plan),
        density=config.furnish.density, seeds=tuple((part, seed_of(config, part)) for part in PARTS),
    )  # fmt: skip


def furnished_context(config: RunConfig) -> SceneContext:
    """The furnished scene of this configuration, computed in memory: plan, structure and furniture.

    Raises:
      ProposalError: the language backend finds no valid plan.
      PlanError: `plan.file` does not hold a valid plan.
    """
    plan = _plan(config)
    bare = bare_context(config, plan)
    objects = make_furnisher(config, bare).furnish(bare) if config.furnish.enabled else bare.objects
    return dataclasses.replace(bare, objects=with_ids(objects, [room.id for room in plan.rooms]))


def _plan(config: RunConfig) -> FloorPlan:
    if config.plan.file is not None:
        return load_plan(
            pathlib.Path(config.plan.file),
            repair=config.plan.repair,
            unreachable=config.plan.unreachable,
            storey=config.plan.storey,
        )
    language = make_backend("language", config.language)
    seed, iterations = seed_of(config, "plan"), config.plan.max_iterations
    return propose_plan(language, config.scene.theme, list(config.scene.rooms), seed=seed, max_iterations=iterations).plan
