"""The chain from drawing to placed furniture, with the offline models, on two small rooms."""

import dataclasses
import functools

import numpy as np
import pytest

from tests.synth.objects.scenes import bare
from wm.geometry.placement_laws import violations
from wm.geometry.site import room_site
from wm.geometry.upright_box import box_iou, box_of
from wm.schema import DepthConfig, ImageConfig, ObjectsConfig
from wm.synth.backends import ImageDrivenBackend, make_backend
from wm.synth.objects.lifted import sights

CONFIG = ObjectsConfig(name="lifted", image_width=240, image_height=180)
COARSE = ImageConfig(texel_size=0.08)


@functools.cache
def lifted(room=1):
    backend = make_backend("objects", CONFIG, bare()).with_models(COARSE, DepthConfig())
    return backend, backend.lift(bare(), room)


def test_most_of_what_was_drawn_is_found_near_where_it_was_drawn():
    backend, room = lifted()
    truth = [thing for thing in backend.imagined(bare(), 1.0).objects if thing.room == 1]
    large = [thing for thing in truth if box_of(thing).volume > 0.05 and thing.support == "floor"]
    near = [max((box_iou(box_of(t), box_of(o)) for o in room.objects if o.label == t.label), default=0.0) for t in large]
    assert len(large) >= 3 and np.mean(np.array(near) > 0.3) >= 0.6
    assert {thing.room for thing in room.objects} == {1}


def test_the_room_obeys_the_laws():
    _, room = lifted()
    assert violations(room.objects, room_site(bare().plan, 1)) == []


def test_nothing_is_copied_from_the_generator():
    backend, room = lifted()
    truth = {thing.vertices.tobytes() for thing in backend.imagined(bare(), 1.0).objects}
    assert not truth & {thing.vertices.tobytes() for thing in room.objects}


@pytest.mark.slow
def test_the_same_seed_gives_the_same_bytes():
    _, room = lifted()
    again = make_backend("objects", CONFIG, bare()).with_models(COARSE, DepthConfig()).furnish(bare(), 1, density=1.0)
    assert [thing.vertices.tobytes() for thing in again] == [thing.vertices.tobytes() for thing in room.objects]
    assert [thing.slot_colors.tobytes() for thing in again] == [thing.slot_colors.tobytes() for thing in room.objects]


def test_images_say_where_doors_are():
    _, room = lifted()
    said = [sights(drawing.camera, room_site(bare().plan, 1)) for drawing in room.drawings]
    assert any("doorway" in text for texts in said for text in texts)


def test_it_is_image_driven_and_refuses_a_density_that_is_no_share():
    backend = make_backend("objects", CONFIG, bare())
    assert isinstance(backend, ImageDrivenBackend)
    with pytest.raises(ValueError, match="density"):
        backend.furnish(dataclasses.replace(bare()), 0, density=1.5)
