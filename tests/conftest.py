"""Settings for the whole suite, and the run it shares: hypothesis draws the same examples every time, and no example is timed."""

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile("wm", derandomize=True, deadline=None, max_examples=25, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("wm")


@pytest.fixture(scope="session")
def finished(tmp_path_factory):
    """One small finished run of two rooms (`wm.finished.FinishedRun`), for tests that only read it."""
    from tests.fitted_run import shared_run  # the pipeline, which most files of tests do without
    from wm.finished import open_finished

    return open_finished(shared_run(tmp_path_factory))
