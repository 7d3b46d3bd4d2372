"""A whole comparison: every method on every trajectory, what is stored already left out."""

import dataclasses
import pathlib
from collections.abc import Mapping, Sequence

from wm.artifacts.atomic import write_atomically
from wm.artifacts.digests import digest, file_digest, json_text
from wm.compare import agreement, consistency
from wm.compare.adapters.registry import ADAPTERS, identity_of, read_scene
from wm.compare.drawing import Drawer, drawer_of
from wm.compare.measuring import VERSION, measure
from wm.compare.records import ComparedScene, Source
from wm.compare.store import Store
from wm.compare.table import Figures, MethodRow, as_csv, as_json, markdown, summary
from wm.compare.trajectories import Picture, Trajectory, read_file
from wm.compare.trajectories_foreign import ForeignPaths
from wm.compare.trajectories_ours import RunPaths
from wm.quality import Quality, open_quality
from wm.stages.progress import Progress, progress

TABLE = "comparison.md"
_CONSTANTS = (VERSION, consistency.STEP, consistency.STRIDE, consistency.OCCLUSION, agreement.APART, agreement.STRIDE)


@dataclasses.dataclass(frozen=True)
class ComparisonRequest:
    """What a comparison is asked for."""

    sources: tuple[Source, ...]
    trajectories: tuple[str, ...]  # names, or one path of a file of cameras that all methods share
    output: pathlib.Path
    picture: Picture
    quality: str | None = None  # weights of wm.quality, by which frames are scored

    @property
    def shared(self) -> pathlib.Path | None:
        """The file of cameras for all methods, if there is one."""
        one = self.trajectories[0]
        return pathlib.Path(one) if len(self.trajectories) == 1 and one.endswith(".json") else None


def compare(request: ComparisonRequest) -> str:
    """Measures what is not measured yet, writes the table in three forms, and returns it in Markdown. Raises: InputError."""
    store = Store(request.output)
    quality = None if request.quality is None else open_quality(request.quality)
    keys = {source.method: _keys(request, source, quality) for source in request.sources}  # wrong files are told before long work
    wanted = [(source, [name for name, key in keys[source.method].items() if store.known(source.method, name, key) is None])
              for source in request.sources]  # fmt: skip
    total = sum(len(names) for _, names in wanted) * request.picture.frames
    with progress("compare", total) as bar:
        for source, names in wanted:
            if names:
                _measure_all(request, store, source, {name: keys[source.method][name] for name in names}, quality, bar)
    return _write(request, store, keys)


def _keys(request: ComparisonRequest, source: Source, quality: Quality | None) -> dict[str, str]:
    """The key of each trajectory of a source, by the trajectory's name."""
    scene = digest(identity_of(source), None if quality is None else quality.identity)
    if request.shared is not None:
        shared = request.shared
        trajectory = read_file(shared, request.picture)
        return {trajectory.name: digest(scene, file_digest(shared), request.picture, *_CONSTANTS)}
    return {name: digest(scene, name, request.picture, *_CONSTANTS) for name in request.trajectories}


def _measure_all(
    request: ComparisonRequest, store: Store, source: Source, keys: Mapping[str, str], quality: Quality | None, bar: Progress
) -> None:
    scene = read_scene(source)
    draw = drawer_of(scene)
    for trajectory in _trajectories(request, scene, draw, list(keys)):
        bar.set_postfix_str(f"{source.method} {trajectory.name}")
        figures = measure(trajectory, draw, store, source.method, request.picture, done=bar.update, quality=quality)
        store.keep(source.method, trajectory.name, keys[trajectory.name], figures)


def _trajectories(request: ComparisonRequest, scene: ComparedScene, draw: Drawer, names: Sequence[str]) -> list[Trajectory]:
    """All of a scene's paths, before the first is rendered: it may lack one. One survey of the scene serves all."""
    if request.shared is not None:
        return [read_file(request.shared, request.picture)]
    paths = RunPaths(scene.run, request.picture) if scene.run is not None else ForeignPaths(scene, draw, request.picture)
    return [paths.path(name) for name in names]


def _write(request: ComparisonRequest, store: Store, keys: Mapping[str, Mapping[str, str]]) -> str:
    measured: dict[str, dict[str, Figures]] = {}
    for source in request.sources:
        own = keys[source.method]
        measured[source.method] = {name: store.known(source.method, name, key) or {} for name, key in own.items()}
    rows = [
        MethodRow(source.method, source.adapter, ADAPTERS[source.adapter].SYSTEM, summary(list(measured[source.method].values())))
        for source in request.sources
    ]
    table = markdown(rows)
    write_atomically(request.output / TABLE, table)
    write_atomically(request.output / "comparison.csv", as_csv(rows))
    write_atomically(request.output / "comparison.json", json_text(as_json(rows, measured)))
    return table
