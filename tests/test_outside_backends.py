"""A lab's own models, from outside the checkout: a module on the path, a YAML in the folder that --config-dir names."""

import json
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import wm
from tests.test_pipeline import SMALL
from wm.run import load_config
from wm.validate import ConfigError

IMAGE = '''
"""An image model of a lab: the condition in a tint, and noise of the seed."""
import dataclasses
import numpy as np
from wm.bounds import number
from wm.schema import BackendSettings
from wm.synth.backends import ImageResult

VERSION = "1"

@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    backend: str = "lab_image"
    tint: float = number(0.5, 0, 1, "Share of the tint.")

class LabImage:
    def __init__(self, settings):
        self.settings = settings

    def generate(self, request):
        noise = np.random.default_rng(request.seed).random(request.condition.rgb.shape, np.float32)
        rgb = (1 - self.settings.tint) * request.condition.rgb + self.settings.tint * (0.5 + 0.2 * noise)
        return ImageResult(rgb=rgb.astype(np.float32))

def make(settings, context):
    return LabImage(settings)
'''
LANGUAGE = '''
"""A language model of a lab: one rectangle after the other along the x axis, wrong at first if so asked."""
import dataclasses
import json
from wm.bounds import number
from wm.schema import BackendSettings
from wm.synth.backends import LanguageResult

VERSION = "2026-11"

@dataclasses.dataclass(kw_only=True, unsafe_hash=True)
class Settings(BackendSettings):
    backend: str = "lab_language"
    width: float = number(4.0, 2, 20, "Width of a room.", unit="m")

class LabLanguage:
    def __init__(self, settings):
        self.width = settings.width

    def propose(self, theme, rooms, *, seed, violations, previous):
        if previous is None:
            return LanguageResult("Certainly, here is a plan")
        w = self.width
        corners = lambda k: [[k * w, 0], [k * w + w, 0], [k * w + w, 4], [k * w, 4]]
        door = lambda k: {"type": "door", "wall_segment": [[k * w, 0], [k * w, 4]], "position": 1.5, "width": 0.9, "height": 2.1,
                          "sill_height": 0}
        plan = [{"id": f"room_{k}", "name": name, "floor_polygon": corners(k), "ceiling_height": 2.8,
                 "openings": [door(k)] if k else []} for k, name in enumerate(rooms)]
        return LanguageResult(json.dumps({"metadata": {"units": "meters"}, "rooms": plan, "objects": []}))

def make(settings, context):
    return LabLanguage(settings)
'''
YAML = {"image/lab.yaml": "backend: lab_image\ntint: 0.25\n", "language/lab.yaml": "backend: lab_language\n"}
CHOSEN = ("image=lab", "language=lab", "verify.enabled=false")


@pytest.fixture
def lab(tmp_path, monkeypatch):
    """The lab's folder: modules in it, YAML files in its conf."""
    for name, text in {"lab_image.py": IMAGE, "lab_language.py": LANGUAGE}.items():
        (tmp_path / name).write_text(text)
    for name, text in YAML.items():
        (tmp_path / "conf" / name).parent.mkdir(parents=True)
        (tmp_path / "conf" / name).write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("lab_image", "lab_language"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    return tmp_path


def test_a_run_with_models_of_a_lab(lab):
    small = [argument for argument in SMALL if not argument.startswith("image.")]
    command = [sys.executable, "-m", "wm.run", "--config-dir", str(lab / "conf"), *small, *CHOSEN, "scene.rooms=[bedroom,study]"]
    env = os.environ | {"PYTHONPATH": f"{lab}{os.pathsep}{Path(wm.__file__).parents[1]}"}
    options = ("language.width=5", "report.enabled=false", f"output={lab / 'run'}")
    done = subprocess.run([*command, *options], cwd=lab, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    plan = json.loads((lab / "run/plan.json").read_text())
    assert [room["name"] for room in plan["rooms"]] == ["bedroom", "study"]
    assert plan["rooms"][0]["floor_polygon"][1] == [5.0, 0.0]
    assert json.loads((lab / "run/layout.json").read_text()) | {"seconds": 0} == {
        "source": "lab_language", "iterations": 2, "seconds": 0,
    }  # fmt: skip
    recorded = json.loads((lab / "run/manifest.json").read_text())["header"]["config"]
    assert recorded["image"] == {"backend": "lab_image", "tint": 0.25}
    assert json.loads((lab / "run/metrics.json").read_text())["psnr"] is None  # it knows no world to compare with


def test_keys_of_a_lab_are_checked_like_all_others(lab):
    def said(*arguments):
        with pytest.raises(ConfigError) as caught:
            load_config(["+scene=gothic", *CHOSEN, *arguments], config_dir=lab / "conf")
        assert "\n" not in str(caught.value)
        return str(caught.value)

    config = load_config(["+scene=gothic", *CHOSEN, "image.tint=0.75"], config_dir=lab / "conf")
    assert config.image.tint == 0.75 and config.language.width == 4.0
    assert "image.tint=2.0: must be a number from 0 to 1" in said("image.tint=2")
    assert "image.tint: " in said("image.tint=much")
    assert "image.hue: no such key; image has backend, tint" in said("image.hue=1")
    assert "image.hue: no such key" in said("+image.hue=1")
    assert "did you mean image.tint?" in said("image.tin=1")
    assert "image=NAME is changed" in said("image.backend=lab_language").replace("GROUP", "image")


@pytest.mark.parametrize(
    ("module", "yaml", "said"),
    [
        (None, "backend: lab_none\n", "image/bad.yaml: backend 'lab_none' cannot be imported: ModuleNotFoundError"),
        ("import wm\n", "backend: lab_bad\n", "module 'lab_bad' is no backend: it has no make, Settings, VERSION"),
        ("1 / 0\n", "backend: lab_bad\n", "backend 'lab_bad' cannot be imported: ZeroDivisionError"),
        (IMAGE, "backend: lab_bad\n", "lab_bad.Settings must be a dataclass that extends wm.schema.BackendSettings, with"),
        (IMAGE.replace("lab_image", "lab_bad"), "backend: lab_bad\nhue: 1\n", "image/bad.yaml: Key 'hue' not in"),
    ],
)
def test_what_is_wrong_with_a_backend_is_named_with_its_file(lab, monkeypatch, module, yaml, said):
    monkeypatch.delitem(sys.modules, "lab_bad", raising=False)
    if module is not None:
        (lab / "lab_bad.py").write_text(textwrap.dedent(module))
    (lab / "conf/image/bad.yaml").write_text(yaml)
    with pytest.raises(ConfigError) as caught:
        load_config(["+scene=gothic", "image=bad"], config_dir=lab / "conf")
    assert said in str(caught.value) and "\n" not in str(caught.value)
