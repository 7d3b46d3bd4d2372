"""How far is a view shifted when an image model draws it at a size and shape of its own?

    pip install -e '.[test,gemini,openai]'
    python experiments/registration/run.py            writes result.csv beside itself and prints its worst rows

A server on this machine stands for the service. It draws what it is sent, in the size that it offers or in another, with another
library than the one that wm resamples with. Each row is one view through the whole backend: condition, canvas, PNG, HTTP, answer
and view. `shift` is the largest of 3 x 3 tiles, in pixels of the view, so that a wrong
scale is seen too.
"""

import csv
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
from scipy.ndimage import map_coordinates

sys.path.insert(0, str(Path(__file__).parents[2]))  # the server and the measure live with the tests
from tests.models.image.drawing_servers import drawing, gemini_reply, openai_reply
from tests.models.image.requests import image_request
from tests.models.image.shift import shift, texture
from tests.models.loopback import Loopback
from wm.models.image import nano_banana_pro, openai_images
from wm.models.image.registration import ImageCanvas, cut_out

FIELDS = ("backend", "asked", "view", "answer", "shift")
PRESETS = [(344, 192), (688, 384), (1376, 768)]
ODD_VIEWS = [(641, 479), (333, 517), (1000, 300), (500, 500), (1920, 1080), (250, 401)]
ODD_ANSWERS = {"as asked": 1.0, "0.731 times": 0.731, "1.317 times": 1.317}


def cases() -> Iterator[tuple[ModuleType, str, tuple[int, int], str]]:
    """(backend, image_size, view, answer) of each row."""
    offered = nano_banana_pro.canvases("1K")
    for size in ("1K", "2K", "4K"):
        for canvas in offered:
            yield nano_banana_pro, size, (canvas.width // 2 + 3, canvas.height // 2 - 1), "as asked"
    for answer in ODD_ANSWERS:
        for canvas in offered:
            yield nano_banana_pro, "1K", (canvas.width // 3, canvas.height // 3), answer
        for view in (*PRESETS, *ODD_VIEWS):
            for backend in (nano_banana_pro, openai_images):
                yield backend, "1K", view, answer
    for size in ("2K", "4K"):
        yield openai_images, size, (688, 384), "as asked"


def measured(backend: ModuleType, image_size: str, view: tuple[int, int], answer: str) -> dict[str, object]:
    """One row."""
    own = {"1K": 1, "2K": 2, "4K": 4}[image_size] if backend is nano_banana_pro else 1
    factor, drawn = ODD_ANSWERS[answer], []

    def size(width: int, height: int) -> tuple[int, int]:
        times = factor * own if backend is nano_banana_pro else factor
        drawn.append((round(times * width), round(times * height)))
        return drawn[-1]

    shown = texture(*view)
    with Loopback(drawing(gemini_reply if backend is nano_banana_pro else openai_reply, size)) as server:
        address = server.url + "/v1" * (backend is openai_images)
        model = backend.make(backend.Settings(base_url=address, image_size=image_size, time_limit=600.0), None)
        result = model.generate(image_request(shown))
        model.close()
    told = result.record.get("shape", result.record["size"])
    row = (backend.__name__.rpartition(".")[2], f"{image_size} {told}", _text(view), _text(drawn[0]))
    return dict(zip(FIELDS, (*row, f"{shift(shown, np.round(result.rgb * 255)):.2f}")))


def control() -> dict[str, object]:
    """The row of a mistake: an image enlarged by pixel numbers, x / 4, in place of centres, (x + 1/2) / 4 - 1/2."""
    width, height = 344, 192
    shown = texture(width, height)
    places = np.mgrid[: 4 * height, : 4 * width] / 4
    wrong = np.stack([map_coordinates(shown[..., c].astype(float), places, order=1, mode="nearest") for c in range(3)], axis=-1)
    seen = shift(shown, cut_out(wrong.astype(np.uint8), ImageCanvas(4 * width, 4 * height), width, height))
    return dict(zip(FIELDS, ("a mistake", "", _text((width, height)), _text((4 * width, 4 * height)), f"{seen:.2f}")))


def _text(size: tuple[int, int]) -> str:
    return f"{size[0]}x{size[1]}"


def main() -> None:
    os.environ["GEMINI_API_KEY"] = os.environ["OPENAI_API_KEY"] = "none-is-needed"
    rows = []
    with (Path(__file__).parent / "result.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, FIELDS)
        writer.writeheader()
        for case in cases():
            rows.append(measured(*case))
            writer.writerow(rows[-1])
            file.flush()
        writer.writerow(control())
    for row in sorted(rows, key=lambda row: -float(str(row["shift"])))[:5]:
        print(row)


if __name__ == "__main__":
    main()
