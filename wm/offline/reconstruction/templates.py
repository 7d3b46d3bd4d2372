"""Reconstruction by templates: a parametric piece of the kind that the label names, fitted to observed points and coloured.

Its input is a label, masked RGB images with depth in metres, and the walls of the room. It uses no knowledge of the drawn thing
or of the image model, so that it also works with photographs and with other image models. If a depth model gives depth up to
scale and shift, `wm.synth.lifting.metric_depth` makes it metric with the help of the empty room.

    observation = Observation(camera=camera, rgb=image, depth=metric_depth(estimate, bare, seed=0), mask=mask)
    made = TemplateReconstruction(style_of("gothic castle")).reconstruct("oak armchair", [observation], site, room, seed=0)
"""

import dataclasses
from collections.abc import Sequence

import numpy as np
import shapely

from wm.bounds import setting
from wm.geometry.placement.upright import transformed
from wm.geometry.placement.upright_box import UprightBox
from wm.geometry.plan.site import Site
from wm.offline.furniture import KINDS
from wm.offline.reconstruction.coloring import slot_colors
from wm.offline.reconstruction.kinds import Template, kind_of, rebuilt, templates_of
from wm.offline.reconstruction.template_cost import evidence_of
from wm.offline.reconstruction.template_fit import fit_template
from wm.offline.reconstruction.texturing import textured
from wm.offline.style.finish import Style
from wm.offline.style.theme import style_of
from wm.schema import BackendSettings
from wm.synth.backends import Observation, Reconstruction, SceneContext
from wm.synth.lifting.observations import near_together, observation_points, trimmed
from wm.types import SceneObject

VERSION = "1"
_POINTS = 240
"""Size of the subsample of observed points to which a template is fitted."""
_OUTSIDE = 0.05
"""Metres by which the middle of a thing may lie outside the room."""
_SPLINTER = 0.5
"""A fit fails if its height is below this share of the smallest height of its kind."""
_LEAST = 12
"""Smallest number of observed points for a reconstruction."""


@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    """Reconstruction by templates has no settings of its own."""

    backend: str = setting(__name__, "The offline reconstruction.")


@dataclasses.dataclass(frozen=True)
class TemplateReconstruction:
    """The backend."""

    style: Style  # the style of the theme, in which templates are built

    def reconstruct(
        self, label: str, observations: Sequence[Observation], site: Site, room: int, *, seed: int
    ) -> Reconstruction | None:
        """One thing, in the frame of the first observation's camera; None if it has too few observed points or no template fits.

        Args:
          label: the name of the thing in any words. The last word that names a kind of furniture selects the kind; a label
            without such a word selects a box with a lid.
          observations: the observations of the thing; one is enough, two from opposite sides are better.
          site: the room in which the thing stands: its floor, ceiling and walls.
          room: index of the room, which is stored in the result.
          seed: seed of the subsample of points, and of details of the piece that no image shows.
        """
        kind = kind_of(label)
        share = _POINTS // len(observations)
        points = np.concatenate([trimmed(observation_points(s, limit=share, seed=seed)) for s in observations])
        points = near_together(points, np.array(KINDS[kind].high))
        if len(points) < _LEAST:
            return None
        templates = templates_of(kind, self.style)
        fits = [fit_template(evidence_of(template, points, observations, site)) for template in templates]
        template, fit = min(zip(templates, fits, strict=True), key=lambda pair: pair[1].cost)
        if not _plausible(fit.box, template, site):
            return None
        thing = built(label, template, fit.box, room, seed=seed)
        colors, seen = slot_colors(thing, observations)
        colored = textured(dataclasses.replace(thing, slot_colors=colors), observations, seen)
        return Reconstruction(
            thing=transformed(colored, np.asarray(observations[0].camera.T_cam_world)),
            seen=seen,
            usual=thing.slot_colors,
            residual=fit.residual,
        )


def make(settings: Settings, context: SceneContext) -> TemplateReconstruction:
    """The reconstruction by templates in the style of the scene's theme. It has no settings."""
    return TemplateReconstruction(style_of(context.theme))


def _plausible(box: UprightBox, template: Template, site: Site) -> bool:
    """Whether a fitted box stands in the room and is not much too low for its kind."""
    inside = bool(shapely.contains_xy(site.polygon.buffer(_OUTSIDE), box.x, box.y))
    flat = template.support == "flat"
    return inside and (flat or box.height > _SPLINTER * float(template.low[2]))


def built(label: str, template: Template, box: UprightBox, room: int, *, seed: int) -> SceneObject:
    """An object of the template's kind that fills a box."""
    size = np.array([box.width, box.depth, box.height])
    piece = rebuilt(template, size, np.random.default_rng(np.random.SeedSequence([seed, 0xB1])))
    T = box.transform
    filled = piece.vertices * (size / piece.size)
    return SceneObject(
        label=label, room=room, support=template.support, vertices=filled @ T[:3, :3].T + T[:3, 3], faces=piece.faces,
        face_slot=piece.face_slot, slots=piece.slots, slot_colors=piece.slot_colors, T_world_object=T, size=size,
        emission=piece.emission,
    )  # fmt: skip
