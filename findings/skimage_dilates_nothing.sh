#!/usr/bin/env bash
# scikit-image: isotropic_dilation of a mask in which nothing is set.
# Guess: nothing, as dilation with a disk gives.
# Seen: pixels near the image's origin are set: the distances to a mask without pixels are those to a point beside the corner.
# A depth map without an edge is such a mask; whoever dilates edges this way asks any() first.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q --disable-pip-version-check scikit-image==0.26.0 numpy==2.4.6 scipy==1.17.1
"$work/venv/bin/python" - <<'PY'
import numpy as np
import scipy
import skimage
from skimage.morphology import dilation, disk, isotropic_dilation

nothing = np.zeros((32, 48), bool)
grown, by_disk = isotropic_dilation(nothing, 3), dilation(nothing, disk(3))
print("scikit-image", skimage.__version__, "scipy", scipy.__version__)
print("guess: no pixel is set; with a disk it is", int(by_disk.sum()))
print("seen: set are", np.argwhere(grown).tolist())
assert not by_disk.any() and grown.sum() == 7 and grown[0, 0], "this has changed"
PY
