"""Names of files stay in their folder, by their text and through links."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.artifacts.confined import confined, is_plain
from wm.errors import ArtifactError

OUT = ("", ".", "..", "/etc/passwd", "../x", "a/../../x", "a//b", "a/", "./a", "C:x", "a\\b", "a\0b", "a\nb", 300 * "a")


@pytest.mark.parametrize("name", OUT)
def test_a_name_that_is_no_place_below_the_folder_is_refused(tmp_path, name):
    assert not is_plain(name)
    with pytest.raises(ArtifactError):
        confined(tmp_path, name)


@pytest.mark.parametrize("name", ["plan.json", "views/hall/bootstrap0.depth.png", "a..b", ".lock", "Küche/1.png"])
def test_names_below_the_folder_are_paths_in_it(tmp_path, name):
    assert confined(tmp_path, name) == tmp_path / name


def test_links_that_lead_out_are_refused_and_links_within_are_not(tmp_path):
    run, outside = tmp_path / "run", tmp_path / "outside"
    for folder in (run / "views", outside):
        folder.mkdir(parents=True)
    (run / "away").symlink_to(outside)
    (run / "file").symlink_to(outside / "secret")
    (run / "within").symlink_to(run / "views")
    for name in ("away/x", "file"):
        with pytest.raises(ArtifactError, match="leads through a link"):
            confined(run, name)
    with pytest.raises(ArtifactError):
        confined(run, "away/x", replaced=True)
    assert confined(run, "within/x") == run / "within/x"
    assert confined(run, "file", replaced=True) == run / "file"  # the link itself is replaced
    (tmp_path / "alias").symlink_to(run)
    assert confined(tmp_path / "alias", "views/x") == tmp_path / "alias/views/x"


@given(st.text(alphabet="a./\\:\0\nü", max_size=12))
def test_whatever_is_plain_stays_below(name):
    if is_plain(name):
        parts = name.split("/")
        assert parts and not set(parts) & {"", ".", ".."}
