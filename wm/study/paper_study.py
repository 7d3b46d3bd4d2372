"""The paper's figures of its study: 31 participants (worldmesh.tex, tables "comparison" and "ablation" (b)).

Methods go by their names in lower case without signs, so that "full", "Full (ours)" and "ours" are found whatever is typed.
"""

import re

_QUESTIONS = ("quality", "objects", "structure")

PAPER_RATINGS: dict[str, dict[str, tuple[float, float, float]]] = {
    "comparison": {
        "wonderworld": (1.94, 2.19, 1.84),
        "flexworld": (2.05, 2.00, 2.34),
        "layerpano3d": (2.27, 2.21, 2.44),
        "worldexplorer": (2.58, 2.47, 2.76),
        "spatialgen": (2.61, 3.00, 3.00),
        "dreamscene360": (3.19, 3.10, 3.37),
        "ours": (4.48, 4.40, 4.35),
    },
    "ablation": {
        "full": (4.48, 4.40, 4.35),
        "depthobjects": (3.35, 3.29, 3.52),
        "depthwallsbboxes": (2.19, 1.94, 2.26),
        "depthonly": (2.10, 1.97, 2.26),
    },
}
"""Mean ratings: quality, 3D objects, 3D structure."""

PAPER_PREFERENCES: dict[str, float] = {
    "spatialgen": 1.0,
    "wonderworld": 1.0,
    "worldexplorer": 0.968,
    "layerpano3d": 0.935,
    "dreamscene360": 0.935,
    "flexworld": 0.935,
}
"""Share that preferred the paper's method to each other one."""

_OURS = {"comparison": "ours", "ablation": "full"}


def plain(method: str) -> str:
    """A method's name in lower case, letters and digits only."""
    return re.sub(r"[^a-z0-9]", "", method.lower())


def paper_rating(table: str, method: str, question: str, *, reference: bool) -> float | None:
    """The paper's mean rating, or None where it has none.

    Args:
      table: "comparison", "ablation" or "".
      method: as the user calls it.
      question: "quality", "objects" or "structure".
      reference: whether it is the study's reference, which stands for the paper's own method.
    """
    row = PAPER_RATINGS.get(table, {}).get(_OURS.get(table, "") if reference else plain(method))
    return None if row is None or question not in _QUESTIONS else row[_QUESTIONS.index(question)]


def paper_preference(table: str, method: str) -> float | None:
    """The paper's share for its method against another; None where it has none."""
    return PAPER_PREFERENCES.get(plain(method)) if table == "comparison" else None
