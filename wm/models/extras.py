"""Packages that only some backends need: extras of wm, imported when the first request is sent."""

import importlib.util

from wm.services.faults import MissingExtraError


def require_extra(extra: str, *packages: str) -> None:
    """Nothing if all of these packages are installed; they are not imported.

    Raises:
      MissingExtraError: one of them is not; the message names the extra of wm that installs it.
    """
    missing = [package for package in packages if importlib.util.find_spec(package) is None]
    if missing:
        verb = "is" if len(missing) == 1 else "are"
        raise MissingExtraError(f"{', '.join(missing)} {verb} not installed: pip install 'wm[{extra}]'")
