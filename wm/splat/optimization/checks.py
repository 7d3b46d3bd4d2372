"""Checks of the settings of a fit, made before it begins."""

from wm.bounds import check_settings
from wm.schema import FitSettings


def check_fit(settings: FitSettings) -> None:
    """Raises ValueError, naming the setting, if a setting of a fit is outside its bounds or is not one of its options."""
    check_settings("fit", settings)
