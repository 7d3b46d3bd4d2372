"""What a comparison has measured, kept beside its videos, each under a key of everything that it was made from.

videos/METHOD/TRAJECTORY.mp4     what `python -m wm.study` shows
cameras/METHOD/TRAJECTORY.json   its cameras, in nerfstudio's transforms.json
measured/METHOD/TRAJECTORY.json  key and figures
"""

import dataclasses
import json
import pathlib
import re
from typing import Any

from wm.artifacts.atomic import write_atomically
from wm.artifacts.digests import json_text
from wm.compare.errors import CompareError

_NAME = re.compile(r"[\w.+-]{1,60}")


@dataclasses.dataclass(frozen=True)
class Store:
    """The output folder of a comparison."""

    folder: pathlib.Path

    def video(self, method: str, trajectory: str) -> pathlib.Path:
        return self.folder / "videos" / method / f"{trajectory}.mp4"

    def cameras(self, method: str, trajectory: str) -> pathlib.Path:
        return self.folder / "cameras" / method / f"{trajectory}.json"

    def measured(self, method: str, trajectory: str) -> pathlib.Path:
        return self.folder / "measured" / method / f"{trajectory}.json"

    def known(self, method: str, trajectory: str, key: str) -> dict[str, Any] | None:
        """The figures stored under this key; None where they are not, or their video is gone."""
        try:
            told = json.loads(self.measured(method, trajectory).read_text("utf-8"))
        except (OSError, ValueError):
            return None
        fits = isinstance(told, dict) and told.get("key") == key and isinstance(told.get("figures"), dict)
        return told["figures"] if fits and self.video(method, trajectory).is_file() else None

    def keep(self, method: str, trajectory: str, key: str, figures: dict[str, Any]) -> None:
        """Stores figures, after the video and the cameras are there."""
        write_atomically(self.measured(method, trajectory), json_text({"key": key, "figures": figures}))


def check_method(name: str) -> str:
    """A method's name, which names its folders. Raises: CompareError."""
    if _NAME.fullmatch(name) is None or name.startswith("."):
        raise CompareError(f"{name!r} cannot name a method; letters, digits and _ . + - would be right")
    return name
