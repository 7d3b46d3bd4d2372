"""Rooms painted side by side: the same bytes however many are under way, and wherever a run was stopped."""

import dataclasses
import functools
import gc
import threading
import time
import weakref

import numpy as np
import pytest

from tests.geometry.plans import l_shaped
from tests.geometry.things import box
from tests.synth.test_painting import SETTINGS, Archive, Estimator, Painter, assert_same, view
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.mesh.structure import build_structure
from wm.geometry.rays.raycast import build_ray_scene, cast
from wm.geometry.texture.accumulation import accumulate_in_place
from wm.geometry.texture.atlas import build_atlas, texel_charts
from wm.synth.attempt import as_float, attempt_seed
from wm.synth.order import scene_order
from wm.synth.painting import Scaffold, paint_scene
from wm.synth.prompts import ViewPrompt
from wm.types import SurfaceKind

VIEWS = (
    view("hall/bootstrap0", "bootstrap", 0, [0.5, 1.5, 1.5], [7.5, 1.5, 1.2]),
    view("hall/bootstrap1", "bootstrap", 0, [7.5, 1.5, 1.5], [0.5, 1.5, 1.2]),
    view("hall/perimeter0", "perimeter", 0, [5.5, 0.4, 1.5], [5.5, 3.0, 1.1]),
    view("library/bootstrap0", "bootstrap", 1, [3.5, 5.0, 1.5], [8.0, 5.0, 1.2]),
    view("library/bootstrap1", "bootstrap", 1, [7.5, 5.0, 1.5], [3.0, 5.0, 1.2]),
    view("library/perimeter0", "perimeter", 1, [5.5, 6.0, 1.5], [5.5, 3.0, 1.1]),
    view("closet/bootstrap0", "bootstrap", 2, [0.4, 8.0, 1.5], [4.5, 8.0, 1.2]),
    view("closet/bootstrap1", "bootstrap", 2, [4.1, 8.0, 1.5], [0.0, 8.0, 1.2]),
    view("closet/perimeter0", "perimeter", 2, [2.0, 8.6, 1.5], [2.0, 7.0, 1.0]),
)


@functools.cache
def scaffold():
    things = (box([6, 0.5, 0], [6.8, 1.2, 1]), box([5, 4.2, 0], [5.8, 5, 1.4], room=1))
    return Scaffold(build_ray_scene(assemble_scene(build_structure(l_shaped()), things)), things)


class OneAtATime(Painter):
    """The painter of the painting loop's tests, in a house of three rooms. It counts how many requests are under way."""

    def __init__(self, **options):
        super().__init__(world=scaffold(), **options)
        self.lock, self.under_way, self.most, self.delays = threading.Lock(), 0, 0, None

    def generate(self, request):
        with self.lock:
            self.under_way += 1
            self.most = max(self.most, self.under_way)
            delay = self.delays.uniform(0, 0.02) if self.delays else 0.0
        try:
            time.sleep(delay)
            return super().generate(request)
        finally:
            with self.lock:
                self.under_way -= 1


class Several(OneAtATime):
    """It answers `at_once` requests at a time, each after a while. The first of `meeting` rooms wait for each other."""

    def __init__(self, at_once, seed=0, meeting=1, **options):
        super().__init__(**options)
        self.at_once, self.delays, self.meeting = at_once, np.random.default_rng(seed), threading.Barrier(meeting, timeout=60)

    def generate(self, request):
        if request.view.name in ("hall/perimeter0", "library/bootstrap0", "closet/bootstrap0")[: self.meeting.parties]:
            self.meeting.wait()
        return super().generate(request)


class Callbacks(Archive):
    """An archive that knows when it is used by two threads at the same time."""

    def __init__(self, stop_after=None):
        super().__init__(stop_after)
        self.busy, self.told = threading.Lock(), []

    def _alone(self, call, *arguments):
        assert self.busy.acquire(blocking=False), "two callbacks at the same time"
        try:
            return call(*arguments)
        finally:
            self.busy.release()

    def load(self, view):
        return self._alone(super().load, view)

    def store(self, view, painted, gbuffer):
        self._alone(super().store, view, painted, gbuffer)

    def prompt(self, view, has_reference):
        return ViewPrompt(self._alone("room {}{}".format, view.room, " again" * has_reference))

    def progress(self, view, painted):
        self._alone(self.told.append, view.name)


def paint(painter, archive=None, depth=None, settings=SETTINGS, views=VIEWS):
    archive = archive or Callbacks()
    summary = paint_scene(
        views, scaffold(), scaffold(), painter, depth or Estimator(), prompt=archive.prompt, seed=3, load=archive.load,
        store=archive.store, settings=settings, progress=archive.progress,
    )  # fmt: skip
    return summary, archive.kept


@functools.cache
def one_by_one():
    return paint(OneAtATime())


@pytest.mark.parametrize(("at_once", "meeting"), [(1, 1), (2, 2), (8, 3)])
def test_the_bytes_do_not_depend_on_how_many_rooms_are_under_way(at_once, meeting):
    painter, archive = Several(at_once, meeting=meeting), Callbacks()
    assert_same(paint(painter, archive), one_by_one())  # a barrier lets nobody pass before all are under way
    assert painter.most <= at_once
    assert sorted(archive.told) == sorted(one.name for one in VIEWS)
    assert archive.told[:2] == ["hall/bootstrap0", "hall/bootstrap1"]


def test_the_bytes_do_not_depend_on_it_where_images_fail():
    """Attempts are counted per view, and what is left of a failed view is used where it agrees."""
    limit = SETTINGS.verify.max_attempts
    wrong = (attempt_seed(3, 0, 0), *(attempt_seed(3, 5, attempt) for attempt in range(limit)))
    one, three = (paint(kind(wrong=wrong)) for kind in (OneAtATime, functools.partial(Several, 3)))
    assert_same(one, three)
    assert not one[1]["library/perimeter0"].accepted
    assert one[0].atm == pytest.approx(9 / 8)


@pytest.mark.parametrize("stop_after", range(len(VIEWS)))
def test_a_run_that_stopped_anywhere_goes_on_with_the_same_bytes(stop_after):
    archive = Callbacks(stop_after)
    with pytest.raises(KeyboardInterrupt):
        paint(Several(2, seed=stop_after), archive)
    assert len(archive.kept) == stop_after
    archive.stop_after = None
    painter = Several(8, seed=stop_after)
    assert_same(paint(painter, archive), one_by_one())
    assert len(painter.requests) == len(VIEWS) - stop_after


def test_with_one_at_a_time_room_follows_room():
    painter, archive = OneAtATime(), Callbacks()
    summary, _ = paint(painter, archive)
    assert painter.most == 1
    assert [request.view.room for request in painter.requests] == [0, 0, 0, 1, 1, 1, 2, 2, 2]
    assert tuple(archive.told) == summary.order == tuple(request.view.name for request in painter.requests)


def test_rooms_look_at_the_anchors_and_at_themselves():
    anchors = {"hall/bootstrap0", "hall/bootstrap1"}
    rooms = {one.name: one.room for one in VIEWS}
    _, kept = one_by_one()
    for name, painted in kept.items():
        assert name == "hall/bootstrap0" or painted.reference in anchors or rooms[painted.reference] == rooms[name]


def test_another_room_changes_nothing():
    """A scene without the closet has the same images of hall and library."""
    fewer = paint(OneAtATime(), views=VIEWS[:6])[1]
    for name, painted in fewer.items():
        whole = one_by_one()[1][name]
        np.testing.assert_array_equal(painted.rgb, whole.rgb)
        np.testing.assert_array_equal(painted.condition, whole.condition)


def test_the_atlas_is_that_of_one_view_after_the_other():
    summary, kept = one_by_one()
    atlas = build_atlas(scaffold().scene.mesh, SETTINGS.texture.texel_size)
    by_name, rooms = {one.name: one for one in VIEWS}, np.zeros((3, len(atlas.weight)), bool)
    for name in summary.order:
        one, before = by_name[name], atlas.weight.copy()
        gbuffer = cast(scaffold().scene, one.camera)
        rgb = as_float(kept[name].rgb)
        accumulate_in_place(atlas, gbuffer, one.camera, rgb, one.room, SETTINGS.texture, usable=kept[name].mask)
        rooms[one.room] |= atlas.weight > before
    shared = rooms.sum(axis=0) > 1
    assert shared.sum() > 20
    assert set(atlas.chart_kind[texel_charts(atlas)[shared]]) == {SurfaceKind.REVEAL}
    for name in ("color", "weight"):
        ours, theirs = getattr(summary.atlas, name), getattr(atlas, name)
        np.testing.assert_array_equal(ours[~shared], theirs[~shared])
        np.testing.assert_allclose(ours[shared], theirs[shared], rtol=1e-5)  # float32 running means in another order


@pytest.mark.parametrize("kind", [OneAtATime, functools.partial(Several, 2)])
def test_the_images_of_a_finished_room_are_not_held(kind):
    held, most = weakref.WeakValueDictionary(), []

    class Forgetful(Callbacks):
        def store(self, view, painted, gbuffer):
            held[view.name] = painted.rgb
            most.append({name.partition("/")[0] for name in held})

    archive = Forgetful()
    paint(kind(), archive)
    assert "hall" in most[-1]  # the anchors, which every room looks at
    assert len(most[-1]) <= 2
    assert len(most) == len(VIEWS)


def test_a_failure_ends_the_other_rooms_and_is_raised():
    class Broken(Several):
        def generate(self, request):
            if request.view.name == "library/perimeter0":
                raise RuntimeError("the library is closed")
            return super().generate(request)

    archive = Callbacks()
    slow = Broken(3)
    slow.delays = None
    with pytest.raises(RuntimeError, match="the library is closed"):
        paint(slow, archive)
    assert "library/perimeter0" not in archive.kept
    asked = len(slow.requests)
    assert slow.under_way == 0
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("wm-room")]
    assert_same(paint(Several(3), archive), one_by_one())
    assert asked <= len(VIEWS) - 1


def test_a_depth_model_is_asked_one_call_at_a_time_unless_it_answers_several():
    class Local(Estimator):
        busy = threading.Lock()

        def estimate(self, result, *, camera, seed):
            assert self.busy.acquire(blocking=False), "two estimates at the same time"
            try:
                time.sleep(0.005)
                return super().estimate(result, camera=camera, seed=seed)
            finally:
                self.busy.release()

    class Remote(Estimator):
        at_once, meeting = 8, threading.Barrier(2, timeout=60)

        def estimate(self, result, *, camera, seed):
            if camera is VIEWS[2].camera or camera is VIEWS[3].camera:  # of two rooms
                self.meeting.wait()
            return super().estimate(result, camera=camera, seed=seed)

    for depth in (Local(), Remote()):
        assert_same(paint(Several(8), depth=depth), one_by_one())


@pytest.mark.parametrize("kind", [OneAtATime, functools.partial(Several, 3)])
def test_a_backend_that_works_ahead_is_told_what_comes_in_the_order_asked(kind):
    painter = kind()
    announced = []
    painter.prefetch = lambda views: announced.append([one.name for one in views])
    paint(painter)
    order = [VIEWS[index].name for index in scene_order(VIEWS).views]
    assert len(announced) == len(VIEWS)
    for names in announced:
        start = order.index(names[0])
        assert names == order[start : start + len(names)]
    if painter.most == 1:
        assert announced == [order[k : k + 3] for k in range(len(VIEWS))]


def test_anchors_are_the_first_rooms_bootstraps():
    order = scene_order(VIEWS[::-1])
    assert [VIEWS[::-1][step.view].name for step in order.anchors.steps] == ["hall/bootstrap1", "hall/bootstrap0"]
    assert [part.room for part in order.rooms] == [0, 1, 2]
    assert sorted(order.views) == list(range(len(VIEWS)))
    plain = tuple(dataclasses.replace(one, kind="perimeter") for one in VIEWS)
    assert scene_order(plain).anchors.steps == ()
    assert sum(step.reference is None for part in scene_order(plain).rooms for step in part.steps) == 3
    with pytest.raises(ValueError, match="without views"):
        scene_order(())


def test_images_of_finished_rooms_are_let_go():
    """What stays in memory is bounded by the rooms under way, not by the scene."""
    alive = []

    class Watched(OneAtATime):
        def generate(self, request):
            gc.collect()
            alive.append(sum(image() is not None for image in archive.images))
            return super().generate(request)

    class Forgetful(Callbacks):
        def __init__(self):
            super().__init__()
            self.images = []

        def store(self, view, painted, gbuffer):
            self.images.append(weakref.ref(painted.rgb))

    archive = Forgetful()
    paint(Watched(), archive)
    assert alive[0] == 0
    assert max(alive) <= 2 + 2  # the anchors, and of the last room what was painted before its last view
    assert alive[6] == 2  # the closet's first view: of hall and library only the anchors are left
