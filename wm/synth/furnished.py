"""The scene of a configuration in memory, for whoever wants no run folder: plan, structure and furniture."""

import dataclasses

from wm.geometry import build_structure
from wm.schema import RunConfig
from wm.synth.backends import SceneContext, make_backend
from wm.synth.language.propose import propose_plan


def furnished_context(config: RunConfig) -> SceneContext:
    """The scene that a run of this configuration proposes and furnishes; `plan.file` is not read.

    Raises: ProposalError if the language backend finds no valid plan.
    """
    words = config.scene
    language = make_backend("language", config.language)
    iterations = config.plan.max_iterations
    plan = propose_plan(language, words.theme, list(words.rooms), seed=config.seed, max_iterations=iterations).plan
    context = SceneContext(theme=words.theme, seed=config.seed, plan=plan, structure=build_structure(plan), objects=())
    furnisher = make_backend("objects", config.objects, context)
    density = config.furnish.density
    objects = [thing for room in range(len(plan.rooms)) for thing in furnisher.furnish(context, room, density=density)]
    return dataclasses.replace(context, objects=tuple(objects))
