"""Observations: which segments of two images show the same instance, whatever their labels are."""

import numpy as np
import pytest

from tests.synth.lifting.scenes import observations, piece, site
from wm.geometry.placement.upright_box import UprightBox, box_of
from wm.synth.backends import Segment
from wm.synth.lifting.observations import Instance, gather, in_room, joined, observation_points

LABELS = pytest.mark.parametrize("label", ["armchair", "red armchair", "zebra", "座椅", ""])
"""Known, described, never heard of, in letters that no word is made of, and none at all."""


@LABELS
def test_two_images_of_one_thing_are_one_instance_and_of_two_things_two(label):
    things = [piece("armchair", 2.2, 1.0, 0.4, (0.85, 0.84, 0.95)), piece("armchair", 2.8, 3.2, 2.0, (0.85, 0.84, 0.95))]
    views = [[], []]
    for k in range(2):
        for n, observation in enumerate(observations(things, k)):
            views[n].append((Segment(label, observation.mask), observation))
    found = gather(views)
    assert len(found) == 2 and all(len(instance.observations) == 2 for instance in found)
    for instance, truth in zip(found, things):
        points = np.concatenate([observation_points(s, limit=100, seed=0) for s in instance.observations])
        assert np.linalg.norm(np.median(points[:, :2], axis=0) - box_of(truth).center) < 0.4


@LABELS
def test_reconstructions_that_share_space_are_joined(label):
    thing = piece("armchair", 2.2, 1.0, 0.4, (0.85, 0.84, 0.95))
    seen = observations([thing], 0)
    pairs = [Instance(label, (observation,)) for observation in seen]
    together = joined(pairs, [box_of(thing), box_of(thing)])
    assert len(together) == 1 and together[0][1] == (0, 1) and len(together[0][0].observations) == 2
    assert len(joined(pairs, [box_of(thing), None])) == 2
    assert len(joined([pairs[0], Instance("vase", pairs[1].observations)], [box_of(thing), box_of(thing)])) == 2


@pytest.mark.parametrize(("label", "count"), [("chandelier", 1), ("pendant lamp", 1), ("armchair", 2), ("zebra", 2)])
def test_of_what_hangs_from_the_ceiling_little_shared_space_in_one_image_is_enough(label, count):
    """Masks of one image that share a fifth of their boxes: arms of one chandelier, but two armchairs side by side."""
    (seen,) = observations([piece("armchair", 2.2, 1.0, 0.4, (0.85, 0.84, 0.95))], 0, 1)
    boxes = [UprightBox(x, 1.0, 0.0, 0.0, 0.5, 0.5, 0.5) for x in (2.0, 2.4)]
    assert len(joined([Instance(label, (seen,)), Instance(label, (seen,))], boxes)) == count


def test_what_lies_beyond_a_door_is_not_in_the_room():
    inside, beyond = (observations([piece("chest", x, 3.1, 0.0, (0.9, 0.5, 0.5))], 0, 1) for x in (3.0, 6.2))
    assert in_room(inside[0], site().polygon)
    assert beyond and beyond[0].mask.sum() > 20  # it is seen
    assert not in_room(beyond[0], site().polygon)
