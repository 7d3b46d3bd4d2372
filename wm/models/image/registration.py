"""Views on the canvases that image models offer, without shifting a pixel.

A model draws images of a few shapes and sizes. The condition of a view is scaled onto the canvas whose shape is nearest to the
view's, as large as it fits, centred, with its outermost pixels repeated in what is left over. The model's image shows the same
frame as the canvas, at whatever size it comes back, and the view is cut out of it.

Positions are continuous: pixel i of n covers [i, i + 1], its centre is i + 1/2. A view of w x h pixels lies on a canvas of W x H
at

    s = min(W / w, H / h),   left = (W - s w) / 2,   top = (H - s h) / 2,

so (x, y) of the view is (left + s x, top + s y) of the canvas, and W'/W and H'/H times that of an image of W' x H' pixels.
Both ways are resampled at pixel centres, with a low pass where pixels are lost (Pillow's `resize` with a fractional `box`).
"""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from wm.services.faults import RefusedError

SHAPE_SLACK = 0.05
"""Relative difference of aspect ratios up to which an image is taken to show the frame of the canvas. Services round their sizes:
1376 x 768 is called 16:9, and differs from it by 0.8 %."""
_REACH = 4
"""Pixels beside a place that the filters look at."""


@dataclasses.dataclass(frozen=True)
class ImageCanvas:
    """An image that a model is shown, and the frame of what it draws."""

    width: int  # pixels
    height: int
    ratio: str = ""  # what the service calls its shape, such as "16:9"

    def frame(self, width: int, height: int) -> tuple[float, float, float, float]:
        """(left, top, right, bottom) of a view of this size, in pixels of the canvas."""
        scale = min(self.width / width, self.height / height)
        left, top = (self.width - scale * width) / 2, (self.height - scale * height) / 2
        return left, top, self.width - left, self.height - top


def nearest_canvas(offered: Sequence[ImageCanvas], width: int, height: int) -> ImageCanvas:
    """Of the canvases whose shape is nearest to a view's, the smallest that is no smaller than the view, else the largest."""
    stretch = {canvas: _stretch(canvas.width, canvas.height, width, height) for canvas in offered}
    near = sorted((c for c in offered if stretch[c] <= min(stretch.values()) + 1e-9), key=lambda canvas: canvas.width)
    return next((canvas for canvas in near if canvas.width >= width and canvas.height >= height), near[-1])


@dataclasses.dataclass(frozen=True, kw_only=True)
class SizeLimits:
    """What a model accepts that draws images of every size within limits."""

    step: int  # sides are multiples of it, in pixels
    edge: int  # longest side, pixels
    low: int  # fewest pixels of an image
    high: int  # most pixels of an image
    widest: float  # longest side by shortest side

    def nearest(self, width: int, height: int, pixels: int) -> ImageCanvas:
        """The canvas of about as many pixels (4/5 to 5/4) whose shape is nearest to that of a view."""
        shape = min(max(width / height, 1 / self.widest), self.widest)
        most = min(self.high, int(self.edge**2 * min(shape, 1 / shape)))
        pixels = min(max(pixels, self.low), most)
        low, high = max(self.low, pixels * 4 // 5), min(most, pixels * 5 // 4)
        rows = range(int(math.sqrt(low / shape) / self.step), int(math.sqrt(high / shape) / self.step) + 2)
        sizes = [((int(row * shape) + more) * self.step, row * self.step) for row in rows for more in (0, 1)]
        fit = [size for size in sizes if low <= size[0] * size[1] <= high and self._allow(*size)]
        return ImageCanvas(
            *min(fit, key=lambda size: (round(_stretch(*size, width, height), 9), abs(size[0] * size[1] - pixels)))
        )

    def _allow(self, width: int, height: int) -> bool:
        return max(width, height) <= self.edge and max(width, height) <= self.widest * min(width, height)


def placed(view: UInt8[np.ndarray, "h w 3"], canvas: ImageCanvas) -> UInt8[np.ndarray, "H W 3"]:
    """An image of a view on a canvas. Where it is enlarged it is interpolated linearly, so that edges of depth get no halo."""
    height, width = view.shape[:2]
    left, top, right, _ = canvas.frame(width, height)
    scale = (right - left) / width
    beside = tuple(math.ceil(margin / scale) + _REACH for margin in (top, left))
    wide = np.pad(view, [(beside[0],) * 2, (beside[1],) * 2, (0, 0)], mode="edge")
    x, y = beside[1] - left / scale, beside[0] - top / scale
    return _resized(wide, canvas.width, canvas.height, (x, y, wide.shape[1] - x, wide.shape[0] - y), Image.Resampling.BILINEAR)


def cut_out(image: UInt8[np.ndarray, "H W 3"], canvas: ImageCanvas, width: int, height: int) -> UInt8[np.ndarray, "h w 3"]:
    """The view of a size in a model's image of a canvas.

    Raises:
      RefusedError: the image has another shape than the canvas, so that nobody knows what it shows of the frame.
    """
    rows, columns = image.shape[:2]
    if _stretch(columns, rows, canvas.width, canvas.height) > math.log1p(SHAPE_SLACK):
        asked = f"{canvas.width} x {canvas.height}"
        raise RefusedError(
            f"it drew {columns} x {rows} pixels, which is another shape than {asked}, so it does not show the same"
        )
    left, top, right, bottom = canvas.frame(width, height)
    across, down = columns / canvas.width, rows / canvas.height
    box = left * across, top * down, right * across, bottom * down
    return _resized(image, width, height, box, Image.Resampling.LANCZOS)


def _stretch(width: int, height: int, other_width: int, other_height: int) -> float:
    """How far apart two shapes are: the logarithm of what their aspect ratios differ by, 0 for the same shape."""
    return abs(math.log(width * other_height / (height * other_width)))


def _resized(
    image: np.ndarray, width: int, height: int, box: tuple[float, float, float, float], kernel: Image.Resampling
) -> np.ndarray:
    rows, columns = image.shape[:2]
    left, top, right, bottom = box  # it may reach outside by a rounding
    inside = max(left, 0.0), max(top, 0.0), min(right, columns), min(bottom, rows)
    return np.asarray(Image.fromarray(image).resize((width, height), kernel, box=inside))
