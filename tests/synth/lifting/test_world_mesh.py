"""A mesh file of a model as a reconstruction: lifting carries it back to where it stood, in its own colours."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.geometry.mesh.test_scene_mesh import wedge
from wm.geometry import load_object, make_camera, object_nodes, save_glb
from wm.geometry.placement.upright import transformed
from wm.synth.lifting.unlit import unlit
from wm.synth.lifting.world_mesh import as_reconstruction


@given(st.integers(0, 1000))
def test_what_a_camera_sees_comes_back_to_its_place_in_the_world(tmp_path_factory, seed):
    path = tmp_path_factory.mktemp("model") / "stool.glb"
    save_glb(path, object_nodes([wedge(seed)]))
    thing = load_object(path, label="stool", room=0)
    eye = np.random.default_rng(seed).uniform(-3, 0, 3)
    camera = make_camera(eye, np.array([2.0, 2.0, 1.0]), width=64, height=48, fov_deg=60.0)
    result = as_reconstruction(thing, camera, residual=0.02)
    low, high = thing.vertices.min(axis=0), thing.vertices.max(axis=0)
    middle = np.append((low + high) / 2, 1)
    in_camera = (result.thing.vertices.min(axis=0) + result.thing.vertices.max(axis=0)) / 2
    assert np.linalg.norm(in_camera - (camera.T_cam_world @ middle)[:3]) < 1.0 and result.residual == 0.02
    back = transformed(result.thing, np.linalg.inv(camera.T_cam_world))
    np.testing.assert_allclose(back.vertices, thing.vertices, atol=1e-9)
    np.testing.assert_allclose(back.T_world_object, thing.T_world_object, atol=1e-9)
    (plain,) = unlit([result])
    np.testing.assert_allclose(plain.slot_colors, np.minimum(thing.slot_colors, 0.97), atol=2e-2)
