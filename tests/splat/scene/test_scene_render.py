"""Laws of the renderer of many rooms: it is `render` of those it is told to look into, whatever it was asked before."""

import jax
import numpy as np
import pytest

from tests.splat.rooms import views_of
from tests.splat.scenes import camera, cloud
from wm.schema import FitSettings, RasterSettings
from wm.splat import SceneRenderer, initial_gaussians, render
from wm.types import Gaussians

RASTER = RasterSettings(chunk=1, block=16)
ROOMS: list[Gaussians] = [jax.tree.map(np.float32, cloud(n, seed=n)) for n in (24, 9, 24, 24)]
VIEW = camera()


def together(rooms) -> Gaussians:
    return jax.tree.map(lambda *leaves: np.concatenate(leaves), *(ROOMS[room] for room in rooms))


def raw(image):
    return [np.asarray(leaf).tobytes() for leaf in jax.tree.leaves(image)]


@pytest.mark.parametrize("rooms", [[0], [1, 2], [0, 1, 2, 3]])
def test_it_is_the_render_of_the_rooms_it_looks_into(rooms):
    found, expected = SceneRenderer(ROOMS, RASTER).render(VIEW, rooms), render(together(rooms), VIEW, settings=RASTER)
    for a, b in zip(jax.tree.leaves(found), jax.tree.leaves(expected), strict=True):
        assert isinstance(a, np.ndarray)
        np.testing.assert_allclose(a, b, atol=2e-6)


def test_what_it_rendered_before_changes_no_byte():
    """Padded sizes have grown in between, of what is visible and of the plan."""
    renderer, fresh = SceneRenderer(ROOMS, RASTER), SceneRenderer(ROOMS, RASTER)
    first, columns = renderer.render(VIEW, [1]), renderer._columns
    large = renderer.render(VIEW, [0, 1, 2, 3])
    assert renderer._columns > columns
    assert raw(renderer.render(VIEW, [1])) == raw(first)
    assert raw(fresh.render(VIEW, [0, 1, 2, 3])) == raw(large)


def test_the_scaffold_hides_what_is_behind_it_and_nothing_on_it():
    settings, views = FitSettings(spacing=0.4, detail_spacing=0.4), views_of()
    room, view = initial_gaussians(views, settings=settings, rng=np.random.default_rng(0)), views[0]
    renderer = SceneRenderer([room], RASTER)
    plain = renderer.render(view.camera, [0])
    assert plain.alpha.mean() > 0.9
    for depth in (view.depth, view.depth[::4, ::4]):
        assert raw(renderer.render(view.camera, [0], depth)) == raw(plain)
    small = SceneRenderer([room.replace(log_scales=room.log_scales - 2)], RASTER)
    hidden, shown = (small.render(view.camera, [0], depth).alpha.sum() for depth in (0.2 * view.depth, view.depth))
    assert hidden < 0.3 * shown


@pytest.mark.parametrize("rooms", [[], [cloud(0)], ROOMS], ids=["none", "an empty one", "none of them seen"])
def test_without_gaussians_it_is_black(rooms):
    image = SceneRenderer(rooms, RASTER).render(VIEW, range(len(rooms)) if rooms is not ROOMS else [])
    assert image.rgb.shape == (VIEW.height, VIEW.width, 3) and image.depth.shape == image.alpha.shape == (VIEW.height, VIEW.width)
    assert not any(leaf.any() for leaf in jax.tree.leaves(image))
