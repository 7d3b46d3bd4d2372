"""Weights are loaded whole or not at all, and from this machine without asking anyone."""

import json
import os
import shutil
import subprocess
import sys
import textwrap

import pytest

torch = pytest.importorskip("torch")
transformers = pytest.importorskip("transformers")
diffusers = pytest.importorskip("diffusers")

from tests.models import tiny  # noqa: E402 - after what it needs
from tests.models.hub import COMMIT, hub  # noqa: E402
from tests.models.loopback import Loopback  # noqa: E402
from wm.models.weights import find_weights, load_whole  # noqa: E402
from wm.services.faults import ServiceError  # noqa: E402

DEPTH = transformers.DepthAnythingForDepthEstimation


@pytest.fixture
def copied(tmp_path):
    """A copy of a checkpoint that a test may damage."""

    def copy(name):
        return shutil.copytree(tiny.checkpoint(name), tmp_path / name)

    return copy


def loaded(folder, kind=DEPTH, **options):
    return load_whole(kind, find_weights(str(folder), "depth"), **options)


def without(folder, part, file):
    """The folder, whose weights lack those that begin with `part`."""
    from safetensors.torch import load_file, save_file

    kept = {name: tensor for name, tensor in load_file(folder / file).items() if not name.startswith(part)}
    save_file(kept, folder / file, metadata={"format": "pt"})
    return folder


def test_all_weights_are_those_of_the_file_in_the_type_that_is_asked_for():
    model = loaded(tiny.checkpoint("depth_anything_metric"), dtype=torch.bfloat16)
    assert not model.training
    built = tiny.depth_anything().state_dict()
    assert all(torch.equal(weight, built[name].to(torch.bfloat16)) for name, weight in model.state_dict().items())


def test_a_file_that_lacks_weights_is_refused(copied):
    folder = without(copied("depth_anything_metric"), "head.", "model.safetensors")
    with pytest.raises(ServiceError, match=r"depth_anything_metric@\w{12}: 6 weights are missing, such as head.conv1.bias"):
        loaded(folder)


def test_a_part_of_a_pipeline_that_lacks_weights_is_refused(copied):
    folder = without(copied("flux2_klein"), "proj_out", "transformer/diffusion_pytorch_model.safetensors")
    with pytest.raises(ServiceError, match=r"1 weights are missing, such as proj_out.weight"):
        loaded(folder, diffusers.Flux2Transformer2DModel, subfolder="transformer")


def test_weights_of_another_model_are_refused(copied):
    folder = copied("depth_anything_metric")
    shutil.copy(tiny.checkpoint("depth_pro") / "model.safetensors", folder)
    with pytest.raises(ServiceError, match="weights are missing"):
        loaded(folder)


def test_weights_of_another_size_are_refused(copied):
    folder = copied("depth_anything_metric")
    config = json.loads((folder / "config.json").read_text())
    (folder / "config.json").write_text(json.dumps(config | {"head_hidden_size": 4}))
    with pytest.raises(ServiceError, match=r"depth_anything_metric@\w{12} cannot be loaded as DepthAnything|weights are missing"):
        loaded(folder)


@pytest.mark.parametrize("damage", ["cut", "pickle", "none", "config"])
def test_files_that_cannot_be_read_are_one_line(copied, damage):
    folder = copied("depth_anything_metric")
    weights = folder / "model.safetensors"
    if damage == "cut":
        weights.write_bytes(weights.read_bytes()[:-1000])
    elif damage == "config":
        (folder / "config.json").write_text("{")
    else:
        weights.unlink()
    if damage == "pickle":
        torch.save({}, folder / "pytorch_model.bin")
    with pytest.raises(
        ServiceError, match=r"^depth_anything_metric@\w{12} cannot be loaded as DepthAnythingForDepthEstimation: "
    ) as e:
        loaded(folder)
    assert "\n" not in str(e.value)


TWICE = """
    import sys, json
    from tests.models import tiny
    from wm.models.weights import find_weights, load_whole
    import transformers

    def load(model):
        weights = find_weights(model, "depth")
        load_whole(transformers.DepthAnythingForDepthEstimation, weights)
        return weights.name

    print(json.dumps([load(model) for model in sys.argv[1:]]))
"""


@pytest.mark.slow
def test_the_hub_is_asked_once_and_never_for_what_is_on_this_machine(tmp_path):
    def names(url, *models):
        env = os.environ | {"HF_ENDPOINT": url, "HF_HUB_DISABLE_XET": "1", "HF_HOME": str(tmp_path)}
        command = [sys.executable, "-c", textwrap.dedent(TWICE), *models]
        done = subprocess.run(command, env=env, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    with Loopback(hub({"lab/depth": tiny.checkpoint("depth_anything_metric")})) as server:
        assert names(server.url, "lab/depth") == [f"lab/depth@{COMMIT}"]
        assert server.asked
        server.asked.clear()
        assert (
            names(server.url, "lab/depth", f"lab/depth@{COMMIT}", str(tiny.checkpoint("depth_anything_metric")))[:2]
            == [f"lab/depth@{COMMIT}"] * 2
        )
        assert server.asked == []


@pytest.mark.slow
def test_a_hub_that_is_gone_is_one_line(tmp_path):
    with Loopback(hub({})) as server:
        pass
    for model, said in (
        ("lab/depth", "lab/depth is not on this machine, and the hub"),
        (f"lab/depth@{COMMIT}", "cannot be loaded"),
    ):
        env = os.environ | {"HF_ENDPOINT": server.url, "HF_HUB_DISABLE_XET": "1", "HF_HOME": str(tmp_path)}
        done = subprocess.run(
            [sys.executable, "-c", textwrap.dedent(TWICE), model], env=env, capture_output=True, text=True, check=False
        )
        assert done.returncode == 1
        assert f"ServiceError: {said}" in done.stderr or ("ServiceError" in done.stderr and said in done.stderr)
