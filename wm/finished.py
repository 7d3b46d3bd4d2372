"""A finished run, read back: its plan, furniture, scaffold, cameras and gaussians as the records that functions take.

This is what exporters, the viewer and comparisons start from. Nothing is written and nothing is made again that the folder holds;
parts are read when they are first asked for.
"""

import dataclasses
import functools
import pathlib
from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np
from jaxtyping import Int

from wm import codecs
from wm.artifacts.confined import confined
from wm.artifacts.digests import digest
from wm.artifacts.manifest import Manifest, ManifestDamage, read_manifest
from wm.errors import InputError
from wm.geometry import FloorPlan, RayScene, assemble_scene, build_ray_scene, build_structure, load_cameras
from wm.geometry.plan.loading import stored_plan
from wm.schema import CameraSettings, NavigationSettings, RasterSettings
from wm.stages.arranged import arranged
from wm.stages.painting import SCAFFOLD
from wm.stages.reconstruction import BY_ROOM, SPLATS, is_visible, split_rooms, visible_gaussians
from wm.stages.scene import CAMERAS, HELDOUT_CAMERAS, OBJECT_ARRAYS, OBJECTS, PLAN
from wm.types import Gaussians, Mesh, SceneObject, View

_Settings = TypeVar("_Settings", RasterSettings, CameraSettings, NavigationSettings)


class UnfinishedRunError(InputError):
    """A folder that holds no run, or not yet what is asked of it; the message says which and what to do."""


@dataclasses.dataclass(frozen=True, eq=False)
class FinishedRun:
    """A run folder and what is in it. Use `open_finished`."""

    folder: pathlib.Path
    manifest: Manifest

    @property
    def config(self) -> Mapping[str, Any]:
        """The configuration that the run was made with, as nested dictionaries. Secrets and paths are shown, not held."""
        return self.manifest.header.get("config") or {}

    @property
    def theme(self) -> str:
        return str((self.config.get("scene") or {}).get("theme", ""))

    def key(self, *stages: str) -> str:
        """A digest of what the run's stages have made: equal keys, equal content. All entries without arguments."""
        entries = self.manifest.entries
        told = {name: entry["key"] for name, entry in entries.items() if not stages or name.split("/")[0] in stages}
        return digest("finished", sorted(told.items()))

    def file(self, name: str) -> pathlib.Path:
        """The path of a file that the run must hold. Raises: UnfinishedRunError, ArtifactError."""
        path = confined(self.folder, name)
        if not path.is_file():
            raise UnfinishedRunError(f"{self.folder}: no {name} is there (yet); run it to its end first")
        return path

    @functools.cached_property
    def plan(self) -> FloorPlan:
        return stored_plan(self.file(PLAN))

    @property
    def rooms(self) -> list[str]:
        """The ids of the rooms; indices of rooms count in this list."""
        return [room.id for room in self.plan.rooms]

    @functools.cached_property
    def objects(self) -> tuple[SceneObject, ...]:
        """The furniture, as `objects.json` arranges it. `Mesh.face_object` counts in this tuple."""
        if not (self.folder / OBJECT_ARRAYS).exists():
            return ()  # of an unfurnished run
        made = codecs.decode_objects(self.file(OBJECT_ARRAYS).read_bytes())
        path = self.file(OBJECTS)
        return arranged(made, path.read_bytes(), self.plan, str(path))

    @functools.cached_property
    def structure(self) -> Mesh:
        """The building without furniture: watertight, in metres, z up, with `face_room` and `face_kind`."""
        return build_structure(self.plan)

    @functools.cached_property
    def scaffold(self) -> Mesh:
        """Structure and furniture in one mesh."""
        return assemble_scene(self.structure, self.objects)

    @functools.cached_property
    def rays(self) -> RayScene:
        return build_ray_scene(self.scaffold)

    @property
    def scaffold_file(self) -> pathlib.Path:
        """The GLB with the painted texture."""
        return self.file(SCAFFOLD)

    @property
    def splats_file(self) -> pathlib.Path:
        return self.file(SPLATS)

    @functools.cached_property
    def views(self) -> tuple[View, ...]:
        """The training views; `room` counts in `rooms`."""
        return self._views(CAMERAS)

    @functools.cached_property
    def heldout(self) -> tuple[View, ...]:
        return self._views(HELDOUT_CAMERAS)

    @functools.cached_property
    def gaussians_by_room(self) -> tuple[Gaussians, ...]:
        """All fitted gaussians, also those that no program draws, by room: what `SceneRenderer` takes."""
        return split_rooms(codecs.decode_arrays(self.file(BY_ROOM).read_bytes()))

    @functools.cached_property
    def gaussians(self) -> Gaussians:
        """The visible gaussians of all rooms in order: those of `splats.ply`."""
        return visible_gaussians(self.gaussians_by_room)

    @functools.cached_property
    def gaussian_room(self) -> Int[np.ndarray, " n"]:
        """The room of each of `gaussians`, as an index into `rooms`."""
        return np.concatenate([np.full(int(is_visible(g).sum()), k) for k, g in enumerate(self.gaussians_by_room)])

    @functools.cached_property
    def raster(self) -> RasterSettings:
        """How the gaussians were fitted, and so are to be rendered."""
        return _settings(RasterSettings(), self.config.get("raster"))

    @functools.cached_property
    def cameras(self) -> CameraSettings:
        return _settings(CameraSettings(), self.config.get("cameras"))

    @functools.cached_property
    def navigation(self) -> NavigationSettings:
        return _settings(NavigationSettings(), self.config.get("navigation"))

    def _views(self, name: str) -> tuple[View, ...]:
        path = self.file(name)
        views, rooms = load_cameras(path), codecs.room_names(path.read_bytes())
        return tuple(dataclasses.replace(view, room=self.rooms.index(room)) for view, room in zip(views, rooms))


def open_finished(folder: str | pathlib.Path) -> FinishedRun:
    """Opens a run folder for reading. It need not be complete: what is asked of it later must be there.

    Raises:
      UnfinishedRunError: it holds no run.
      OSError: it cannot be read.
    """
    path = pathlib.Path(folder)
    if path.is_file():
        raise UnfinishedRunError(f"{path}: is a file; give the folder of a run, such as outputs/gothic/full/0")
    try:
        manifest = read_manifest(path)
    except ManifestDamage as error:
        raise UnfinishedRunError(f"{path}: its manifest.json is damaged ({error}); run it again") from error
    if manifest is None or not isinstance(manifest.header.get("config"), dict):
        raise UnfinishedRunError(f"{path}: no run is there; give the folder of one, such as outputs/gothic/full/0")
    return FinishedRun(folder=path, manifest=manifest)


def _settings(default: _Settings, told: Any) -> _Settings:
    """The record of a run's settings; keys that this version does not know are of no use to it."""
    known = {field.name for field in dataclasses.fields(default)}
    return dataclasses.replace(default, **{name: value for name, value in (told or {}).items() if name in known})
