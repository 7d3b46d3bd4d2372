"""The sparse model says where cameras and points are, in COLMAP's conventions."""

import numpy as np
from scipy.spatial.transform import Rotation

from wm.geometry import make_camera, save_colmap
from wm.types import View


def test_poses_intrinsics_and_points_are_colmaps(tmp_path):
    camera = make_camera(np.array([1.0, 2, 1.6]), np.array([3.0, 0, 1]), width=64, height=48, fov_deg=60.0)
    views = [View(camera=camera, room=0, kind="perimeter", name="hall/perimeter0")]
    points, colors = np.array([[1.0, 2, 3], [-0.5, 0, 1e-3]]), np.array([[255, 0, 7], [1, 2, 3]], np.uint8)
    save_colmap(tmp_path / "sparse/0", views, points, colors)
    line = (tmp_path / "sparse/0/cameras.txt").read_text().split()
    assert line[:4] == ["1", "PINHOLE", "64", "48"]
    np.testing.assert_allclose(np.array(line[4:], float), [*camera.focal, *camera.principal])
    pose, second, _ = (tmp_path / "sparse/0/images.txt").read_text().split("\n")
    words = pose.split()
    assert words[0] == "1" and words[8:] == ["1", "hall/perimeter0.png"] and second == ""
    w, x, y, z, *t = map(float, words[1:8])
    np.testing.assert_allclose(Rotation.from_quat([x, y, z, w]).as_matrix(), camera.T_cam_world[:3, :3], atol=1e-8)
    np.testing.assert_allclose(t, camera.T_cam_world[:3, 3], atol=1e-8)
    rows = np.loadtxt(tmp_path / "sparse/0/points3D.txt")
    np.testing.assert_allclose(rows, np.c_[[1, 2], points, colors, [0, 0]])
