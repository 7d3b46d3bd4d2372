"""Part of stage `evaluate`: what CLIP makes of the pictures of the held-out views, where there are weights for it.

It reads the pictures that `evaluate` has stored, so that a finished run can be scored afterwards without rendering again.
"""

from collections.abc import Sequence

import numpy as np

from wm import codecs
from wm.artifacts.confined import confined
from wm.artifacts.digests import json_text
from wm.metric_table import read_metrics
from wm.quality import open_quality
from wm.stages.run_context import RunContext

ENTRY, SCORES = "evaluate/quality", "stages/quality.json"


def scores_of(run: RunContext, pictures: Sequence[str], key: str) -> dict[str, float | int | None]:
    """The mean scores of the pictures by key; nothing where `evaluate.quality` names no weights.

    Args:
      run: within its stage `evaluate`.
      pictures: PNG files of the run folder.
      key: of what the pictures were made from.

    Raises:
      InputError, MissingExtraError, ServiceError: see `wm.quality.open_quality` and `Quality.score`.
    """
    if run.config.evaluate.quality is None:
        return {}
    quality = open_quality(run.config.evaluate.quality)
    wanted = run.key("quality", key, quality.identity)
    if run.folder.has(ENTRY, wanted):
        known = read_metrics(run.folder.path / SCORES)
        if known is not None:
            return known
    rows = []
    with run.bar("quality", len(pictures)) as bar:
        for name in pictures:
            rows.append(quality.score(codecs.decode_png(confined(run.folder.path, name).read_bytes())))
            bar.update()
    means: dict[str, float | int | None] = {
        score: float(np.mean([row[score] for row in rows])) for score in quality.files if rows
    }
    run.folder.save(ENTRY, wanted, {SCORES: json_text(means)})
    return means
