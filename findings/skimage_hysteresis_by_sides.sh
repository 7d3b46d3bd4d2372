#!/usr/bin/env bash
# scikit-image: which weak pixels does hysteresis keep, in the filter of that name and in the package's own Canny?
# Guess: apply_hysteresis_threshold is the hysteresis of Canny, so a weak pixel at the corner of a strong one is kept by both.
# Seen: the filter joins pixels by their sides only, Canny by their corners too: a diagonal edge falls to its strong pixels in the one and
# stays whole in the other. Edges by Sobel and that filter are no Canny edges.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q --disable-pip-version-check scikit-image==0.26.0 numpy==2.4.6 scipy==1.17.1
"$work/venv/bin/python" - <<'PY'
import numpy as np
import skimage
from skimage.feature import canny
from skimage.filters import apply_hysteresis_threshold

# a diagonal step that fades: strong in its upper half, weak below
y, x = np.mgrid[:48, :48]
step = (x > y) * (1 - y / 60)
edges, strong = (canny(step, sigma=0, low_threshold=low, high_threshold=2.5) for low in (0.3, 2.5))
strong_and_weak = np.zeros((5, 5))
strong_and_weak[1, 1], strong_and_weak[2, 2], strong_and_weak[3, 3] = 1.0, 0.5, 0.5
kept = apply_hysteresis_threshold(strong_and_weak, 0.4, 0.9)
rows, strong_rows = int(edges.any(axis=1).sum()), int(strong.any(axis=1).sum())
print("scikit-image", skimage.__version__)
print("guess: a diagonal of one strong and two weak pixels keeps three; Canny keeps its whole diagonal edge")
print(f"seen: the filter keeps {int(kept.sum())}; Canny keeps {rows} rows of an edge that is strong in {strong_rows}")
assert kept.sum() == 1 and rows == 46 and strong_rows == 25, "this has changed"
PY
