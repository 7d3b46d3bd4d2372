"""Views are painted bootstraps first, then by similarity; references were painted before; ties fall the same way always."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wm.synth.order import paint_order, similarity


def turned(degrees):
    half = np.radians(degrees) / 2
    return np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=-1)


def random_quats(seed, count):
    return np.random.default_rng(seed).normal(size=(count, 4)) * np.array([[3.0]])


@given(st.integers(0, 2**32 - 1))
def test_similarity_is_symmetric_and_knows_no_sign_or_length(seed):
    a, b = random_quats(seed, 3), random_quats(seed + 1, 2)
    s = similarity(a, b)
    assert ((s >= 0) & (s <= 1)).all()
    np.testing.assert_allclose(s, similarity(b, a).T)
    np.testing.assert_allclose(s, similarity(-2 * a, b))
    np.testing.assert_allclose(np.diag(similarity(a, a)), 1)


def test_similarity_of_turns():
    found = similarity(turned(np.zeros(1)), turned(np.array([60.0, 180.0, 300.0])))[0]
    np.testing.assert_allclose(found, [np.sqrt(0.75), 0, np.sqrt(0.75)], atol=1e-12)


@given(st.integers(0, 2**32 - 1), st.integers(0, 9), st.integers(0, 5))
def test_laws_of_the_order(seed, count, before):
    quats, done = random_quats(seed, count), random_quats(seed + 1, before)
    every = np.concatenate([done, quats])
    steps = paint_order(quats, done)
    assert sorted(step.view for step in steps) == list(range(count))
    assert [step.view for step in steps[:2]] == list(range(min(count, 2)))
    painted = list(range(before))
    for k, step in enumerate(steps):
        if not painted:
            assert step.reference is None
        else:
            near = similarity(quats, every[painted])
            assert step.reference in painted
            np.testing.assert_allclose(near[step.view, painted.index(step.reference)], near[step.view].max())
            if k >= 2:
                waiting = sorted({s.view for s in steps[k:]})
                assert near[step.view].max() >= near[waiting].max() - 1e-8
        painted.append(before + step.view)


def test_the_spiral_goes_outward():
    steps = paint_order(turned(np.array([0.0, 180.0, 60.0, 20.0, 40.0])), np.zeros((0, 4)))
    assert [step.view for step in steps] == [0, 1, 3, 4, 2]
    assert [step.reference for step in steps] == [None, 0, 0, 3, 4]


def test_earlier_rooms_lend_their_style():
    steps = paint_order(turned(np.array([0.0, 180.0])), turned(np.array([175.0, 10.0])))
    assert [step.reference for step in steps] == [1, 0]


def test_ties_fall_to_the_first():
    same = turned(np.zeros(5))
    steps = paint_order(same, same[:2])
    assert [step.view for step in steps] == [0, 1, 2, 3, 4]
    assert {step.reference for step in steps} == {0}


def test_a_room_may_lack_bootstraps():
    steps = paint_order(turned(np.array([90.0, 10.0])), turned(np.array([0.0])), bootstraps=0)
    assert [step.view for step in steps] == [1, 0]
