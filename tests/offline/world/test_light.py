"""Laws of the light bake: energy, positivity, continuity of the storage, little noise, nothing through walls."""

import dataclasses

import numpy as np
import pytest

from tests.offline.world.boxes import COARSE, box, furnished
from wm.color import LUMINANCE
from wm.geometry import build_structure
from wm.geometry.mesh.scene_mesh import assemble_scene
from wm.geometry.rays.raycast import build_ray_scene
from wm.offline.style.theme import style_of
from wm.offline.world.light import (
    BakeSettings,
    LightPoints,
    Sources,
    build_facets,
    build_probes,
    facet_weights,
    luxel_positions,
    pane_emitters,
    room_charts,
    sun_direction,
)
from wm.offline.world.light.bake import bake
from wm.offline.world.light.transport import directions_about, traced


def points_of(scene, room, *, albedo, glow=0.0, settings=COARSE):
    charts = room_charts(scene.mesh, room, settings.cell)
    facets = build_facets(np.zeros((0, 3)), np.zeros((0, 3), np.int32), spacing=1.0)
    n = len(charts.atlas.inside)
    number = np.repeat(np.arange(len(charts.atlas.chart_start)), charts.atlas.chart_shape.prod(axis=1))
    return LightPoints(
        charts=charts,
        facets=facets,
        probes=build_probes(facets, np.zeros(0, bool), spacing=1.0, budget=10),
        facet_faces=np.full(len(scene.mesh.faces), -1, np.int32),
        position=luxel_positions(charts),
        normal=charts.atlas.chart_normal[number],
        albedo=np.full((n, 3), albedo, np.float32),
        glow=np.full((n, 3), glow, np.float32),
        live=charts.atlas.inside,
    )


@pytest.fixture(scope="module")
def scene():
    return build_ray_scene(furnished().structure)


def lit(scene, *, albedo=0.5, seed=0, settings: BakeSettings = COARSE):
    light = style_of("gothic").light
    points = points_of(scene, 0, albedo=albedo, settings=settings)
    sources = Sources(
        panes=pane_emitters(scene.mesh, 0, light), lamps=[], sun=sun_direction(scene.mesh, light),
        sun_light=np.array([1.0, 0.9, 0.8], np.float32), day=0.8, evening=0.0,
    )  # fmt: skip
    field = bake(scene, points, sources, eye=np.array([1.7, 1.4, 1.6]), seed=seed, settings=settings)
    return points, field


def test_irradiance_is_finite_and_positive(scene):
    points, field = lit(scene)
    for values in (field.irradiance, field.bend, field.mirror):
        assert values.shape == (len(points.live), 3)
        assert np.isfinite(values).all()
    assert field.irradiance.min() > 0
    assert field.mirror.min() >= 0


def test_same_seed_same_bytes_and_other_seed_little_difference(scene):
    points, a = lit(scene)
    _, again = lit(scene)
    _, other = lit(scene, seed=1)
    np.testing.assert_array_equal(a.irradiance, again.irradiance)
    # Points in the sun's sharp edge differ by the jitter of two rays; the rest is smooth.
    e, f = (field.irradiance[points.live] @ LUMINANCE for field in (a, other))
    assert np.median(np.abs(e - f)) < 0.06 * e.mean()


def test_white_furnace_stays_within_its_energy(scene):
    """A closed, glowing room of albedo a and radiance 1: every bounce adds a^k, and the series never exceeds 1 / (1 - a)."""
    points = points_of(scene, 1, albedo=0.5, glow=1.0)
    live = np.flatnonzero(points.live)
    hits, _, _, _ = traced(scene, points, live, 64, 0)
    table = np.ones((len(points.live) + 1, 1), np.float32)
    e = np.zeros_like(table)
    for _ in range(12):
        e[live] = (table + 0.5 * e)[hits].mean(axis=1)
        e[-1] = e[live].mean()
    assert e[live].max() <= 2.0 + 1e-5
    assert e[live].min() > 1.9


def test_directions_are_cosine_weighted():
    """The mean of cosine-weighted unit vectors is 2/3 of the normal."""
    normal = np.random.default_rng(0).normal(size=(50, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    directions = directions_about(normal, np.arange(50), 256, 0)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=2), 1, atol=1e-5)
    np.testing.assert_allclose(directions.mean(axis=1), 2 / 3 * normal, atol=0.03)


def test_a_room_without_window_or_door_to_light_stays_dark(scene):
    """Sources of the first room reach the second only through the door: beside the door's wall it is nearly dark."""
    light = style_of("gothic").light
    points = points_of(scene, 1, albedo=0.2)
    sealed = [dataclasses.replace(e, radiance=e.radiance * 0) for e in pane_emitters(scene.mesh, 0, light)]
    sources = Sources(
        panes=sealed, lamps=[], sun=np.array([0.0, 0.6, 0.8]), sun_light=np.zeros(3, np.float32), day=0.5, evening=0.0
    )
    eye = np.array([4.4, 1.4, 1.6])
    field = bake(scene, points, sources, eye=eye, seed=0, settings=dataclasses.replace(COARSE, ambient=0.0))
    assert field.irradiance.max() == 0


def test_facet_weights_are_linear_and_continuous():
    """Interpolating the points' own coordinates gives the hit's place, on every small triangle."""
    thing = box("box", (0, 0, 0), (1.3, 0.4, 0.9), "wood")
    facets = build_facets(thing.vertices, thing.faces, spacing=0.25)
    rng = np.random.default_rng(3)
    uv = rng.random((500, 2)).astype(np.float32)
    uv = np.where(uv.sum(axis=1, keepdims=True) > 1, 1 - uv, uv)
    face = rng.integers(0, 12, 500)
    corners, weights = facet_weights(facets, face, uv)
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-5)
    assert weights.min() >= 0
    mixed = np.einsum("nk,nki->ni", weights, facets.position[corners])
    a, b, c = (thing.vertices[thing.faces[face, k]] for k in range(3))
    exact = (1 - uv[:, :1] - uv[:, 1:]) * a + uv[:, :1] * b + uv[:, 1:] * c
    assert np.abs(mixed - exact).max() < 0.05  # points are drawn inwards a little
    np.testing.assert_allclose(facets.normal[corners[:, 0]], facets.normal[corners[:, 1]], atol=1e-6)  # a box has creases only


def test_probes_mix_to_one_and_never_across_a_crease():
    thing = box("box", (0, 0, 0), (1.0, 0.6, 0.8), "wood")
    facets = build_facets(thing.vertices, thing.faces, spacing=0.1)
    probes = build_probes(facets, np.ones(len(facets.position), bool), spacing=0.3, budget=1000)
    assert len(probes.position) < len(facets.position)
    for matrix in (probes.mix, probes.average):
        np.testing.assert_allclose(np.asarray(matrix.sum(axis=1)).ravel(), 1, atol=1e-5)
    np.testing.assert_allclose(probes.normal[probes.nearest], facets.normal, atol=1e-6)
    few = build_probes(facets, np.ones(len(facets.position), bool), spacing=0.3, budget=12)
    assert len(few.position) <= 12


def test_the_sun_shines_into_the_window():
    context = furnished()
    direction = sun_direction(build_structure(context.plan), style_of("gothic").light)
    assert np.linalg.norm(direction) == pytest.approx(1)
    assert direction[1] < 0  # the only window looks towards -y
    assert direction[2] > 0


def test_objects_of_other_rooms_cast_no_light_points():
    context = furnished()
    mesh = assemble_scene(context.structure, context.objects)
    charts = room_charts(mesh, 1, 0.2)
    assert set(mesh.face_room[charts.face_slot >= 0]) == {1}
