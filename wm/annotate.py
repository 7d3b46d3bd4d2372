"""Opens the annotation page of a run: python -m wm.annotate RUN.

A run with segmentation=sam3_clicks draws its rooms and stops; here a person marks the furniture in the drawings, and the same run
command then goes on. Settings of the model are those of the run. docs/annotation.md says more.
"""

import argparse
import pathlib
import sys
import threading
import webbrowser
from collections.abc import Sequence
from typing import Any

from wm import console
from wm.annotation.server import serve
from wm.annotation.session import Session
from wm.artifacts.manifest import ManifestDamage, read_manifest
from wm.errors import InputError
from wm.synth.backends import ClickedSegmentation
from wm.synth.lifting.drawings import kept_drawings
from wm.synth.registry import backend_module, close_backend, make_backend

BAD_INPUT = 2
_MIN_AREA = 2e-4
"""Share of an image below which a mask is left out, where the run does not say it (wm.synth.lifting.lifted)."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Serves the page until Ctrl-C. Returns 0, or 2 where the run cannot be annotated; the reason is a line on stderr."""
    asked = _parsed(arguments)
    try:
        backend, min_area = opened(asked.run, model=asked.model)
        try:
            _served(Session(asked.run, backend, min_area=min_area), asked)
        finally:
            close_backend(backend)
    except (InputError, OSError) as error:
        console.warn(f"wm.annotate: {error}")
        return BAD_INPUT
    return 0


def opened(run: pathlib.Path, *, model: str | None = None) -> tuple[ClickedSegmentation, float]:
    """The segmentation backend of a run, and the share of an image below which it leaves masks out.

    Args:
      run: the run folder.
      model: another checkpoint than the run's.

    Raises:
      InputError: it is no run folder, its segmentation takes no clicks, or nothing is drawn yet.
    """
    config = _config(run)
    told = dict(config.get("segmentation") or {}) | ({"model": model} if model is not None else {})
    name = str(told.get("backend", ""))
    try:
        backend = make_backend("segmentation", backend_module(name).Settings(**told))
    except TypeError as error:
        raise InputError(f"{run}: this version of wm does not know its settings of {name} ({error})") from error
    if not isinstance(backend, ClickedSegmentation):
        close_backend(backend)
        raise InputError(f"{run}: its segmentation is {name}, which goes by no clicks; segmentation=sam3_clicks does")
    if not kept_drawings(run):
        close_backend(backend)
        raise InputError(f"{run}: no room is drawn yet; run it first, and it stops where clicks are needed")
    return backend, float((config.get("objects") or {}).get("min_area", _MIN_AREA))


def _config(run: pathlib.Path) -> dict[str, Any]:
    """The configuration that a run folder was made with."""
    try:
        manifest = read_manifest(run)
    except ManifestDamage:
        manifest = None
    config = None if manifest is None else manifest.header.get("config")
    if not isinstance(config, dict):
        raise InputError(f"{run}: no run is there; give the folder of one, such as outputs/gothic/full/0")
    return config


def _served(session: Session, asked: argparse.Namespace) -> None:
    with serve(session, asked.port) as address:
        console.say(f"{asked.run}: annotate at {address} (for this machine only; Ctrl-C ends it, everything is saved as you go)")
        if not asked.no_browser:
            webbrowser.open(address)
        try:
            threading.Event().wait()
        except KeyboardInterrupt:
            console.say("")


def _parsed(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m wm.annotate", description="Mark the furniture in the drawings of a run.")
    parser.add_argument("run", type=pathlib.Path, help="folder of a run with segmentation=sam3_clicks")
    parser.add_argument("--port", type=int, default=0, help="port of the page; by default one that is free")
    parser.add_argument("--model", help="another checkpoint than the run's: a folder, or OWNER/NAME@COMMIT of the hub")
    parser.add_argument("--no-browser", action="store_true", help="only print the address")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
