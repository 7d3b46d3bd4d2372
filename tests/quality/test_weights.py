"""Files of weights: what is read, and what is refused with one clear line. Needs the extra `quality`."""

import os
import subprocess
import sys

import numpy as np
import pytest

from tests.models.hub import COMMIT, hub
from tests.models.loopback import Loopback
from tests.quality import tiny
from wm.errors import InputError
from wm.quality import check_quality, open_quality
from wm.quality.weights import FILES

numpy_files = pytest.importorskip("safetensors.numpy", reason="extra `quality`")
pytest.importorskip("huggingface_hub", reason="extra `quality`")


@pytest.fixture(scope="module")
def arrays():
    return dict(zip(FILES, (tiny.rn50(), tiny.prompts(), tiny.vit_l14(), tiny.head())))


def saved(folder, arrays):
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in arrays.items():
        numpy_files.save_file({key: np.array(array) for key, array in content.items()}, folder / name)
    return folder


def test_each_pair_of_files_gives_its_score(tmp_path, arrays):
    both = open_quality(str(saved(tmp_path / "both", arrays)))
    scores = both.score(tiny.picture())
    assert set(scores) == {"clip_iqa", "aesthetic"} and 0 < scores["clip_iqa"] < 1
    for pair, key in ((FILES[:2], "clip_iqa"), (FILES[2:], "aesthetic")):
        alone = open_quality(str(saved(tmp_path / key, {name: arrays[name] for name in pair})))
        assert alone.score(tiny.picture()) == {key: scores[key]}
        assert alone.identity == {key: both.identity[key]}


def test_half_precision_is_read_as_what_it_says(tmp_path, arrays):
    halves = {name: {key: np.array(array, np.float16) for key, array in content.items()} for name, content in arrays.items()}
    wholes = {name: {key: array.astype(np.float32) for key, array in content.items()} for name, content in halves.items()}
    found, wanted = (open_quality(str(saved(tmp_path / str(k), x))).score(tiny.picture()) for k, x in enumerate((halves, wholes)))
    assert found == wanted


def test_the_text_encoder_is_no_part_of_the_aesthetic_score(tmp_path, arrays):
    images = {key: array for key, array in arrays[FILES[2]].items() if key.startswith("visual.")}
    folder = saved(tmp_path, {FILES[2]: images, FILES[3]: arrays[FILES[3]]})
    assert set(open_quality(str(folder)).score(tiny.picture())) == {"aesthetic"}


@pytest.mark.parametrize("source", ["", "/no/such/folder", "lab/weights", "lab/weights@main", "a/b/c"])
def test_what_is_neither_a_folder_nor_a_commit_is_refused_before_anything_is_made(source):
    for check in (check_quality, open_quality):
        with pytest.raises(InputError, match=r"quality=.*is no folder here; .* OWNER/NAME@COMMIT"):
            check(source)


def test_a_folder_without_a_pair_is_refused(tmp_path, arrays):
    saved(tmp_path, {name: arrays[name] for name in (FILES[0], FILES[3])})
    with pytest.raises(InputError, match=r"no weights are in it; clip_rn50\.safetensors and clip_iqa_prompts\.safetensors, or"):
        check_quality(str(tmp_path))


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        (FILES[0], {"logit_scale": None}, r"clip_rn50\.safetensors has no logit_scale; .*OpenAI's CLIP"),
        (FILES[0], {"visual.attnpool.c_proj.weight": None}, r"has no visual\.attnpool\.c_proj\.weight"),
        (FILES[1], {"ctx": np.zeros((2, 16, 63), np.float32)}, r"ctx is 2 x 16 x 63; 2 x 16 x 64, the width of clip_rn50"),
        (FILES[1], {"ctx": None, "other": np.zeros(3, np.float32)}, r"clip_iqa_prompts\.safetensors has no ctx"),
        (FILES[2], {"visual.proj": None}, r"clip_vit_l14\.safetensors has no visual\.proj"),
        (FILES[3], {"layers.0.weight": np.zeros((16, 31), np.float32)}, r"no predictor for the 32 channels of clip_vit_l14"),
    ],
)
def test_a_file_with_something_else_is_said(tmp_path, arrays, name, change, message):
    changed = arrays[name] | change
    arrays = arrays | {name: {key: array for key, array in changed.items() if array is not None}}
    with pytest.raises(InputError, match=message):
        open_quality(str(saved(tmp_path, arrays))).score(tiny.picture())


def test_a_truncated_file_is_said(tmp_path, arrays):
    file = saved(tmp_path, arrays) / FILES[1]
    file.write_bytes(file.read_bytes()[:-40])
    with pytest.raises(InputError, match=r"clip_iqa_prompts\.safetensors cannot be read as safetensors"):
        open_quality(str(tmp_path)).score(tiny.picture())


def test_a_repository_at_a_commit_gives_what_its_folder_gives(tmp_path, arrays):
    folder = saved(tmp_path / "folder", {name: arrays[name] for name in FILES[2:]})
    (folder / "unrelated.bin").write_bytes(b"0")
    code = (
        "from tests.quality import tiny; from wm.quality import open_quality; import sys;"
        "print(*(open_quality(x).score(tiny.picture())['aesthetic'] for x in sys.argv[1:]))"
    )
    with Loopback(hub({"lab/weights": folder})) as server:
        environment = os.environ | {"HF_ENDPOINT": server.url, "HF_HUB_DISABLE_XET": "1", "HF_HOME": str(tmp_path / "home")}
        command = [sys.executable, "-c", code, str(folder), f"lab/weights@{COMMIT}"]
        told = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.split()
    assert told[0] == told[1]
    assert not list((tmp_path / "home").rglob("unrelated.bin"))
