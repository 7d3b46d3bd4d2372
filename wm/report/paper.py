"""The paper's own figures beside ours (worldmesh.tex: the ablation table, the scaling table, "Navigability").

They go by the keys of `wm.metric_table`, in its units: metres, degrees, seconds, and shares from 0 to 1.
"""

PAPER_COLUMNS = ("reproj_mae_norm", "reproj_absrel", "m_mae", "m_rmse", "n_cos", "n_ang_deg", "clip_iqa", "aesthetic")
"""The columns of the paper's ablation table."""

PAPER_ROWS: dict[str, dict[str, float]] = {
    variant: dict(zip(PAPER_COLUMNS, values))
    for variant, values in {
        "full": (0.1615, 0.0761, 0.0383, 0.1285, 0.6893, 39.26, 0.5529, 5.5925),
        "depth_objects": (0.2229, 0.0997, 0.1167, 0.2485, 0.4033, 62.01, 0.3870, 5.1057),
        "depth_walls_bboxes": (0.2722, 0.1988, 0.3335, 0.6387, 0.3452, 66.17, 0.3735, 5.2041),
        "depth_only": (0.1970, 0.0888, 0.2777, 0.5857, 0.3780, 63.86, 0.3818, 5.0515),
        "no_edge_recall": (0.1660, 0.0784, 0.0478, 0.1437, 0.6489, 42.65, 0.5237, 5.5482),
        "no_pcd_init": (0.1706, 0.0803, 0.0479, 0.1406, 0.6433, 42.93, 0.5204, 5.5831),
        "no_depth_loss": (0.3009, 0.1641, 0.1904, 0.3969, 0.4574, 57.72, 0.5312, 5.5573),
        "no_init_no_depth": (1.8804, 0.6730, 2.2549, 4.6730, 0.2205, 74.65, 0.4393, 5.4270),
    }.items()
}
"""Ablation table (a), backbone NB Pro, five scenes, per variant."""

PAPER_SCENE: dict[str, float] = {"navigability": 0.967, "yield": 0.86, "atm": 1.22, "seconds": 3600.0}
"""Navigability over five scenes; yield, attempts a view and time of a six-room scene with NB Pro (an API and a 24 GB GPU)."""


def paper_figure(variant: str, key: str) -> float | None:
    """The paper's value of a metric, or None where it has none."""
    return PAPER_ROWS.get(variant, {}).get(key, PAPER_SCENE.get(key))
