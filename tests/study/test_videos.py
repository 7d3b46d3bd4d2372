"""Videos: matched by scene, copied without what tells the method, playable by browsers, and refused where damaged."""

import hashlib
import shutil
import subprocess

import imageio_ffmpeg
import pytest

from tests.study.clips import METHODS, SCENES, clip, clips
from wm.errors import InputError
from wm.study.videos import SourceVideo, copied, matched, telling_differences, without_twins


def about(path):
    """What ffmpeg says of a file."""
    return subprocess.run([imageio_ffmpeg.get_ffmpeg_exe(), "-i", str(path)], capture_output=True, text=True).stderr


def frames(path):
    """A digest of the decoded frames."""
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-i", str(path), "-map", "0:v", "-f", "framemd5", "-"]
    return [
        line for line in subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines() if line[0] != "#"
    ]


def test_scenes_that_all_have_are_matched_and_others_named(tmp_path):
    methods = clips(tmp_path)
    shutil.copy(methods["ours"] / f"{SCENES[0]}.mp4", methods["ours"] / "attic.mp4")
    found, others = matched(methods)
    assert [(source.scene, source.method) for source in found] == [(scene, method) for scene in SCENES for method in METHODS]
    assert others == ["attic"]


def test_single_videos_are_of_the_same_scene_whatever_their_names(tmp_path):
    files = {method: clip(tmp_path / f"{method}.mp4") for method in ("a", "b")}
    found, _ = matched(files)
    assert [(source.scene, source.path) for source in found] == [("scene", files["a"]), ("scene", files["b"])]


def test_no_common_scene_and_empty_folders_are_one_clear_error(tmp_path):
    one, two = clip(tmp_path / "a" / "hall.mp4").parent, clip(tmp_path / "b" / "attic.mp4").parent
    with pytest.raises(InputError, match=r"no scene is common to all methods.*a has hall; b has attic"):
        matched({"a": one, "b": two})
    (tmp_path / "none").mkdir()
    with pytest.raises(InputError, match=r"c=.*none: no video \(.mp4\) is there"):
        matched({"a": one, "c": tmp_path / "none"})


@pytest.mark.parametrize("codec", ["libvpx-vp9", "libx264"])
def test_a_playable_video_is_copied_frame_by_frame_without_its_title(tmp_path, codec):
    source = clip(tmp_path / "SecretMethod" / "hall.mp4", codec=codec)
    assert b"SecretMethod" in source.read_bytes()
    video = copied(SourceVideo("SecretMethod", "hall", source), tmp_path / "page")
    copy = tmp_path / "page" / f"{video.name}.mp4"
    assert b"SecretMethod" not in copy.read_bytes() and frames(copy) == frames(source)
    assert (video.width, video.height, video.encoded) == (64, 36, False)
    assert video.seconds == pytest.approx(0.4, abs=0.11)  # ffmpeg counts to the last frame, in some versions to its end
    assert video.name == hashlib.sha256(copy.read_bytes()).hexdigest()[: len(video.name)]
    assert copied(SourceVideo("SecretMethod", "hall", source), tmp_path / "page") == video


def test_what_browsers_do_not_play_is_encoded_anew_and_odd_sizes_cropped(tmp_path):
    source = clip(tmp_path / "x" / "hall.mp4", codec="mpeg4", size="65x37")
    video = copied(SourceVideo("x", "hall", source), tmp_path / "page")
    said = about(tmp_path / "page" / f"{video.name}.mp4")
    assert video.encoded and "h264" in said and "yuv420p" in said and "64x36" in said
    assert len(frames(tmp_path / "page" / f"{video.name}.mp4")) == len(frames(source))


@pytest.mark.parametrize("content", ["truncated", "text", "empty"])
def test_a_damaged_file_is_one_clear_error_that_names_method_and_file(tmp_path, content):
    whole = clip(tmp_path / "x" / "hall.mp4", seconds=2).read_bytes()
    file = tmp_path / "bad.mp4"
    file.write_bytes({"truncated": whole[: len(whole) // 2], "text": b"no video", "empty": b""}[content])
    with pytest.raises(InputError, match=r"Meth=.*bad\.mp4: the video cannot be read whole") as error:
        copied(SourceVideo("Meth", "hall", file), tmp_path / "page")
    assert "\n" not in str(error.value)


def test_a_video_that_is_cut_short_after_its_index_is_found_too(tmp_path):
    whole = clip(tmp_path / "x" / "hall.mp4", seconds=3, codec="libx264", size="320x180", options=["-movflags", "+faststart"])
    cut = tmp_path / "cut.mp4"
    cut.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    with pytest.raises(InputError, match="cannot be read whole"):
        copied(SourceVideo("x", "hall", cut), tmp_path / "page")


def test_the_same_video_twice_is_refused(tmp_path):
    source = clip(tmp_path / "x" / "hall.mp4")
    videos = [copied(SourceVideo(method, "hall", source), tmp_path / "page") for method in ("a", "b")]
    with pytest.raises(InputError, match=r"\(a\) and .*\(b\) are the same video"):
        without_twins(videos)


def test_other_sizes_and_lengths_are_named(tmp_path):
    sizes = {"a": ("64x36", 0.4), "b": ("32x18", 0.4), "c": ("64x36", 1.0)}
    videos = {
        method: copied(
            SourceVideo(method, "hall", clip(tmp_path / f"{method}.mp4", size=size, seconds=seconds)), tmp_path / "page"
        )
        for method, (size, seconds) in sizes.items()
    }
    assert telling_differences([videos["a"]]) == []
    (line,) = telling_differences([videos["a"], videos["b"]])
    assert line.startswith("hall: videos differ in size or length") and "b 32 x 18" in line
    assert len(telling_differences([videos["a"], videos["c"]])) == 1
