"""The table of a sweep: rows, means over seeds, the best of each column, what else differs."""

import json
import sys

import pytest

from wm.report import sweep
from wm.report.sweep import RunResult, read_runs, sweep_table


def run(variant="full", seed=0, scene="gothic", weight=1.5, **metrics):
    config = {"variant": variant, "seed": seed, "scene": {"name": scene, "theme": scene}, "fit": {"depth_weight": weight}}
    return RunResult(config=config, metrics=metrics)


def rows(table):
    """The table's rows by their first cell, each a dictionary by heading."""
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]
    return {line[0]: dict(zip(lines[0], line)) for line in lines[2:]}


def test_a_row_for_each_variant_and_the_papers_beneath():
    table = rows(sweep_table([run(m_mae=0.02, n_cos=0.9), run("depth_only", m_mae=0.3, n_cos=0.5)]))
    assert list(table) == ["full", "depth_only", "*paper: full*", "*paper: depth_only*"]
    assert table["full"]["M-MAE (m) ↓"] == "**0.0200**" and table["full"]["N-Cos ↑"] == "**0.9000**"
    assert table["depth_only"]["M-MAE (m) ↓"] == "0.3000"
    assert table["full"]["PSNR (dB) ↑"] == "–"
    assert table["*paper: depth_only*"]["M-MAE (m) ↓"] == "0.2777"


def test_seeds_share_a_row_as_mean_and_largest_distance_from_it():
    table = rows(sweep_table([run(seed=k, psnr=psnr) for k, psnr in enumerate((26.0, 28.0, 30.0))]))
    assert table["full"]["PSNR (dB) ↑"] == "28.00 ± 2.00"  # and no bold: it is the only row


def test_values_are_in_the_unit_of_their_heading():
    table = rows(sweep_table([run(**{"yield": 0.86}), run("depth_only", **{"yield": 0.9})]))
    assert table["full"]["Yield (%) ↑"] == "86.0" and table["depth_only"]["Yield (%) ↑"] == "**90.0**"


def test_nothing_is_best_where_all_are_equal():
    table = rows(sweep_table([run(atm=1.0), run("depth_only", atm=1.0)]))
    assert table["full"]["Atm ↓"] == table["depth_only"]["Atm ↓"] == "1.00"


def test_what_else_differs_names_the_row():
    table = rows(sweep_table([run(weight=0.7), run(weight=1.5), run("depth_only")]))
    assert {"full fit.depth_weight=0.7", "full fit.depth_weight=1.5", "depth_only fit.depth_weight=1.5"} <= set(table)


@pytest.mark.parametrize("turned", [False, True])
def test_a_run_that_knows_a_key_more_has_a_row_of_its_own(turned):
    newer = run()
    newer.config["fit"]["detail"] = 2
    table = rows(sweep_table([run(), newer][:: -1 if turned else 1]))
    assert {"full fit.detail=None", "full fit.detail=2"} <= set(table)


def test_variants_differ_in_their_own_keys_without_saying_so():
    assert "no_depth_loss" in rows(sweep_table([run(), run("no_depth_loss", weight=0.0)]))


def test_scenes_are_named_if_there_are_several():
    assert {"gothic full", "cabin full"} <= set(rows(sweep_table([run(), run(scene="cabin")])))


def test_the_command_reads_run_folders(tmp_path, monkeypatch, capsys):
    for seed in (0, 1):
        folder = tmp_path / "full" / str(seed)
        folder.mkdir(parents=True)
        one = run(seed=seed, psnr=25.0 + seed)
        (folder / "manifest.json").write_text(json.dumps({"header": {"config": one.config}}))
        (folder / "metrics.json").write_text(json.dumps(one.metrics))
    monkeypatch.setattr(sys, "argv", ["sweep", str(tmp_path)])
    sweep.main()
    assert rows(capsys.readouterr().out)["full"]["PSNR (dB) ↑"] == "25.50 ± 0.50"
    assert len(read_runs([tmp_path / "full/0"])) == 1
    (tmp_path / "other").mkdir()
    (tmp_path / "other/metrics.json").write_text("{}")  # somebody else's
    sweep.main()
    said = capsys.readouterr()
    assert f"left out: {tmp_path / 'other'} holds no finished run" in said.err and "25.50" in said.out
    monkeypatch.setattr(sys, "argv", ["sweep", str(tmp_path / "empty")])
    with pytest.raises(SystemExit, match="no finished run under"):
        sweep.main()
