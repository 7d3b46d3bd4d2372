"""A manifest may be anybody's: whatever it says, no file outside the folder is touched, and only an ArtifactError ends a run."""

import contextlib
import json
import tempfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wm.artifacts.digests import content_digest
from wm.artifacts.manifest import differences, read_manifest
from wm.artifacts.neighbours import Neighbours
from wm.artifacts.run_folder import open_run_folder
from wm.errors import ArtifactError

HEADER = {"seed": 0}
PRECIOUS = b"precious"
DIGEST = content_digest(PRECIOUS)

names = st.sampled_from(
    [
        "a.png",
        "../victim",
        "/victim",
        "away/victim",
        "manifest.json",
        ".lock",
        "views/../../victim",
        "thesis.tex",
        "",
        "\ud800",
        "\0",
    ]
) | st.text(max_size=6)
values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.sampled_from(["k", DIGEST, "x"]) | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(names, inner, max_size=3),
    max_leaves=6,
)
entries = st.fixed_dictionaries(
    {"key": st.just("k") | values, "files": st.dictionaries(names, st.just(DIGEST) | values, max_size=3)}
)
manifests = st.fixed_dictionaries(
    {
        "header": st.just(HEADER) | values,
        "entries": st.dictionaries(st.just("heldout/a") | st.text(max_size=3), entries | values, max_size=3),
    }
)


@contextlib.contextmanager
def folders():
    """A run folder with a link to what is outside, and a folder of somebody else."""
    with tempfile.TemporaryDirectory() as name:
        top = Path(name)
        run = top / "run"
        run.mkdir()
        (top / "victim").write_bytes(PRECIOUS)
        (run / "away").symlink_to(top)
        (run / ".lock").touch()
        yield top, run


def untouched(top: Path) -> bool:
    return (top / "victim").read_bytes() == PRECIOUS and {path.name for path in top.iterdir()} <= {"run", "mine", "victim"}


@given(manifests | values, st.booleans())
def test_a_mutated_manifest_reaches_no_file_outside(manifest, overwrite):
    with folders() as (top, run):
        (run / "manifest.json").write_text(json.dumps(manifest))
        with (
            contextlib.suppress(ArtifactError),
            open_run_folder(run, HEADER, overwrite=overwrite, say=lambda line: None) as folder,
        ):
            folder.has("heldout/a", "k")
            folder.drop_others("heldout/", {"heldout/a"})
            folder.save("heldout/b", "k", {"b.png": b"b"})
            folder.drop_unasked()
            assert folder.has("heldout/b", "k")
        assert untouched(top)


@given(manifests)
def test_a_mutated_manifest_of_a_neighbour_writes_no_file_outside(manifest):
    with folders() as (top, run):
        (run / "manifest.json").write_text(json.dumps(manifest))
        (run / "thesis.tex").write_bytes(PRECIOUS)
        lend = Neighbours([run], say=lambda line: None, account=lambda stage, path: None).lend
        with open_run_folder(top / "mine", HEADER, lend=lend, say=lambda line: None) as folder:
            folder.has("heldout/a", "k")
        assert untouched(top)
        assert read_manifest(top / "mine").header == HEADER


@given(st.integers(0, 10**6), st.integers(1, 255))
def test_one_damaged_byte_of_a_manifest_is_noticed_or_changes_nothing(place, change):
    with folders() as (top, run):
        with open_run_folder(run, HEADER, overwrite=True, say=lambda line: None) as folder:
            folder.save("heldout/a", "k", {"a.png": PRECIOUS})
        text = bytearray((run / "manifest.json").read_bytes())
        text[place % len(text)] ^= change
        (run / "manifest.json").write_bytes(text)
        with contextlib.suppress(ArtifactError), open_run_folder(run, HEADER, say=lambda line: None) as folder:
            if not folder.has("heldout/a", "k"):
                folder.save("heldout/a", "k", {"a.png": PRECIOUS})
            folder.drop_unasked()
            assert (run / "a.png").read_bytes() == PRECIOUS
        assert untouched(top)


@pytest.mark.parametrize("name", ["../victim", "away/victim", "manifest.json", ".lock"])
def test_an_entry_with_such_a_file_is_none_and_the_others_stay(name):
    with folders() as (top, run):
        with open_run_folder(run, HEADER, overwrite=True) as folder:
            folder.save("plan", "k", {"plan.json": b"{}"})
        manifest = json.loads((run / "manifest.json").read_text())
        manifest["entries"]["evil"] = {"key": "k", "files": {name: DIGEST}}
        (run / "manifest.json").write_text(json.dumps(manifest))
        with open_run_folder(run, HEADER, say=lambda line: None) as folder:
            assert folder.has("plan", "k") and not folder.has("evil", "k")
        assert untouched(top)


def test_a_manifest_behind_a_link_is_not_read():
    with folders() as (top, run):
        (top / "victim").write_text(json.dumps({"header": HEADER, "entries": {}}))
        (run / "manifest.json").symlink_to(top / "victim")
        with pytest.raises(ArtifactError, match="leads through a link"):
            open_run_folder(run, HEADER).__enter__()


def test_differences_name_every_leaf():
    assert differences({"a": {"b": 1, "c": 2}}, {"a": {"b": 1, "c": 3}, "d": 4}) == [
        "a.c=2 (this one: 3)",
        "d=None (this one: 4)",
    ]
