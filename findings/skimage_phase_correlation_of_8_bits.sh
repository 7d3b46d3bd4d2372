#!/usr/bin/env bash
# scikit-image: sub-pixel registration of a smooth image of 8 bits with a copy of it that is moved by a quarter of a pixel.
# Guess: phase_cross_correlation, as it comes and upsampled 50 times, reads a quarter of a pixel.
# Seen: its whitened spectrum gives the rounding to 8 bits, which fills the high frequencies, as much weight as the image, which leaves
# them empty: it reads nothing, or pixels in another direction. With normalization=None it reads the quarter to 0.01.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q --disable-pip-version-check scikit-image==0.26.0 numpy==2.4.6 scipy==1.17.1
"$work/venv/bin/python" - <<'PY'
import numpy as np
import skimage
from scipy.ndimage import fourier_shift, gaussian_filter
from skimage.registration import phase_cross_correlation

def read(blur, normalization):
    smooth = gaussian_filter(np.random.default_rng(0).normal(size=(256, 256)), blur, mode="wrap")
    smooth = (smooth - smooth.min()) / np.ptp(smooth)
    moved = np.fft.ifftn(fourier_shift(np.fft.fftn(smooth), (0, 0.25))).real
    still, moved = (np.round(np.clip(image, 0, 1) * 255) for image in (smooth, moved))
    return phase_cross_correlation(moved, still, upsample_factor=50, normalization=normalization)[0]


seen = {n: [read(blur, n).round(2).tolist() for blur in (4, 8, 16)] for n in ("phase", None)}
wrong = {n: [float(np.abs(np.array(shift) - (0, 0.25)).max()) for shift in shifts] for n, shifts in seen.items()}
print("scikit-image", skimage.__version__)
print("guess: (0, 0.25) px, whatever the normalization")
print("seen, of images blurred by 4, 8 and 16 px:", seen)
assert min(wrong["phase"]) > 0.15 and max(wrong[None]) < 0.05, "this has changed"
PY
