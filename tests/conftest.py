"""Settings for the whole suite: hypothesis draws the same examples every time, and no example is timed."""

from hypothesis import HealthCheck, settings

settings.register_profile("wm", derandomize=True, deadline=None, max_examples=25, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("wm")
