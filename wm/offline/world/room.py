"""The appearance of one room: its surfaces are dressed, its light is baked, and both are put together into textures."""

import dataclasses
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from wm.geometry.plan.footprint import interior_polygon
from wm.geometry.plan.openings import portals
from wm.geometry.plan.records import FloorPlan
from wm.geometry.plan.site import WallOpening, wall_opening
from wm.geometry.rays.raycast import RayScene
from wm.offline.arrangement.room_type import finish_type, room_type
from wm.offline.style.finish import Style
from wm.offline.style.requests import surfaces_in
from wm.offline.world.light import (
    BakeSettings,
    LightPoints,
    Probes,
    RoomCharts,
    Sources,
    build_facets,
    build_probes,
    ceiling_emitters,
    in_free_air,
    lamp_emitters,
    luxel_positions,
    pane_emitters,
    room_charts,
    soften,
)
from wm.offline.world.light.bake import bake
from wm.offline.world.light.facets import Facets
from wm.offline.world.pieces import SPECULAR, Pieces, build_pieces, mean_albedo
from wm.offline.world.pyramid import Pyramid, build_pyramid
from wm.offline.world.surfaces import Chart, Interior, TexelSheet, dress
from wm.offline.world.tone import tone
from wm.synth.room_names import room_sort
from wm.synth.seeds import room_number
from wm.types import OUTSIDE, SceneObject, SurfaceKind

PER_CELL = 6
"""Fine texels along a side of a light point's cell: 1 cm texels for 6 cm cells."""


@dataclasses.dataclass(frozen=True, eq=False)
class BakedRoom:
    """What a renderer needs to know of a room."""

    room: int
    charts: RoomCharts
    textures: Pyramid  # finished colour of each chart, sRGB
    facet_faces: np.ndarray  # [f] int32 scene face -> row of `facets` and `pieces`, -1
    facets: Facets
    pieces: Pieces
    light: np.ndarray  # [p, 6] float32 at the objects' light points: e, then mirrored radiance
    environment: np.ndarray  # [h, w, 3] float32 what the middle of the room sees: what polished objects reflect
    eye: np.ndarray  # [3] float32 that middle


def bake_room(
    scene: RayScene, plan: FloorPlan, room: int, objects: tuple[SceneObject, ...], style: Style,
    *, sun: np.ndarray, seeds: tuple[int, int], settings: BakeSettings,
) -> BakedRoom:  # fmt: skip
    """Dress and light one room of a scene whose mesh is `assemble_scene(structure, objects)`.

    Args:
      seeds: of the finish and of the light.
    """
    interior = _interior(plan, room, style, seeds[0])
    charts = room_charts(scene.mesh, room, settings.cell)
    spans = [_chart(charts, k, settings.cell / PER_CELL) for k in range(len(charts.atlas.chart_start))]
    with ThreadPoolExecutor(2) as pool:
        sheets = list(pool.map(lambda chart: dress(chart, _openings(plan, room, chart), interior), spans))
    pieces, facets, facet_faces = _objects(scene, room, objects, style, interior.seed, settings)
    probes = build_probes(
        facets, in_free_air(scene, facets.position, facets.normal), spacing=settings.probe_spacing, budget=settings.probes
    )
    points = _light_points(charts, sheets, pieces, facets, facet_faces, probes)
    light = style.light
    sources = Sources(
        panes=pane_emitters(scene.mesh, room, light),
        lamps=lamp_emitters(objects, room, light) or ceiling_emitters(interior.polygon, interior.height, light),
        sun=sun,
        sun_light=soften(light.sun_color) * np.float32(5.0 * light.sun_strength),
        day=0.3 + 0.4 * light.sky_strength + 0.2 * light.sun_strength,
        evening=light.lamp_strength,
        mood=0.85 + 0.2 * (light.sky_strength + light.sun_strength),
    )
    middle = np.append(interior.polygon.mean(axis=0), min(1.6, 0.6 * interior.height))
    field = bake(scene, points, sources, eye=middle, seed=_room_seed(plan, room, seeds[1]), settings=settings)
    baked = [field.irradiance, field.bend, field.mirror]
    with ThreadPoolExecutor(2) as pool:
        images = list(pool.map(lambda k: _shade(charts, k, sheets[k], spans[k], baked), range(len(spans))))
    first = len(charts.atlas.inside)
    return BakedRoom(
        room=room, charts=charts, textures=build_pyramid(images, settings.cell / PER_CELL),
        facet_faces=facet_faces, facets=facets, pieces=pieces,
        light=probes.mix @ np.concatenate([field.irradiance[first:], field.mirror[first:]], axis=1),
        environment=field.environment, eye=middle.astype(np.float32),
    )  # fmt: skip


def bake_settings(texel_size: float) -> BakeSettings:
    """How fine to bake for surfaces of this texel size: the light's cells follow it, the number of rays falls slowly.

    Raises:
      ValueError: the texel size is not a positive length.
    """
    if not (np.isfinite(texel_size) and texel_size > 0):
        raise ValueError(f"image.texel_size must be a positive number of metres, got {texel_size}")
    default = BakeSettings()
    ratio = texel_size * PER_CELL / default.cell
    return dataclasses.replace(
        default,
        cell=texel_size * PER_CELL,
        probe_spacing=default.probe_spacing * max(ratio, 1.0) ** 0.5,
        probes=max(2000, int(default.probes / max(ratio, 1.0))),
        rays=max(32, int(default.rays / max(ratio, 1.0) ** 0.5)),
    )


def _interior(plan: FloorPlan, room: int, style: Style, seed: int) -> Interior:
    name = plan.rooms[room].name
    kind = finish_type(room_type(name))
    return Interior(
        name=name,
        kind=kind,
        polygon=np.asarray(interior_polygon(plan, room).exterior.coords)[:-1],
        height=plan.rooms[room].ceiling_height,
        style=style,
        surfaces=surfaces_in(style, room_sort(name), kind),
        seed=_room_seed(plan, room, seed),
    )


def _room_seed(plan: FloorPlan, room: int, seed: int) -> int:
    """Small enough to be added to within float32."""
    return int(np.random.SeedSequence([seed, room_number(plan, room)]).generate_state(1)[0] % 100003)


def _chart(charts: RoomCharts, number: int, texel: float) -> Chart:
    atlas = charts.atlas
    rows, columns = (int(k) * PER_CELL for k in atlas.chart_shape[number])
    return Chart(
        kind=SurfaceKind(int(atlas.chart_kind[number])),
        origin=atlas.chart_origin[number],
        u=atlas.chart_u[number],
        v=atlas.chart_v[number],
        normal=atlas.chart_normal[number],
        shape=(rows, columns),
        texel=texel,
    )


def _openings(plan: FloorPlan, room: int, chart: Chart) -> tuple[WallOpening, ...]:
    """The openings of a room that lie in a wall chart's plane, in its own metres."""
    if chart.kind != SurfaceKind.WALL:
        return ()
    openings = []
    for portal in portals(plan):
        if room not in portal.rooms:
            continue
        off = (portal.ends - chart.origin[:2]) @ chart.normal[:2]
        if np.ptp(off) < 0.02 and -0.5 < off.mean() < 0.05:
            openings.append(
                wall_opening(portal.kind, portal.ends, portal.sill, portal.head, start=chart.origin[:2], direction=chart.u[:2])
            )
    return tuple(openings)


def _objects(
    scene: RayScene, room: int, objects: tuple[SceneObject, ...], style: Style, seed: int, settings: BakeSettings
) -> tuple[Pieces, Facets, np.ndarray]:
    mesh = scene.mesh
    mine = [k for k, thing in enumerate(objects) if thing.room == room]
    faces = np.flatnonzero((mesh.face_object != OUTSIDE) & (mesh.face_room == room))
    facet_faces = np.full(len(mesh.faces), -1, np.int32)
    facet_faces[faces] = np.arange(len(faces), dtype=np.int32)
    pieces = build_pieces([objects[k] for k in mine], style, seed=seed)
    return pieces, build_facets(mesh.vertices, mesh.faces[faces], spacing=settings.spacing), facet_faces


def _light_points(
    charts: RoomCharts, sheets: list[TexelSheet], pieces: Pieces, facets: Facets, facet_faces: np.ndarray, probes: Probes
) -> LightPoints:
    atlas = charts.atlas
    texels = len(atlas.inside)
    albedo, glow = np.zeros((texels, 3), np.float32), np.zeros((texels, 3), np.float32)
    for number, sheet in enumerate(sheets):
        start, shape = int(atlas.chart_start[number]), atlas.chart_shape[number]
        part = slice(start, start + int(shape.prod()))
        albedo[part] = _cell_means(sheet.albedo, shape)
        if sheet.emission is not None:
            glow[part] = _cell_means(sheet.emission, shape)
    charts_of = np.repeat(np.arange(len(sheets)), atlas.chart_shape.prod(axis=1))
    return LightPoints(
        charts=charts,
        facets=facets,
        probes=probes,
        facet_faces=facet_faces,
        position=np.concatenate([luxel_positions(charts), probes.position]),
        normal=np.concatenate([atlas.chart_normal[charts_of], probes.normal]),
        albedo=np.concatenate([albedo, mean_albedo(pieces, probes.face)]),
        glow=np.concatenate([glow, pieces.glow[probes.face]]),
        live=np.concatenate([atlas.inside, np.ones(len(probes.position), bool)]),
    )


def _cell_means(image: np.ndarray, shape: np.ndarray) -> np.ndarray:
    """[rows * columns, 3] mean of a fine image [3, h, w] over each coarse cell."""
    rows, columns = (int(k) for k in shape)
    return image.reshape(3, rows, PER_CELL, columns, PER_CELL).mean(axis=(2, 4)).reshape(3, -1).T


def _shade(charts: RoomCharts, number: int, sheet: TexelSheet, chart: Chart, baked: list[np.ndarray]) -> np.ndarray:
    """[h, w, 3] sRGB: the sheet under the baked light, its relief lit from where the light comes."""
    atlas = charts.atlas
    rows, columns = (int(k) for k in atlas.chart_shape[number])
    start = int(atlas.chart_start[number])
    e, bend, mirror = (_upsampled(values[start : start + rows * columns].reshape(rows, columns, 3)) for values in baked)
    gloss = np.clip(1 - sheet.roughness, 0, 1)[..., None] ** 2
    reflected = sheet.metallic * np.moveaxis(sheet.albedo, 0, 2) + (1 - sheet.metallic) * SPECULAR * (
        np.float32(0.3) + np.float32(3.0) * gloss
    )
    if np.any(sheet.height):
        down, across = np.gradient(sheet.height, chart.texel)
        slope = np.clip(across, -1.2, 1.2)[..., None] * chart.u + np.clip(down, -1.2, 1.2)[..., None] * chart.v
        e = e * np.clip(1 - np.sum(bend * slope, axis=2, keepdims=True), 0.35, 1.8)
    radiance = np.moveaxis(sheet.albedo, 0, 2) * np.float32(1 - sheet.metallic) * e + reflected * mirror
    if sheet.emission is not None:
        radiance = radiance + np.moveaxis(sheet.emission, 0, 2)
    return tone(radiance.astype(np.float32))


def _upsampled(image: np.ndarray) -> np.ndarray:
    """Bilinear, from a cell's centre to its PER_CELL x PER_CELL fine texels."""

    def along(values: np.ndarray) -> np.ndarray:
        n = len(values)
        place = np.clip((np.arange(n * PER_CELL) + 0.5) / PER_CELL - 0.5, 0, n - 1)
        low = np.minimum(place.astype(np.int64), max(n - 2, 0))
        part = (place - low).astype(np.float32)[:, None, None]
        return values[low] * (1 - part) + values[np.minimum(low + 1, n - 1)] * part

    return along(along(image).swapaxes(0, 1)).swapaxes(0, 1)
