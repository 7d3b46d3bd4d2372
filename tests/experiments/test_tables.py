"""Laws of the tables of experiments/ablation, experiments/scaling and experiments/layout_language."""

import importlib.util
import pathlib
import socket
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.metric_table import METRICS
from wm.models.language import claude, openai_compatible
from wm.report.paper import PAPER_COLUMNS, PAPER_ROWS
from wm.report.sweep import RunResult
from wm.schema import BackendSettings, RunConfig
from wm.synth.proposing import Attempt

EXPERIMENTS = pathlib.Path(__file__).parents[2] / "experiments"


def loaded(folder: str, name: str):
    """A module of an experiment, under a name of its own."""
    spec = importlib.util.spec_from_file_location(f"{folder}_{name}", EXPERIMENTS / folder / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


ablation, scaling, language = loaded("ablation", "table"), loaded("scaling", "fit"), loaded("layout_language", "run")


def run_of(variant: str, seed: int, scene: str = "gothic", **metrics: float | None) -> RunResult:
    return RunResult(
        config={"scene": {"name": scene}, "variant": variant, "seed": seed}, metrics=dict.fromkeys(METRICS) | metrics
    )


def test_a_cell_is_the_mean_over_scenes_and_the_farthest_seed():
    values = {("a", 0): 1.0, ("b", 0): 3.0, ("a", 1): 5.0, ("b", 1): 7.0}
    runs = [run_of("full", seed, scene, m_mae=value) for (scene, seed), value in values.items()]
    cell = ablation.cells(runs, "full")["m_mae"]
    assert cell.seeds == (2.0, 6.0) and cell.mean == 4.0 and cell.spread == 2.0


def test_a_metric_that_a_run_lacks_has_no_cell():
    runs = [run_of("full", 0, m_mae=1.0, psnr=20.0), run_of("full", 1, m_mae=None, psnr=21.0)]
    assert set(ablation.cells(runs, "full")) == {"psnr"} and not ablation.cells(runs, "depth_only")


seeds = st.lists(st.floats(0.1, 10), min_size=1, max_size=4).map(tuple)


@given(seeds, seeds, st.sampled_from(["m_mae", "n_cos"]))
def test_a_verdict_is_the_opposite_of_the_other_way_round(first, second, key):
    opposite = {"behind": "ahead", "ahead": "behind", "level": "level"}
    a, b, metric = ablation.Cell(seeds=first), ablation.Cell(seeds=second), METRICS[key]
    assert ablation.verdict(a, b, metric) == opposite[ablation.verdict(b, a, metric)]
    assert ablation.verdict(a, a, metric) == "level"


def test_a_verdict_goes_by_what_is_better_and_wants_every_seed_apart():
    low, high, between = (ablation.Cell(seeds=x) for x in ((1.0, 2.0), (3.0, 4.0), (1.5, 3.5)))
    assert ablation.verdict(low, high, METRICS["m_mae"]) == "behind" and ablation.verdict(low, high, METRICS["n_cos"]) == "ahead"
    assert ablation.verdict(low, between, METRICS["m_mae"]) == "level" == ablation.verdict(high, between, METRICS["m_mae"])


def test_the_paper_is_behind_its_full_method_in_every_column():
    cells = {variant: {key: ablation.Cell(seeds=(row[key],)) for key in PAPER_COLUMNS} for variant, row in PAPER_ROWS.items()}
    others = [variant for variant in PAPER_ROWS if variant != "full"]
    found = {ablation.verdict(cells["full"][key], cells[other][key], METRICS[key]) for other in others for key in PAPER_COLUMNS}
    assert found == {"behind"}


def test_the_table_has_our_row_and_the_papers_for_each_variant():
    runs = [run_of("full", seed, m_mae=0.01 + 0.002 * seed, seconds=60.0, peak_gib=1.5) for seed in (0, 1)]
    runs += [run_of("depth_only", seed, m_mae=0.02 + 0.002 * seed, seconds=70.0, peak_gib=1.5) for seed in (0, 1)]
    lines = ablation.markdown(runs, ["full", "depth_only"]).splitlines()
    assert len(lines) == 6 and len({line.count("|") for line in lines}) == 1
    assert "0.0110 ± 0.0010" in lines[2] and "0.0383" in lines[3] and "0.5529" in lines[3] and "0.2777" in lines[5]
    assert ablation.order(runs, ["full", "depth_only"]).splitlines()[2].split()[1:8:2] == ["depth_only", "–", "–", "behind"]


@given(st.floats(0.2, 3), st.floats(0.1, 50), st.lists(st.integers(1, 60), min_size=3, max_size=7, unique=True))
def test_the_exponent_of_an_exact_power_is_that_power(power, factor, rooms):
    fit = scaling.exponent(rooms, [factor * n**power for n in rooms])
    np.testing.assert_allclose([fit.value, fit.low, fit.high], power, atol=1e-4)


def test_the_interval_holds_the_true_exponent_as_often_as_it_says():
    rng, rooms, hits = np.random.default_rng(0), np.array([4, 6, 8, 12, 24, 48]), 0
    for _ in range(400):
        fit = scaling.exponent(rooms, rooms**1.1 * np.exp(rng.normal(0, 0.2, len(rooms))))
        hits += fit.low <= 1.1 <= fit.high
    assert 0.92 < hits / 400 < 0.98


def test_two_houses_give_an_exponent_without_an_interval_and_one_none():
    fit = scaling.exponent([2, 4], [1.0, 2.0])
    assert str(fit) == "1.00" and np.isnan(fit.low)
    for rooms, costs in (([4, 4], [1.0, 2.0]), ([4, 6], [0.0, 2.0])):
        with pytest.raises(ValueError, match="two different numbers of rooms, all positive"):
            scaling.exponent(rooms, costs)


def test_rules_that_answers_broke_are_counted_over_answers():
    lines = (("room hall: overlap: a", "plan: reach: b"), ("room bath: overlap: c",), ())
    attempts = tuple(Attempt("", violations, 1.0) for violations in lines)
    assert language.broken(attempts) == "overlap 2; reach 1" and language.broken(attempts[2:]) == ""


def test_a_row_sums_up_its_runs_and_says_what_was_in_the_way():
    runs = [
        language.Run("some", 2, 0, True, 1, 2.0, 0.25, ""),
        language.Run("some", 4, 1, False, 8, 4.0, 0.5, "overlap 2; reach 1"),
    ]
    row = language.row("some", runs, "")
    assert row == ["some", "1 of 2", "4.50 (1 to 8)", "3 (2 to 4)", "0.75", "overlap 2, reach 1"]
    assert language.row("some", runs, "no money")[-1].endswith("; stopped: no money")
    assert language.row("other", [], "no server")[-1] == "no server"


def test_a_backend_without_its_key_or_its_server_is_not_asked(monkeypatch):
    monkeypatch.delenv("ANTHROPIC_API_KEY", raising=False)
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        address = f"http://127.0.0.1:{listening.getsockname()[1]}"
        server = openai_compatible.Settings(base_url=f"{address}/v1", key="")
        assert language.obstacle(server) == f"no server at {address}"  # bound, and not listening
        listening.listen()
        assert language.obstacle(server) == ""
    assert language.obstacle(claude.Settings()) == "ANTHROPIC_API_KEY not set"
    assert language.obstacle(BackendSettings(backend="wm.offline.language.grammar")) == ""


def test_the_grammar_gives_a_valid_plan_for_each_size():
    config = RunConfig(language=BackendSettings(backend="wm.offline.language.grammar"))
    runs = list(language.measured("grammar", config, 5, None))
    assert [run.rooms for run in runs] == list(language.SIZES) and all(run.valid and run.usd == 0 for run in runs)
