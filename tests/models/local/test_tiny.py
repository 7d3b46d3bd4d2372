"""The tiny checkpoints: each loads whole through the real class, and is the same in every process."""

import pytest

torch = pytest.importorskip("torch")
transformers = pytest.importorskip("transformers")
diffusers = pytest.importorskip("diffusers")

from tests.models import tiny  # noqa: E402 - after what it needs

CLASSES = {
    "sam3": "Sam3Model",
    "sam3_tracker": "Sam3TrackerModel",
    "depth_pro": "DepthProForDepthEstimation",
    "depth_anything_metric": "DepthAnythingForDepthEstimation",
    "depth_anything_relative": "DepthAnythingForDepthEstimation",
}


@pytest.mark.parametrize("name", CLASSES)
def test_a_checkpoint_loads_whole(name):
    folder = tiny.checkpoint(name)
    assert folder is tiny.checkpoint(name)
    assert sum(file.stat().st_size for file in folder.rglob("*")) < 2**21
    kind = getattr(transformers, CLASSES[name])
    model, told = kind.from_pretrained(folder, local_files_only=True, output_loading_info=True)
    assert not any(told.values())
    built = tiny.BUILDERS[name]()[0].state_dict()
    assert all(torch.equal(tensor, built[key]) for key, tensor in model.state_dict().items())


def test_the_image_pipeline_loads_whole():
    folder = tiny.checkpoint("flux2_klein")
    pipe = diffusers.Flux2KleinPipeline.from_pretrained(folder, local_files_only=True)
    built = tiny.flux2_klein()
    for name in ("transformer", "vae", "text_encoder"):
        want = getattr(built, name).state_dict()
        assert all(torch.equal(tensor, want[key]) for key, tensor in getattr(pipe, name).state_dict().items())
