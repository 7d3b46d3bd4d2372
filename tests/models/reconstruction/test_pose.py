"""Where a reconstructed object stands: by its model's pose, and by its outline and depth where the model says nothing."""

import dataclasses
import math

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from tests.synth.lifting.scenes import observations, piece
from wm.geometry.exchange.object_file import load_object
from wm.geometry.placement.upright_box import box_iou, box_of
from wm.geometry.rays.pinhole import make_camera
from wm.models.reconstruction.pose import ModelPose, fitted, posed
from wm.models.reconstruction.sam3d_objects_worker import UP, matrix_of, pose_of_glb

CAMERA = make_camera(np.array([0.5, 2.0, 1.6]), np.array([3.0, 2.0, 1.1]), width=64, height=48, fov_deg=90.0)
T_WORLD_CAM = np.linalg.inv(CAMERA.T_cam_world)
OF_GLB = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # y up to z up, as load_object turns a GLB


def glb_in_world(place: np.ndarray) -> ModelPose:
    """The pose of a GLB that stands upright at a place in the world, unturned and twice as large."""
    rotation = T_WORLD_CAM[:3, :3].T @ OF_GLB
    return ModelPose(scale=np.full(3, 2.0), rotation=rotation, translation=(CAMERA.T_cam_world @ np.append(place, 1))[:3])


def read(tmp_path, mesh: trimesh.Trimesh, label="chair"):
    mesh.export(tmp_path / "mesh.glb")
    return load_object(tmp_path / "mesh.glb", label=label, room=0)


def test_the_points_of_the_file_come_to_lie_where_the_model_says(tmp_path):
    mesh = trimesh.creation.box(bounds=[[-0.2, 0, -0.1], [0.3, 0.4, 0.15]])
    place = np.array([2.0, 1.0, 0.3])
    pose = glb_in_world(place)
    thing = posed(read(tmp_path, mesh), pose, CAMERA)
    in_camera = mesh.vertices * pose.scale @ pose.rotation.T + pose.translation
    wanted = in_camera @ T_WORLD_CAM[:3, :3].T + T_WORLD_CAM[:3, 3]
    np.testing.assert_allclose(*(sorted(np.round(one, 5).tolist()) for one in (thing.vertices, wanted)), atol=2e-5)
    np.testing.assert_allclose(
        [thing.vertices.min(axis=0), thing.vertices.max(axis=0)], [[1.6, 0.7, 0.3], [2.6, 1.2, 1.1]], atol=1e-6
    )
    np.testing.assert_allclose(thing.T_world_object[:3, :3], np.eye(3), atol=1e-6)
    np.testing.assert_allclose(thing.size, [1.0, 0.5, 0.8], atol=1e-6)


@given(st.floats(-0.2, 0.2), st.floats(-math.pi, math.pi))
def test_a_thing_that_leans_a_little_is_made_upright(tmp_path_factory, lean, turn):
    mesh = trimesh.creation.box(bounds=[[-0.2, 0, -0.1], [0.3, 0.4, 0.15]])
    upright = glb_in_world(np.array([2.0, 1.0, 0.3]))
    tilt = trimesh.transformations.rotation_matrix(lean, [1, 0, 0.3])[:3, :3]
    about = trimesh.transformations.rotation_matrix(turn, [0, 1, 0])[:3, :3]
    pose = ModelPose(upright.scale, upright.rotation @ tilt @ about, upright.translation)
    thing = posed(read(tmp_path_factory.mktemp("pose"), mesh), pose, CAMERA)
    np.testing.assert_allclose(thing.T_world_object[2, :3], [0, 0, 1], atol=1e-6)
    np.testing.assert_allclose(np.ptp(thing.vertices[:, 2]), 0.8, atol=1e-6)
    np.testing.assert_allclose(thing.size, [1.0, 0.5, 0.8], atol=1e-6)


@given(st.integers(0, 10_000))
def test_the_pose_of_sam3d_is_what_pytorch3d_computes(seed):
    """PyTorch3D multiplies rows by the matrix of the quaternion; its camera looks along z with x left and y up."""
    rng = np.random.default_rng(seed)
    scale, quaternion, translation = rng.uniform(0.2, 2, 3), rng.normal(size=4), rng.normal(size=3)
    glb = rng.normal(size=(5, 3))
    model = glb @ UP.T  # layout_post_optimization_utils.get_mesh turns y up back to z up
    in_pytorch3d = model * scale @ matrix_of(quaternion) + translation
    pose = pose_of_glb(scale, quaternion, translation)
    in_opencv = (glb * pose["scale"]) @ pose["rotation"].T + pose["translation"]
    np.testing.assert_allclose(in_opencv, in_pytorch3d * [-1, -1, 1], atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(pose["rotation"]), 1)


def test_the_matrix_of_a_quaternion_turns_as_it_says():
    half = math.sqrt(0.5)
    np.testing.assert_allclose(matrix_of(np.array([2 * half, 0, 0, 2 * half])) @ [1, 0, 0], [0, 1, 0], atol=1e-12)
    np.testing.assert_allclose(matrix_of(np.array([half, half, 0, 0])) @ [0, 1, 0], [0, 0, 1], atol=1e-12)


@pytest.mark.parametrize(
    ("kind", "x", "y", "yaw", "size"),
    [
        ("chair", 2.9, 2.2, 0.7, (0.45, 0.5, 0.95)),
        pytest.param("wardrobe", 2.6, 0.5, math.pi, (1.3, 0.6, 2.0), marks=pytest.mark.slow),
        pytest.param("sofa", 2.4, 3.3, 0.0, (2.0, 0.9, 0.85), marks=pytest.mark.slow),
    ],
)  # fmt: skip
def test_a_shape_without_a_pose_is_placed_where_it_is_seen(kind, x, y, yaw, size):
    """The shape is that of the thing seen, at another scale, yaw and place, as a model has it."""
    truth = piece(kind, x, y, yaw, size)
    (seen, *_) = observations([truth], 0)
    local = (truth.vertices - truth.T_world_object[:3, 3]) @ truth.T_world_object[:3, :3]
    canonical = dataclasses.replace(truth, vertices=local / 3.7 + [0.3, -2.0, 5.0], T_world_object=np.eye(4))
    made = fitted(canonical, seen)
    assert made is not None and box_iou(box_of(truth), box_of(made)) > 0.6
    assert abs(box_of(made).height - size[2]) < 0.12
