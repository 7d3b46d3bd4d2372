"""The command line: where a run goes, what is said when it cannot, and the exit code."""

import errno
import os
import subprocess
import sys
import types
from pathlib import Path

import pytest

from wm import run
from wm.errors import InputError
from wm.geometry import PlanError, Violation
from wm.services.faults import BudgetError

WRITES = """
    import json, pathlib
    config = {"variant": config.variant, "seed": config.seed, "scene": {"name": config.scene.name}}
    pathlib.Path(folder, "manifest.json").write_text(json.dumps({"header": {"config": config}}))
    pathlib.Path(folder, "metrics.json").write_text(json.dumps({"psnr": 20.0 + len(config["variant"])}))
"""
FAKE = """
import signal, sys, types
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs, and what they start, ignore it otherwise
def pipeline(config, folder, neighbours):
    print(config.scene.name, config.variant, folder)
    {action}
sys.modules["wm.pipeline"] = types.SimpleNamespace(run=pipeline)
from wm.run import main
main()
"""


def command(
    *arguments: str, cwd: Path, action: str | None = None, timeout: float | None = None
) -> subprocess.CompletedProcess:
    """`python -m wm.run`, or the same door before a pipeline that only prints and then does `action`."""
    start = ["-m", "wm.run"] if action is None else ["-c", FAKE.format(action=action)]
    env = os.environ | {"PYTHONPATH": str(Path(run.__file__).parents[1])}
    return subprocess.run(
        [sys.executable, *start, *arguments], capture_output=True, text=True, cwd=cwd, env=env, check=False, timeout=timeout
    )


@pytest.fixture
def door(monkeypatch, tmp_path, capsys):
    """Calls `main` in this process with a pipeline that does `action`; gives exit code, stderr and the calls."""

    def call(*arguments: str, action=lambda config, folder: None):
        calls = []

        def pipeline(config, folder, neighbours):
            calls.append((config, folder, neighbours))
            action(config, folder)

        monkeypatch.chdir(tmp_path)
        monkeypatch.setenv("HYDRA_FULL_ERROR", "1")
        for place in ("hydra.core.utils", "hydra._internal.hydra"):  # logging's dictConfig would close pytest's own handlers
            monkeypatch.setattr(f"{place}.configure_log", lambda *_: None)
        monkeypatch.setattr(run, "_leave", sys.exit)  # or pytest would leave too
        monkeypatch.setattr(sys, "argv", ["wm", *arguments])
        monkeypatch.setitem(sys.modules, "wm.pipeline", types.SimpleNamespace(run=pipeline))
        code = 0
        try:
            run.main()
        except SystemExit as exit_:
            code = exit_.code
        return code, capsys.readouterr().err, calls

    return call


def raising(error: BaseException):
    def action(config, folder):
        raise error

    return action


def test_the_run_folder_is_scene_variant_seed(door, tmp_path):
    code, said, calls = door("+scene=gothic", "variant=depth_only", "seed=3")
    assert (code, said) == (0, "")
    config, folder, _ = calls[0]
    assert folder == tmp_path / "outputs/gothic/depth_only/3"
    assert config.seed == 3 and config.verify.enabled and not config.condition.wall_texture
    assert list(folder.iterdir()) == []  # nothing of Hydra's
    assert Path.cwd() == tmp_path


def test_output_names_another_folder_and_no_other_is_made(door, tmp_path):
    _, _, calls = door("+scene=gothic", "output=here/there")
    assert calls[0][1] == tmp_path / "here/there"
    assert not (tmp_path / "outputs").exists()


def test_the_neighbours_are_the_other_variants_of_the_same_scene_and_seed(door, tmp_path):
    for other in ("full/3", "depth_only/3", "full/4"):
        (tmp_path / "outputs/gothic" / other).mkdir(parents=True)
    arguments = ("+scene=gothic", "variant=depth_only", "seed=3")
    assert door(*arguments)[2][0][2] == [tmp_path / "outputs/gothic/full/3"]
    assert door(*arguments, "reuse=false")[2][0][2] == []
    assert door(*arguments, f"output={tmp_path / 'outputs/gothic/mine/3'}")[2][0][2] == []


@pytest.mark.parametrize("arguments", [(), ("output=mine",), ("fit.steps=-1",)])
def test_a_run_that_wrote_nothing_leaves_no_folder(door, tmp_path, arguments):
    kept = tmp_path / "outputs/gothic/depth_only/3/manifest.json"
    for beside in (False, True):
        if beside:
            kept.parent.mkdir(parents=True)
            kept.write_text("{}")
        code, _, _ = door("+scene=gothic", *arguments, action=raising(InputError("no such plan")))
        assert code == 2
        assert [path for path in tmp_path.rglob("*") if path.is_file()] == [kept] * beside
        assert sorted(path.name for path in tmp_path.iterdir()) == ["outputs"] * beside


def test_a_run_that_wrote_something_keeps_its_folder(door, tmp_path):
    def half(config, folder):
        (folder / "manifest.json").write_text("{}")
        raise RuntimeError("ill")

    assert door("+scene=gothic", action=half)[0] == 1
    assert (tmp_path / "outputs/gothic/full/0/manifest.json").is_file()


def test_hydra_may_say_where_even_at_the_root(door, tmp_path, monkeypatch):
    monkeypatch.setattr(run, "_tidy", lambda folder: None)
    assert door("+scene=gothic", "hydra.run.dir=/")[2][0][1:] == (Path("/"), [])


def test_hydra_may_say_where(door, tmp_path):
    assert door("+scene=gothic", f"hydra.run.dir={tmp_path / 'x'}")[2][0][1] == tmp_path / "x"


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (OSError(errno.ENOSPC, "No space left on device", "views/a.png"), 1, "views/a.png: the disk is full"),
        (PermissionError(errno.EACCES, "Permission denied", "plan.json"), 1, "plan.json: no permission to write or read here"),
        (OSError(errno.EROFS, "Read-only file system", "plan.json"), 1, "plan.json: no permission"),
        (RuntimeError("the painter\n  fell ill"), 1, "RuntimeError: the painter; fell ill (debug=true shows where)"),
        (IndexError(), 1, "IndexError"),
        (BudgetError("budget.usd=1 would be exceeded"), 1, "wm: budget.usd=1 would be exceeded\n"),
        (InputError("room hall: no free spot for a camera"), 2, "room hall: no free spot for a camera"),
        (RuntimeError("\n".join(f"line {k}" for k in range(200))), 1, "line 11; and 188 more"),
        (
            PlanError((Violation("hall", "zero_area", "no area"),), "my.json"),
            2,
            "my.json: 1 violation; room hall: zero_area: no area",
        ),
        (KeyboardInterrupt(), 130, "the same command resumes"),
    ],
)
def test_a_run_that_fails_says_one_line(door, error, code, said):
    got, err, _ = door("+scene=gothic", action=raising(error))
    assert got == code
    assert said in err
    assert err.startswith("wm: ") and err.count("\n") == 1


@pytest.mark.parametrize("argument", ["gothik", "+scene=gothik"])
def test_a_wrong_name_is_met_with_the_right_one(door, argument):
    code, err, calls = door(argument)
    assert (code, calls) == (2, [])
    assert err.startswith("wm: scene=gothik: no such scene; did you mean gothic? choose one of") and err.count("\n") == 1


def test_plain_words_are_the_same_run_as_overrides(door, tmp_path):
    forms = [("gothic", "--seed", "3", "--preset=draft"), ("+scene=gothic", "seed=3", "preset=draft")]
    (first, where, _), (second, there, _) = (door(*form)[2][0] for form in forms)
    assert first == second and where == there == tmp_path / "outputs/gothic/full/3"


def test_a_scene_without_a_name_lies_under_the_words_of_its_theme(door, tmp_path):
    _, _, calls = door("--theme", "a children's library, bright", "--rooms", "hall, kitchen")
    assert calls[0][1] == tmp_path / "outputs/a_childrens_library_bright/full/0"
    assert calls[0][0].scene.theme == "a children's library, bright"


def test_an_answer_to_a_reader_that_has_seen_enough_is_no_error(tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    env = os.environ | {"PYTHONPATH": str(Path(run.__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, "-m", "wm.run", "--help"], stdout=writing, stderr=subprocess.PIPE, cwd=tmp_path, env=env, check=False
    )
    os.close(writing)
    assert (done.returncode, done.stderr) == (0, b"")


def test_debug_shows_the_traceback(door):
    with pytest.raises(RuntimeError, match="ill"):
        door("+scene=gothic", "debug=true", action=raising(RuntimeError("ill")))


@pytest.mark.parametrize(
    "arguments", [["+scene=gothic", "fit.stepz=1"], ["+scene=gothic", "fit.init=cubes"], ["+scene=nowhere"], []]
)
def test_input_that_cannot_be_run_exits_with_2_and_one_line(door, arguments):
    code, err, calls = door(*arguments)
    assert (code, calls) == (2, [])
    assert err.startswith("wm: ") and err.count("\n") == 1


def test_a_file_where_the_folder_should_be(door, tmp_path):
    (tmp_path / "outputs").write_text("not a folder")
    code, err, calls = door("+scene=gothic")
    assert (code, calls) == (2, [])
    assert "a file stands where a folder is needed" in err and err.count("\n") == 1


def test_no_scene_on_the_command_line_lists_the_scenes(tmp_path):
    done = command(cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("wm: no scene") and "gothic" in done.stderr and done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_help_lists_groups_and_examples(tmp_path):
    done = command("--help", cwd=tmp_path)
    assert done.returncode == 0
    assert "wm gothic" in done.stdout and 'wm --theme "' in done.stdout
    assert all(f"\n  {name} " in done.stdout for group in ("scene", "preset", "variant", "image") for name in run.options(group))


def test_a_sweep_runs_every_variant_although_one_fails(tmp_path):
    action = "if config.variant == 'full': raise RuntimeError('ill')"
    done = command("-m", "+scene=gothic", "variant=full,depth_only", cwd=tmp_path, action=action)
    assert done.returncode == 1
    assert [line.split()[1] for line in done.stdout.splitlines() if line.startswith("gothic")] == ["full", "depth_only"]
    assert f"wm: {tmp_path}/outputs/gothic/full/0: RuntimeError: ill" in done.stderr
    assert "Traceback" not in done.stderr
    assert (tmp_path / "outputs/gothic/depth_only/0").is_dir()


def test_runs_of_a_sweep_that_would_share_a_folder_are_told_how_not_to(tmp_path):
    done = command("-m", "+scene=gothic", "preset=draft,standard", cwd=tmp_path, action=WRITES)
    assert done.returncode == 2
    assert done.stdout == "" and done.stderr.count("\n") == 1  # before the first row
    assert "row 2 of the sweep (+scene=gothic preset=standard): an earlier run of this sweep has this folder" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("group, named", [("preset", "${preset}"), ("variant", "${hydra:runtime.choices.variant}")])
def test_runs_of_a_sweep_lie_where_the_output_says_for_each(tmp_path, group, named):
    two = run.options(group)[:2]
    done = command("-m", "+scene=gothic", f"{group}={','.join(two)}", f"output=runs/{named}", cwd=tmp_path, action=WRITES)
    assert done.returncode == 0
    assert tuple(sorted(path.name for path in (tmp_path / "runs").iterdir())) == two


THEMES = f"""
    with open("themes", "a") as file: print(config.scene.theme, config.scene.name, sep=" | ", file=file)
    {WRITES}
"""


@pytest.mark.parametrize(
    ("arguments", "themes"),
    [
        (["--theme=oak, brass's \\"], ["oak, brass's \\ | oak_brasss"]),
        (["scene.theme=oak, brass's"], ["oak, brass's | oak_brasss"]),
        (["--theme=oak \\${seed}'", "seed=1"], ["oak \\${seed}' | oak_seed"]),
        (["scene.theme=choice(an oak, a cave)"], ["an oak | an_oak", "a cave | a_cave"]),
        (["scene.theme='an oak','a cave, dark'"], ["an oak | an_oak", "a cave, dark | a_cave_dark"]),
    ],
)
def test_a_comma_in_a_theme_is_text_in_a_sweep_too_but_in_hydras_choices(tmp_path, arguments, themes):
    done = command("-m", "--rooms", "hall", *arguments, cwd=tmp_path, action=THEMES)
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "themes").read_text().splitlines() == themes


def test_a_sweep_ends_with_a_table_of_its_runs(tmp_path):
    done = command("-m", "+scene=gothic", "variant=full,depth_only", cwd=tmp_path, action=WRITES)
    assert done.returncode == 0
    table = [line for line in done.stdout.splitlines() if line.startswith("| ")]
    assert [line.split("|")[1].strip() for line in table[1:3]] == ["full", "depth_only"]
    assert "24.00" in table[1] and "**30.00**" in table[2]


def test_interrupted_by_a_signal_it_waits_for_no_thread(tmp_path):
    action = """
    import os, signal, threading, time
    threading.Thread(target=time.sleep, args=(600,)).start()
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(600)
"""
    done = command("+scene=gothic", cwd=tmp_path, action=action, timeout=300)
    assert done.returncode == 130
    assert done.stderr == "wm: interrupted; the same command resumes\n"


@pytest.mark.parametrize(("statement", "loaded"), [("import wm", "[]"), ("import wm.pipeline", "['jax', 'matplotlib']")])
def test_what_importing_loads(statement, loaded):
    heavy = {"jax", "hydra", "embreex", "matplotlib", "trimesh", "torch", "diffusers", "anthropic", "openai", "google.genai"}
    code = f"import sys; {statement}; print(sorted(set(sys.modules) & {heavy!r}))"
    env = os.environ | {"PYTHONPATH": str(Path(run.__file__).parents[1])}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=env, check=True)
    assert done.stdout.strip() == loaded
