"""The fly-through as an H.264 video."""

import pathlib
from collections.abc import Iterable

import imageio_ffmpeg
import numpy as np

CRF = 23


def write_video(path: pathlib.Path, frames: Iterable[np.ndarray], *, fps: int) -> int:
    """Encodes frames to an MP4 that browsers play.

    Args:
      path: the file; written in place, so give a temporary name and rename it.
      frames: uint8 [h, w, 3], all of one size; odd sizes are cropped to even ones (4:2:0 needs them).
      fps: frames a second.

    Returns:
      How many frames were written; with none, no file is made.
    """
    count = 0
    writer = None
    try:
        for frame in frames:
            height, width = frame.shape[0] // 2 * 2, frame.shape[1] // 2 * 2
            if writer is None:
                writer = imageio_ffmpeg.write_frames(
                    str(path),
                    (width, height),
                    fps=fps,
                    codec="libx264",
                    macro_block_size=1,
                    pix_fmt_out="yuv420p",
                    output_params=f"-crf {CRF} -preset veryfast -movflags +faststart -threads 2 -bitexact".split(),
                    ffmpeg_log_level="error",
                )
                writer.send(None)
            writer.send(np.ascontiguousarray(frame[:height, :width]))
            count += 1
    finally:
        if writer is not None:
            writer.close()
    return count
