"""Videos of methods, matched by the name of the scene, and copied without anything that tells the method.

A browser plays H.264, VP9 and AV1 with 4:2:0 colours; such videos are copied frame by frame as they are, and others (such as the
MPEG-4 that OpenCV writes as mp4v) are encoded anew as H.264. Sound, titles, comments and dates in the file are left out. A copy
is named by the digest of its bytes.
"""

import hashlib
import pathlib
import re
import subprocess
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import imageio_ffmpeg

from wm.artifacts.atomic import write_atomically
from wm.errors import InputError

PLAYED = ("h264", "vp9", "av1")
"""Codecs that browsers play out of MP4 files."""
CRF = 18
"""Constant rate factor of x264 for videos that have to be encoded anew: no difference is visible."""
_COPIED = "-c copy"
_ENCODED = f"-vf crop=trunc(iw/2)*2:trunc(ih/2)*2 -c:v libx264 -crf {CRF} -preset medium -pix_fmt yuv420p -threads 2"
_BARE = "-map 0:v:0 -map_metadata -1 -map_chapters -1 -an -sn -dn -movflags +faststart -fflags +bitexact -bitexact -f mp4"
_DURATION = 0.05  # share by which videos of one scene may differ in length without a word
_DIGITS = 16  # hexadecimal digits of a video's name


@dataclass(frozen=True)
class SourceVideo:
    """A video as a method has written it."""

    method: str
    scene: str
    path: pathlib.Path


@dataclass(frozen=True)
class StudyVideo:
    """A video of the study."""

    name: str  # digest; the file is <name>.mp4
    method: str
    scene: str
    source: str
    width: int
    height: int
    seconds: float
    encoded: bool  # anew, since browsers do not play the original


def matched(methods: Mapping[str, pathlib.Path]) -> tuple[list[SourceVideo], list[str]]:
    """The videos of the scenes that all methods have, and the names of scenes that some lack.

    Args:
      methods: for each method a video, or a folder in which each video has the name of its scene or trajectory. Where every
        method has one video only, they are of the same scene whatever their names are.

    Raises:
      InputError: a path holds no video, or no scene is common to all.
    """
    found = {method: _of(method, path) for method, path in methods.items()}
    if all(path.is_file() for path in methods.values()):
        found = {method: {"scene": next(iter(videos.values()))} for method, videos in found.items()}
    common = set.intersection(*(set(videos) for videos in found.values()))
    if not common:
        some = "; ".join(f"{method} has {', '.join(sorted(videos)[:3])}" for method, videos in found.items())
        raise InputError(f"no scene is common to all methods, by the names of their videos: {some}")
    others = sorted(set().union(*found.values()) - common)
    return [SourceVideo(method, scene, found[method][scene]) for scene in sorted(common) for method in methods], others


def _of(method: str, path: pathlib.Path) -> dict[str, pathlib.Path]:
    """A method's videos by scene: the path inside the folder, without the suffix."""
    if path.is_file():
        return {path.stem: path}
    files = sorted(file for file in path.rglob("*") if file.suffix.lower() == ".mp4" and file.is_file()) if path.is_dir() else []
    if not files:
        raise InputError(f"{method}={path}: no video (.mp4) is there")
    videos: dict[str, pathlib.Path] = {}
    for file in files:
        scene = file.relative_to(path).with_suffix("").as_posix()
        if scene in videos:
            raise InputError(f"{method}={path}: {videos[scene].name} and {file.name} are of the same scene")
        videos[scene] = file
    return videos


def copied(source: SourceVideo, folder: pathlib.Path) -> StudyVideo:
    """Copies a video into a folder under the digest of its bytes, without what tells the method.

    Raises:
      InputError: the file is no video, or is damaged; the message names method and file.
    """
    width, height, seconds, plays = _properties(source)
    told = _COPIED if plays else _ENCODED
    with tempfile.TemporaryDirectory() as scratch:
        copy = pathlib.Path(scratch) / "copy.mp4"
        _ffmpeg(source, ["-i", str(source.path), *told.split(), *_BARE.split(), str(copy)])
        content = copy.read_bytes()
    name = hashlib.sha256(content).hexdigest()[:_DIGITS]
    write_atomically(folder / f"{name}.mp4", content)
    return StudyVideo(name, source.method, source.scene, str(source.path), width, height, seconds, not plays)


def _properties(source: SourceVideo) -> tuple[int, int, float, bool]:
    """Width, height, seconds, and whether browsers play it. Decodes every frame, so that a damaged file is found here."""
    said = _ffmpeg(source, ["-i", str(source.path), "-map", "0:v:0", "-f", "null", "-"], level="info")
    stream = re.search(r"Stream #0.*?Video: (\w+)[^,]*, (\w+)[^\n]*?, (\d+)x(\d+)", said)
    times = re.findall(r"time=(\d+):(\d+):([\d.]+)", said)
    if stream is None or not times:
        raise InputError(f"{source.method}={source.path}: no frame of a video is in the file")
    hours, minutes, seconds = times[-1]
    length = 3600 * int(hours) + 60 * int(minutes) + float(seconds)
    plays = stream[1] in PLAYED and stream[2] in ("yuv420p", "yuvj420p")
    return int(stream[3]), int(stream[4]), length, plays


def _ffmpeg(source: SourceVideo, arguments: list[str], level: str = "error") -> str:
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-y", "-nostdin", "-hide_banner", "-loglevel", level, "-xerror", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if line.strip()] or ["ffmpeg says nothing"]
        raise InputError(f"{source.method}={source.path}: the video cannot be read whole ({lines[-1].strip()})")
    return done.stderr


def without_twins(videos: Sequence[StudyVideo]) -> None:
    """Refuses videos that are the same, byte for byte.

    Raises:
      InputError: two are; the message names both.
    """
    seen: dict[str, StudyVideo] = {}
    for video in videos:
        if (twin := seen.setdefault(video.name, video)) is not video:
            raise InputError(f"{twin.source} ({twin.method}) and {video.source} ({video.method}) are the same video")


def telling_differences(videos: Iterable[StudyVideo]) -> list[str]:
    """A line for each scene whose videos differ in size or length, by which participants can tell methods apart."""
    scenes: dict[str, list[StudyVideo]] = {}
    for video in videos:
        scenes.setdefault(video.scene, []).append(video)
    lines = []
    for scene, group in scenes.items():
        sizes = {(video.width, video.height) for video in group}
        lengths = [video.seconds for video in group]
        if len(sizes) > 1 or max(lengths) - min(lengths) > _DURATION * max(lengths):
            each = ", ".join(f"{video.method} {video.width} x {video.height}, {video.seconds:.1f} s" for video in group)
            lines.append(f"{scene}: videos differ in size or length, which tells methods apart: {each}")
    return lines
