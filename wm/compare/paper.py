"""The paper's figures of the systems that it compares with (worldmesh.tex, tab:comparison and tab:main).

`clip_iqa` and `aesthetic` are those of tab:comparison; tab:main measures them on another set.
"""

_COLUMNS = ("clip_iqa", "aesthetic", "quality", "objects", "structure", "reproj_mae_norm", "reproj_absrel")

PAPER: dict[str, dict[str, float]] = {
    name: dict(zip(_COLUMNS, values))
    for name, values in {
        "wonderworld": (0.4872, 4.7795, 1.94, 2.19, 1.84),
        "flexworld": (0.4097, 4.9453, 2.05, 2.00, 2.34),
        "layerpano3d": (0.3949, 4.7312, 2.27, 2.21, 2.44),
        "worldexplorer": (0.4053, 5.5476, 2.58, 2.47, 2.76, 0.3221, 0.1183),
        "spatialgen": (0.4648, 5.0633, 2.61, 3.00, 3.00, 0.4055, 0.1825),
        "dreamscene360": (0.3565, 4.7270, 3.19, 3.10, 3.37, 0.4336, 0.1282),
        "ours": (0.5114, 5.5799, 4.48, 4.40, 4.35, 0.1615, 0.0761),
    }.items()
}
"""By adapter: image scores, the study's means from 1 to 5, and reprojection errors where tab:main has them."""
