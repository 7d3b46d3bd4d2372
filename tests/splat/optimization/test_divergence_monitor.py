"""Laws of the divergence monitor: views are held against themselves, and the best state is the one of the best pass."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from wm.splat.optimization.divergence_monitor import PATIENCE, WORSE, diverges, monitor_step, monitor_visit, start_monitor
from wm.types import Gaussians


def state(step):
    """Stands for the gaussians after a step."""
    return Gaussians(means=step, quats=None, log_scales=None, opacity_logits=None, sh=None)


def monitored(losses, start=None):
    """The monitor after rounds of losses [steps, views], each a step of all its views; and where it first saw divergence."""
    start = np.asarray(losses[0] if start is None else start, float)
    monitor, alarm = start_monitor(state(0), 0, len(start), 1), None
    for step, row in enumerate(losses, 1):
        for view, loss in enumerate(row):
            monitor = monitor_visit(monitor, view, np.array([loss]), lambda view=view: start[[view]])
        alarm = step if alarm is None and diverges(monitor) else alarm
        monitor = monitor_step(monitor, step, lambda step=step: state(step))
    return monitor, alarm


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(0.02, 5.0), min_size=1, max_size=9), st.floats(0.9, 1.0), st.integers(0, 2**31))
def test_a_fit_that_gets_better_is_left_alone_however_its_views_differ(first, fall, seed):
    noise = np.random.default_rng(seed).uniform(1.0, 1.6, (30, len(first)))
    losses = np.array(first) * fall ** np.arange(30)[:, None] * noise
    monitor, alarm = monitored(losses)
    assert alarm is None and not diverges(monitor, ended=True)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(0.02, 1.0), min_size=1, max_size=9), st.floats(1.1 * WORSE, 1e6), st.integers(1, 5))
def test_a_blow_up_is_noticed_within_its_patience_and_the_state_before_it_is_kept(first, factor, good):
    before = [np.array(first) * 0.95**k for k in range(1, good + 1)]
    losses = [*before, *[factor * max(first) * np.ones(len(first))] * PATIENCE]
    monitor, alarm = monitored(losses, start=first)
    assert alarm is not None and (alarm - good - 1) * len(first) < PATIENCE
    assert monitor.best_step == monitor.best.means == good - 1  # what follows the last good pass never showed itself
    assert monitor.bad_terms.sum() > WORSE * monitor.known[monitor.bad_view].sum()


def test_a_blow_up_within_the_first_pass_is_measured_against_the_start():
    asked = []
    monitor = start_monitor(state(0), 0, 9, 1)
    for view, loss in enumerate([0.2, *[9.0] * 8]):
        monitor = monitor_visit(monitor, view, np.array([loss]), lambda view=view: asked.append(view) or np.array([0.25]))
    assert diverges(monitor) and asked == list(range(1, 9))


def test_a_hard_view_is_measured_once_and_believed():
    asked = []
    monitor = start_monitor(state(0), 0, 2, 1)
    for view, loss in [(0, 0.1), (1, 4.0), (0, 0.1), (1, 4.0)]:
        monitor = monitor_visit(monitor, view, np.array([loss]), lambda: asked.append(1) or np.array([4.0]))
    assert asked == [1] and not monitor.recent.any()


def test_a_short_fit_is_judged_when_it_ends_and_next_to_no_loss_is_not_judged():
    monitor, _ = monitored([[0.2], [0.9]])
    assert not diverges(monitor) and diverges(monitor, ended=True)
    monitor, _ = monitored([[1e-5], [1e-3], [2e-2]])
    assert not diverges(monitor, ended=True)
