"""Target `collider`: closed rooms without a gap, convex parts, and a check that finds a hole."""

import json

import numpy as np
import pytest

from wm.export import collider
from wm.geometry.mesh.glb import save_glb
from wm.geometry.mesh.glb_nodes import GlbNode
from wm.geometry.rays.raycast import build_ray_scene
from wm.types import Mesh


@pytest.fixture(scope="module")
def written(finished, tmp_path_factory):
    folder = tmp_path_factory.mktemp("collider")
    return folder, collider.write(finished, folder)


def test_the_files_pass_their_check(finished, written):
    folder, paths = written
    assert len(paths) == len(finished.rooms) + 1
    checks = collider.check(finished, folder)
    assert len(checks) == 5 and all(check.passed for check in checks)


def test_the_solids_of_all_rooms_are_the_building(finished):
    """Joined they leave nothing out and add nothing; both rooms here are about as high."""
    import manifold3d

    def solid(vertices, faces):
        return manifold3d.Manifold(manifold3d.Mesh64(np.array(vertices), np.array(faces, np.uint64)))

    structure = finished.structure
    joined = manifold3d.Manifold()
    for vertices, faces in collider.room_solids(finished):
        joined = joined + solid(vertices, faces)
    whole = solid(structure.vertices, structure.faces)
    assert joined.volume() == pytest.approx(whole.volume(), rel=1e-6)
    assert abs((whole - joined).volume()) < 1e-4


def test_equal_runs_give_equal_bytes(finished, written, tmp_path):
    assert [path.read_bytes() for path in collider.write(finished, tmp_path)] == [path.read_bytes() for path in written[1]]


def test_a_hole_and_a_dent_are_found(finished, written, tmp_path):
    _, paths = written
    for path in paths:
        (tmp_path / "collider").mkdir(exist_ok=True)
        (tmp_path / "collider" / path.name).write_bytes(path.read_bytes())
    vertices, faces = collider.room_solids(finished)[0]
    open_solid = GlbNode(name="open", vertices=vertices, faces=faces[len(faces) // 2 :])
    save_glb(tmp_path / "collider" / paths[0].name, [open_solid])
    told = json.loads(paths[-1].read_text())
    part = told["objects"][0]["parts"][0]
    part["vertices"][0] = np.mean(part["vertices"], axis=0).tolist()
    (tmp_path / "collider" / "objects.json").write_text(json.dumps(told))
    failed = {check.what for check in collider.check(finished, tmp_path) if not check.passed}
    assert failed == {"rooms that are closed", "parts of objects that are convex", "gaps for a sphere of 5 cm"}


def test_a_ray_along_an_edge_is_no_gap_and_a_hole_is_one():
    corners = np.array([[0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]], float)
    scene = build_ray_scene(Mesh.from_triangles(corners, np.array([[0, 1, 2], [0, 2, 3]])))
    points = np.array([[0, -0.0005, 0.5], [0, 0.5, 1.0005], [0, -0.05, 0.5]])
    normals = np.tile([1.0, 0.0, 0.0], (3, 1))
    assert collider._misses(scene, points, normals).all()
    assert collider._wide(scene, points, normals).tolist() == [False, False, True]
