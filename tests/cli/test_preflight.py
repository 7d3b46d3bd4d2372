"""What the command line asks for is checked as a whole before anything is made."""

from pathlib import Path

import pytest
from hydra.core.global_hydra import GlobalHydra
from hydra.core.hydra_config import HydraConfig

from wm.cli.preflight import planned_runs
from wm.errors import InputError
from wm.geometry import PlanError
from wm.validate import ConfigError


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_run_its_folder_and_what_is_missing_of_it(here):
    (here / "outputs").mkdir()
    (run,) = planned_runs(["+scene=gothic", "seed=3"])
    assert run.config.seed == 3 and run.folder == here / "outputs/gothic/full/3"
    assert run.missing == (run.folder, run.folder.parent, run.folder.parents[1])
    assert [path.name for path in here.iterdir()] == ["outputs"] and list((here / "outputs").iterdir()) == []
    assert not GlobalHydra.instance().is_initialized() and HydraConfig.instance().cfg is None


def test_every_row_of_a_sweep_has_its_folder(here):
    runs = planned_runs(["-m", "+scene=gothic", "variant=full,depth_only", "output=runs/${variant}-${hydra:job.num}"])
    assert [run.folder for run in runs] == [here / "runs/full-0", here / "runs/depth_only-1"]
    assert [run.config.variant for run in runs] == ["full", "depth_only"]
    named = planned_runs(["+scene=gothic", "seed=0,1", "hydra.mode=MULTIRUN"])
    assert [run.folder.name for run in named] == ["0", "1"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["seed=0,-1"], r"row 2 of the sweep \(.scene=gothic seed=-1\): seed=-1: must be"),
        (["variant=full,nope"], "row 2 of the sweep .*: variant=nope: no such variant"),
        (["preset=draft,standard"], "row 2 of the sweep .*: an earlier run of this sweep has this folder"),
        (["plan.file=nowhere.json,elsewhere.json"], "row 1 of the sweep .*nowhere.json"),
        (["fit.steps=1,${nope}"], "row 2 of the sweep .*fit.steps: Interpolation key 'nope' not found"),
        (["output=runs/${nope}"], "nope"),
    ],
)
def test_a_sweep_that_cannot_work_is_refused_as_a_whole(here, arguments, said):
    with pytest.raises(InputError, match=said) as caught:
        planned_runs(["-m", "+scene=gothic", *arguments])
    assert "\n" not in str(caught.value) and list(here.iterdir()) == []


@pytest.mark.parametrize(
    "argument", ["scene.name=../../evil", "seed=-1", "fit.stepz=1", "hydra.run.dir=${nope}", "+scene=" + 300 * "a"]
)
def test_a_run_that_cannot_be_is_refused(here, argument):
    with pytest.raises(ConfigError):
        planned_runs(["+scene=gothic"] * ("+scene" not in argument) + [argument])
    assert list(here.iterdir()) == []


def test_a_plan_that_cannot_be_used_is_refused(here):
    Path("plan.json").write_text("{")
    with pytest.raises(PlanError):
        planned_runs(["+scene=gothic", "plan.file=plan.json"])


@pytest.mark.parametrize("flag", ["--help", "--hydra-help", "--cfg=job", "--info=config"])
def test_what_asks_for_no_run_plans_none(flag):
    assert planned_runs([flag]) == []
