"""The files of a run's page by name: the page and its libraries, out of the package, and what it shows, out of the run."""

import base64
import hashlib
import json
import pathlib
import re
from collections.abc import Mapping

from wm.artifacts.atomic import write_atomically
from wm.errors import InputError
from wm.export.navmesh import navmesh_json
from wm.finished import FinishedRun
from wm.geometry.placement.navmesh import build_navmesh
from wm.view.world_record import world_record

Site = Mapping[str, bytes | pathlib.Path]
"""By name, such as "vendor/three/LICENSE": the content, or the file that holds it."""

_PACKAGE = pathlib.Path(__file__).parent
_IMPORT_MAP = re.compile(rb'<script type="importmap">(.*?)</script>', re.DOTALL)


class SiteError(InputError):
    """A folder that a page cannot be written into."""


def build_site(run: FinishedRun) -> Site:
    """The page of a run.

    Raises:
      UnfinishedRunError: the run is not finished; the message names what it lacks.
      InputError, OSError: a file of the run is damaged or cannot be read.
    """
    splats, scaffold = run.splats_file, run.scaffold_file
    told = navmesh_json(build_navmesh(run.plan, run.objects, run.navigation), run.rooms)
    world = world_record(run, told)
    return {
        **_files(_PACKAGE / "page"),
        **{f"vendor/{name}": path for name, path in _files(_PACKAGE / "vendor").items()},
        "index.html": _index((_PACKAGE / "page" / "index.html").read_bytes()),
        "world.json": json.dumps(world, separators=(",", ":")).encode(),
        "navmesh.json": json.dumps(told, separators=(",", ":")).encode(),
        "splats.ply": splats,
        "scaffold.glb": scaffold,
    }


def write_site(site: Site, folder: pathlib.Path) -> None:
    """Writes a site into a new or empty folder, or over one that was written before.

    Raises:
      SiteError: the folder holds something else.
      OSError: it cannot be written.
    """
    if folder.exists() and not folder.is_dir():
        raise SiteError(f"{folder}: is a file; give a folder")
    present = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()} if folder.exists() else set()
    strange = sorted(present - set(site))
    if strange:
        raise SiteError(f"{folder}: holds other files, such as {strange[0]}; give a new or empty folder")
    for name, content in site.items():
        write_atomically(folder / name, content if isinstance(content, bytes) else content.read_bytes())


def _files(folder: pathlib.Path) -> dict[str, bytes | pathlib.Path]:
    return {path.relative_to(folder).as_posix(): path for path in sorted(folder.rglob("*")) if path.is_file()}


def _index(page: bytes) -> bytes:
    """The page, whose policy names the import map by its digest: the one script that stands in the page itself."""
    found = _IMPORT_MAP.search(page)
    assert found is not None
    return page.replace(b"IMPORTMAP", base64.b64encode(hashlib.sha256(found[1]).digest()))
