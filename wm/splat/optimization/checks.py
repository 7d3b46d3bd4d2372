"""What is wrong with the settings of a fit, said before it begins."""

from wm.bounds import check_settings
from wm.schema import FitSettings


def check_fit(settings: FitSettings) -> None:
    """Raises ValueError naming the setting of a fit that is outside its bounds, or the choice that is unknown."""
    check_settings("fit", settings)
