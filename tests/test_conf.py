"""Every choice of conf/ composes, and each changes what it says and nothing else."""

import dataclasses
import functools

import pytest

from tests.synth.recording import recorded, with_recording
from wm.offline.image.violations import KINDS
from wm.run import load_config, options
from wm.schema import RunConfig, VerifySettings
from wm.synth.registry import GROUPS, backend_module, mismatches, unasked
from wm.validate import ConfigError, validate_config

SCENES = {"gothic": 6, "scandinavian": 4, "beach_house": None, "roman_estate": None, "clockwork_garden": None}
VARIANTS = {
    "full": {},
    "depth_objects": {"condition.wall_texture": False},
    "depth_walls_bboxes": {"condition.objects": "boxes"},
    "depth_only": {"condition.wall_texture": False, "condition.objects": "none"},
    "no_edge_recall": {"verify.enabled": False},
    "no_pcd_init": {"fit.init": "random"},
    "no_depth_loss": {"fit.depth_weight": 0.0, "fit.normal_weight": 0.0},
    "no_init_no_depth": {"fit.init": "random", "fit.depth_weight": 0.0, "fit.normal_weight": 0.0},
}
CHOICES = {
    "language": {
        "grammar",
        *("claude", "claude_opus", "claude_sonnet", "claude_haiku"),
        *("openai_compatible", "vllm", "llama_cpp", "ollama", "qwen_coder", "gpt_oss"),
    },
    "image": {
        *("procedural", "like_closed", "like_distilled"),
        *("nano_banana", "nano_banana_pro", "openai_images", "flux2_klein", "flux2_klein_4b", "flux2_klein_9b"),
    },
    "objects": {"procedural", "lifted"},
    "depth": {"procedural", "depth_pro", "depth_anything_2", "depth_anything_3"},
    "segmentation": {"drawn", "sam3_text", "sam3_clicks"},
    "reconstruction": {"templates", "sam3d_objects", "image_to_3d"},
}
FLAWS = ("drift", "exposure", "phase", "softness", *KINDS)
PRESETS = {"draft": (344, 192), "standard": (688, 384), "paper": (1376, 768)}


def leaves(config) -> dict:
    found = {}
    for field in dataclasses.fields(config):
        value = getattr(config, field.name)
        if dataclasses.is_dataclass(value):
            found |= {f"{field.name}.{key}": inner for key, inner in leaves(value).items()}
        else:
            found[field.name] = value
    return found


def test_the_groups_offer_what_they_should():
    assert set(options("scene")) == set(SCENES)
    assert set(options("variant")) == set(VARIANTS)
    assert set(options("preset")) == set(PRESETS)
    assert {group: set(options(group)) for group in GROUPS} == CHOICES


@pytest.mark.parametrize("group", GROUPS)
def test_every_choice_of_a_group_selects_a_backend_with_its_own_settings(group):
    for name in CHOICES[group]:
        settings = getattr(load_config(["+scene=gothic", "verify.enabled=false", f"{group}={name}"]), group)
        assert type(settings) is backend_module(settings.backend).Settings


@pytest.mark.parametrize("profile", ["like_closed", "like_distilled"])
def test_a_profile_of_an_image_model_changes_flaws_and_nothing_else(profile):
    plain, flawed = (leaves(load_config(["+scene=gothic", f"image={name}"])) for name in ("procedural", profile))
    changed = {key for key, value in flawed.items() if value != plain[key]}
    assert changed == {f"image.{flaw}" for flaw in FLAWS}
    assert all(flawed[key] > plain[key] for key in changed)
    assert sum(flawed[f"image.{kind}"] for kind in KINDS) < 1


@pytest.mark.parametrize("depth", sorted(CHOICES["depth"]))
def test_only_real_depth_models_change_how_images_are_verified_and_the_user_has_the_last_word(depth):
    def verification(*arguments):
        return leaves(load_config(["+scene=gothic", f"depth={depth}", "image=nano_banana_pro", *arguments]).verify)

    off = ["verify.enabled=false"] if depth == "procedural" else []
    plain, chosen = leaves(VerifySettings()), verification(*off)
    changed = {key for key, value in chosen.items() if value != plain[key]}
    assert changed == ({"enabled"} if depth == "procedural" else {"field", "max_disagreement", "min_recall"})
    assert verification(*off, "verify.field=1", "verify.min_recall=0.5") == chosen | {"field": 1, "min_recall": 0.5}
    assert verification("variant=no_edge_recall") == chosen | {"enabled": False}


@functools.cache
def plain_config(scene: str) -> RunConfig:
    return load_config([f"+scene={scene}"])


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("variant", VARIANTS)
def test_a_variant_changes_exactly_what_its_row_says(scene, variant):
    plain = leaves(plain_config(scene))
    varied = leaves(load_config([f"+scene={scene}", f"variant={variant}"]))
    changed = {key: value for key, value in varied.items() if value != plain[key]}
    assert changed == VARIANTS[variant] | ({} if variant == "full" else {"variant": variant})


@pytest.mark.parametrize("preset", PRESETS)
def test_presets_set_the_image_size(preset):
    config = load_config(["+scene=gothic", f"preset={preset}"])
    assert (config.cameras.width, config.cameras.height) == PRESETS[preset]
    assert config.preset == preset
    assert config.scene == plain_config("gothic").scene


@pytest.mark.parametrize("scene", SCENES)
def test_scenes_have_the_rooms_they_should(scene):
    config = plain_config(scene)
    assert config.scene.name == scene
    assert len(config.scene.rooms) == SCENES[scene] or (SCENES[scene] is None and 4 <= len(config.scene.rooms) <= 8)


def test_the_standard_preset_is_the_schema():
    config = load_config(["+scene=gothic"])
    backends = {group: dataclasses.replace(getattr(config, group)) for group in GROUPS}
    assert all(settings == type(settings)() for settings in backends.values())
    assert leaves(config) == leaves(RunConfig(**backends, prices=config.prices)) | {
        "scene.name": "gothic",
        "scene.theme": config.scene.theme,
        "scene.rooms": config.scene.rooms,
    }


def test_a_scene_of_ones_own():
    config = load_config(["scene.name=den", "scene.theme='a snug cabin'", "scene.rooms=[hall,kitchen]"])
    assert config.scene.rooms == ["hall", "kitchen"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "no scene: type wm NAME or add .scene=NAME, one of beach_house, clockwork_garden, .*; or say what it should be"),
        (["scene=gothic"], "write .scene=NAME, one of beach_house, .*gothic"),
        (["+scene=gotik"], "scene=gotik: no such scene; did you mean gothic. choose one of beach_house, .*scandinavian"),
        (["preset=fast"], "preset=fast: no such preset; choose one of draft, paper, standard"),
        (["variant=none"], "variant=none: no such variant; choose one of depth_objects, .*no_pcd_init"),
        (["image=gan"], "image=gan: no such image; choose one of .*like_closed, .*procedural"),
        (["image.backend=gan"], "image: backend 'gan' cannot be imported: ModuleNotFoundError"),
        (["depth.backend=wm.types"], "depth: module 'wm.types' is no backend: it has no make, Settings, VERSION"),
        (["language.backend=wm.offline.image.painter"], "language: settings of wm.offline.language.grammar do not suit"),
        (["segmentation=sam"], "segmentation=sam: no such segmentation; choose one of drawn, sam3_clicks, sam3_text"),
        (["objects.segmentation=drawn"], "objects.segmentation: no such key; objects has backend"),
        (["image.drifft=1"], "image.drifft: no such key; did you mean image.drift. image has backend, drift"),
        (["+image.drifft=1"], "image.drifft: no such key; did you mean image.drift"),
        (["image.drift=2"], "image.drift=2.0: must be a number from 0 to 1"),
        (["fit.stepz=3"], "fit.stepz: no such key; did you mean fit.steps. fit has init, .*steps"),
        (["+fit.stepz=3"], "fit.stepz: no such key"),
        (["++colour.depth=3"], "colour: no such key; .*the configuration has scene, plan"),
        (["sed=3"], "sed: no such key; did you mean seed"),
        (["fit.steps=many"], "fit.steps: .*many.*"),
        (["fit=3"], "fit: "),
        (["fit.init=cubes"], "fit.init='cubes': choose one of flat, isotropic, random"),
        (["condition.objects=some"], "condition.objects='some': choose one of textured, boxes, none"),
        (["seed=-1", "cameras.fov=400"], "cameras.fov=400.0: must be a number from 5 to 150; seed=-1: must be a number from 0"),
        (["fit.spacing=nan"], "fit.spacing=nan: must be a number from 0.001 to 1"),
        (["texture.min_facing=1"], "texture.min_facing=1.0: must be a number from 0 to below 1"),
        (["fit.lr_sh=inf"], "fit.lr_sh=inf: must be a number from 0 to 1000"),
        (["workers=0"], "workers=0: must be a number from 1 to 1000, or null for one room per core"),
        (["executor=fork"], "executor='fork': choose one of threads"),
        (["verify.low=0.5"], "verify.low=0.5: must not exceed verify.high=0.3"),
        (["scene.name=../../up"], "scene.name='../../up': names a folder"),
        (["scene.rooms=[]"], "scene.rooms=.*name at least one room"),
        (["scene.rooms=[hall,' ']"], "scene.rooms has ' '"),
        (["scene.theme=' '"], "scene.theme.*say in words"),
        (["seed=["], "cannot read the argument 'seed=\\['.* a text is quoted, within what the shell quotes: seed='\\['"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_in_one_line_with_what_would_be_right(arguments, said):
    scene = [] if not arguments or "scene=" in arguments[0] else ["+scene=gothic"]
    with pytest.raises(ConfigError, match=said) as caught:
        load_config([*scene, *arguments])
    assert "\n" not in str(caught.value)


def test_offline_models_that_go_by_what_was_drawn_are_refused_beside_an_image_model_that_tells_nothing(monkeypatch):
    recorded(monkeypatch, "image", "depth", draws=False)

    def faults(*arguments, groups=("image",)):
        return "; ".join(mismatches(with_recording(load_config(["+scene=gothic", *arguments]), *groups)))

    assert "depth backend 'wm.offline.depth.estimator' needs what image backend 'recording_image' does not tell" in faults()
    assert "wm --help depth lists them" in faults() and faults().endswith("verify.enabled=false paints without one")
    assert faults("verify.enabled=false") == faults(groups=("image", "depth")) == ""
    both = faults("objects=lifted", "verify.enabled=false")
    assert "depth backend" in both and "segmentation backend 'wm.offline.segmentation.drawn'" in both
    one = faults("objects=lifted", groups=("image", "depth"))
    assert "depth backend" not in one and "choose another segmentation=NAME (wm --help segmentation lists them), or an" in one
    assert faults("objects=lifted", "furnish.enabled=false", groups=("image", "depth")) == ""


def test_models_that_are_chosen_and_never_asked_are_named():
    assert unasked(load_config(["gothic"])) == unasked(load_config(["gothic", "depth=depth_anything_2"])) == []
    (line,) = unasked(load_config(["gothic", "segmentation=sam3_text"]))
    assert "segmentation" in line and "objects=lifted" in line
    assert unasked(load_config(["gothic", "segmentation=sam3_text", "objects=lifted"])) == []
    assert len(unasked(load_config(["gothic", "depth=depth_anything_2", "verify.enabled=false"]))) == 1


def test_all_faults_are_named_at_once():
    config = load_config(["+scene=gothic"])
    config.seed = -1
    config.fit.init = "cubes"
    with pytest.raises(ConfigError, match=r"fit\.init='cubes'.*seed=-1"):
        validate_config(config)


def test_endless_and_broken_values_are_quoted_in_one_short_line():
    for value in ("a" * 5000, "\n", "'" + "b" * 5000):
        with pytest.raises(ConfigError) as caught:
            load_config(["gothic", f"fit.steps={value}"])
        assert "\n" not in str(caught.value) and len(str(caught.value)) < 1000
