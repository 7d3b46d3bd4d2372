"""The fly-through as an H.264 video, encoded by the ffmpeg binary that imageio-ffmpeg ships."""

import pathlib
import subprocess
from collections.abc import Iterable

import imageio_ffmpeg
import numpy as np

CRF = 23
"""Constant rate factor of x264, its default: lower is better and larger."""


def write_video(path: pathlib.Path, frames: Iterable[np.ndarray], *, fps: int) -> int:
    """Encodes frames to an MP4 that browsers play; equal frames give equal bytes.

    Args:
      path: the file. It is written in place, so give a temporary name and rename it afterwards.
      frames: uint8 [h, w, 3], all of one size. An odd size is cropped by one pixel, since 4:2:0 needs even ones.
      fps: frames per second.

    Returns:
      The number of frames written; without frames no file is made.

    Raises:
      RuntimeError: ffmpeg failed; the message includes its output.
    """
    count = 0
    encoder = None
    try:
        for frame in frames:
            height, width = frame.shape[0] // 2 * 2, frame.shape[1] // 2 * 2
            encoder = encoder or _start(path, width, height, fps)
            assert encoder.stdin is not None
            encoder.stdin.write(np.ascontiguousarray(frame[:height, :width]).tobytes())
            count += 1
    except BrokenPipeError:
        pass  # ffmpeg has ended early: its return code and output are read below
    except BaseException:
        if encoder is not None:
            encoder.kill()
            encoder.communicate()
        raise
    if encoder is not None:
        _, said = encoder.communicate()
        if encoder.returncode:
            raise RuntimeError(f"{path}: ffmpeg could not write the video: {said.decode(errors='replace').strip()}")
    return count


def _start(path: pathlib.Path, width: int, height: int, fps: int) -> subprocess.Popen:
    raw = f"-f rawvideo -pix_fmt rgb24 -s {width}x{height} -r {fps} -i -"
    coded = f"-c:v libx264 -crf {CRF} -preset veryfast -pix_fmt yuv420p -movflags +faststart -threads 2 -bitexact"
    command = [imageio_ffmpeg.get_ffmpeg_exe(), *f"-y -loglevel error {raw} {coded} -f mp4".split(), str(path)]
    # A session of its own, so that Ctrl-C interrupts this process alone, which then ends the encoder itself.
    return subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
