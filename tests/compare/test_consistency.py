"""Laws of the figures: a rigid scene is consistent, whatever its unit, and each flaw moves the figure that is named after it."""

import dataclasses

import numpy as np
import pytest

from wm.compare.agreement import agreement
from wm.compare.axes import UP, upright
from wm.compare.consistency import DrawnFrame, consistency, frame_of, means
from wm.compare.measuring import figures_of
from wm.compare.painted_mesh import PaintedMesh, see
from wm.geometry.exchange.parts import MeshPart, Paint
from wm.geometry.rays.pinhole import make_camera
from wm.geometry.rays.raycast import build_ray_scene
from wm.types import Camera, Mesh

WIDTH, HEIGHT = 96, 64


def room(scale: float = 1.0) -> PaintedMesh:
    """A box of 4 x 4 x 3 seen from inside, every wall with a smooth picture."""
    corners = scale * np.array([[x, y, z] for x in (-2, 2) for y in (-2, 2) for z in (0, 3)], np.float64)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))])
    grid = np.linspace(0, 2 * np.pi * 3, 256, endpoint=False)
    waves = np.stack(np.meshgrid(np.sin(grid), np.cos(grid)), -1)
    image = np.round(127 + 120 * np.concatenate([waves, waves[..., :1] * waves[..., 1:]], -1)).astype(np.uint8)
    uv = np.tile(np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], np.float64), (6, 1, 1))
    part = MeshPart(corners=corners[faces], paint=Paint("walls", np.ones(3), image=image), corner_uv=uv)
    mesh = Mesh.from_triangles(corners[faces].reshape(-1, 3), np.arange(36).reshape(-1, 3), face_object=0)
    return PaintedMesh(rays=build_ray_scene(mesh), parts=(part,), start=np.array([0]))


def walk(frames: int = 13, scale: float = 1.0) -> list[Camera]:
    eyes = scale * np.linspace([-0.8, -0.6, 1.5], [0.2, 0.6, 1.5], frames)
    ahead = scale * np.array([2.0, 0.5, 1.4])
    return [make_camera(eye, ahead, width=WIDTH, height=HEIGHT, fov_deg=60.0) for eye in eyes]


def unchanged(values: np.ndarray, k: int) -> np.ndarray:
    return values


def drawn(scale: float = 1.0, *, rgb=unchanged, depth=unchanged) -> list[DrawnFrame]:
    """The frames of a walk, with what each rendered picture or depth is changed to."""
    mesh = room(scale)
    renders = [(camera, see(mesh, camera)) for camera in walk(scale=scale)]
    return [frame_of(camera, rgb(seen.rgb, k), depth(seen.depth, k), seen.alpha) for k, (camera, seen) in enumerate(renders)]


@pytest.mark.parametrize("scale", [1.0, 1000.0, 0.01])
def test_a_rigid_scene_is_consistent_in_any_unit(scale):
    found = figures_of(drawn(scale))
    assert found["warp_explained"] > 0.85
    assert found["warp_depth"] < 2e-3
    assert found["warp_lost"] == 0
    assert found["holes"] == 0
    assert found["reproj_absrel"] < 2e-3
    assert found["reproj_agreeing"] > 0.98
    assert found["reproj_depth"] == pytest.approx(scale * figures_of(drawn())["reproj_depth"], rel=1e-4)


def test_equal_frames_from_one_place_are_all_explained_by_any_depth():
    frame = drawn()[0]
    found = consistency(frame, frame, stride=1)
    assert found.color == pytest.approx(0, abs=1e-6)
    assert found.depth == pytest.approx(0, abs=1e-4 * found.pixels)


def test_depths_that_flicker_cost_depth_and_agreement():
    flickering = figures_of(drawn(depth=lambda depth, k: depth * (1 + 0.02 * (-1) ** (k // 4))))
    good = figures_of(drawn())
    assert flickering["warp_depth"] == pytest.approx(0.04, abs=0.01)
    assert flickering["reproj_absrel"] > 10 * good["reproj_absrel"]


def test_depths_that_are_wrong_in_every_frame_do_not_explain_the_colours():
    assert figures_of(drawn(depth=lambda depth, k: 0.5 * depth))["warp_explained"] < 0.5


def test_colours_that_change_with_the_view_are_not_explained():
    changing = figures_of(drawn(rgb=lambda rgb, k: np.clip(rgb + 0.2 * (-1) ** (k // 4), 0, 1)))
    good = figures_of(drawn())
    assert changing["warp_color"] > good["warp_color"] + 0.1
    assert changing["warp_explained"] < good["warp_explained"]
    assert changing["warp_depth"] == pytest.approx(good["warp_depth"], rel=1e-6)


def test_blur_does_not_pass_for_consistency():
    """Without detail the raw difference of colours falls; the share that depths explain does not."""
    pale = figures_of(drawn(rgb=lambda rgb, k: 0.5 + 0.1 * (rgb - 0.5)))
    good = figures_of(drawn())
    assert pale["warp_color"] < 0.2 * good["warp_color"]
    assert pale["warp_explained"] == pytest.approx(good["warp_explained"], abs=0.01)


def test_what_hangs_in_the_air_of_one_frame_is_lost_in_the_next():
    def floater(depth: np.ndarray, k: int) -> np.ndarray:
        out = depth.copy()
        if k % 8 < 4:
            out[20:40, 30:60] *= 0.5
        return out

    lost = figures_of(drawn(depth=floater))["warp_lost"]
    assert lost > 0.02


def test_a_pixel_without_gaussians_is_a_hole_and_no_error():
    frames = [dataclasses.replace(frame, depth=np.where(np.arange(WIDTH) < WIDTH // 2, 0, frame.depth)) for frame in drawn()]
    found = figures_of(frames)
    assert found["warp_depth"] < 2e-3
    assert frame_of(frames[0].camera, frames[0].rgb, frames[0].depth, np.zeros((HEIGHT, WIDTH))).holes == 1


def test_frames_that_share_nothing_have_no_figure():
    eyes = [(np.array([-1.0, 0, 1.5]), np.array([-2.0, 0, 1.5])), (np.array([1.0, 0, 1.5]), np.array([2.0, 0, 1.5]))]
    mesh = room()
    cameras = [make_camera(eye, target, width=WIDTH, height=HEIGHT, fov_deg=40.0) for eye, target in eyes]
    frames = [
        frame_of(camera, *(np.asarray(getattr(see(mesh, camera), name)) for name in ("rgb", "depth", "alpha")))
        for camera in cameras
    ]
    assert agreement(frames) is None
    assert means([consistency(*frames)]) == {}


@pytest.mark.parametrize("name", UP)
def test_upright_is_a_rotation_that_brings_the_axis_to_z(name):
    rotation = upright(UP[name])
    np.testing.assert_allclose(rotation @ UP[name], [0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1)
