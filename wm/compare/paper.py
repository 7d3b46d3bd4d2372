"""The paper's figures of the systems that it compares with (worldmesh.tex, tab:comparison and tab:main).

`clip_iqa` and `aesthetic` are those of tab:comparison; tab:main measures them on another set. The ratings of the same
table are in wm.study.
"""

_COLUMNS = ("clip_iqa", "aesthetic", "reproj_mae_norm", "reproj_absrel")

PAPER: dict[str, dict[str, float]] = {
    name: dict(zip(_COLUMNS, values))
    for name, values in {
        "wonderworld": (0.4872, 4.7795),
        "flexworld": (0.4097, 4.9453),
        "layerpano3d": (0.3949, 4.7312),
        "worldexplorer": (0.4053, 5.5476, 0.3221, 0.1183),
        "spatialgen": (0.4648, 5.0633, 0.4055, 0.1825),
        "dreamscene360": (0.3565, 4.7270, 0.4336, 0.1282),
        "ours": (0.5114, 5.5799, 0.1615, 0.0761),
    }.items()
}
"""By adapter: image scores, and reprojection errors where tab:main has them."""
