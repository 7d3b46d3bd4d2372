"""A view painted from end to end by models on this machine: condition, image, depth, verification, further attempts."""

import numpy as np
import pytest

pytest.importorskip("torch")
pytest.importorskip("transformers")
pytest.importorskip("diffusers")

from tests.models import tiny
from tests.models.image.requests import image_request
from tests.models.image.shift import texture
from wm.models.depth import depth_anything_2, depth_pro
from wm.models.image import flux2_klein
from wm.schema import VerifySettings
from wm.services.services import ONLY, Services
from wm.services.store import AnswerStore
from wm.synth.attempt import attempt_seed, paint_view
from wm.types import GBuffer

WIDTH, HEIGHT = 128, 80
PROMPT = (
    "{#\nPainting.\n\n    theme      x\n    room       x\n    sights     x\n    objects    x\n    reference  x\n#}\nA {{ room }}."
)


def seen(depth):
    """The G-buffer of a flat wall in front of the camera, with a box of another depth."""
    plane = np.zeros((HEIGHT, WIDTH))
    normal = np.broadcast_to(np.array([0, 0, -1], np.float32), (HEIGHT, WIDTH, 3))
    return GBuffer(
        depth=depth.astype(np.float32), normal=normal, face=plane.astype(np.int32),
        barycentric=np.zeros((HEIGHT, WIDTH, 2), np.float32), hit=plane == 0,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("module", "checkpoint"), [(depth_pro, "depth_pro"), (depth_anything_2, "depth_anything_metric")], ids=["pro", "anything"]
)
def test_a_view_is_painted_verified_and_painted_again_the_same(tmp_path, module, checkpoint):
    (tmp_path / "prompts").mkdir()
    (tmp_path / "prompts" / "paint.md").write_text(PROMPT)
    shown = seen(np.where(np.add.outer(np.arange(HEIGHT) // 30, np.arange(WIDTH) // 50) % 2, 2.0, 4.0))
    request = image_request(texture(WIDTH, HEIGHT), reference=texture(WIDTH, HEIGHT, seed=1))

    def painted(replay):
        services = Services(store=AnswerStore(tmp_path / "answers"), replay=replay)
        model = str(tiny.checkpoint("flux2_klein"))
        chosen = {"dtype": "float32", "steps": 2, "least_megapixels": 0.0, "prompts": str(tmp_path / "prompts")}
        image = flux2_klein.make(flux2_klein.Settings(model=model, device="cpu", **chosen), None).with_services(services)
        depth = module.make(module.Settings(model=str(tiny.checkpoint(checkpoint)), device="cpu"), None).with_services(services)
        try:
            return paint_view(request, shown, image, depth, VerifySettings(max_attempts=2), (0, 3), "hall/bootstrap0"), services
        finally:
            image.close()
            depth.close()

    view, services = painted("auto")
    assert view.rgb.shape == (HEIGHT, WIDTH, 3) and np.ptp(view.rgb) > 25
    assert not view.accepted and view.attempts == 2  # random weights keep no structure
    assert view.made_by["seed"] in {attempt_seed(0, 3, k) for k in range(2)}
    assert view.made_by["model"].startswith("flux2_klein@") and view.made_by["prompt"] == "A kitchen."
    assert [row["backend"] for row in services.ledger.rows] == [flux2_klein.__name__, module.__name__] * 2
    assert services.ledger.spent().requests == 0  # nothing is paid
    again, _ = painted(ONLY)
    assert np.array_equal(again.rgb, view.rgb) and np.array_equal(again.mask, view.mask) and again.recall == view.recall
