"""Every target of gaussians is written, read back by the format's reader, and refused when it has been changed."""

import json
import shutil

import jax
import numpy as np
import pytest

from wm.export.records import ExportError
from wm.export.splats.comparing import Steps, deviations
from wm.export.splats.labelled_ply import read_labels
from wm.export.splats.labels import nearest_faces, triangle_distance
from wm.export.targets import TARGETS
from wm.finished import open_finished
from wm.splat import load_ply
from wm.splat.formats import load_splats, to_z_up
from wm.types import SurfaceKind

PLAIN = ("compressed_ply", "gltf_splats", "splat")


@pytest.fixture(scope="module")
def run(finished):
    return finished


@pytest.mark.parametrize("name", [*PLAIN, "labelled_ply"])
def test_it_is_written_alike_twice_and_passes_its_check(run, tmp_path, name):
    target = TARGETS[name].load()
    first = [path.read_bytes() for path in target.write(run, tmp_path)]
    assert first == [path.read_bytes() for path in target.write(run, tmp_path)]
    checks = target.check(run, tmp_path)
    assert checks and all(check.passed for check in checks)


@pytest.mark.parametrize("name", PLAIN)
def test_it_stands_with_y_up(run, tmp_path, name):
    (path,) = TARGETS[name].load().write(run, tmp_path)
    loaded, wanted = to_z_up(load_splats(path)), run.gaussians
    for end in (np.min, np.max):
        np.testing.assert_allclose(end(loaded.means, axis=0), end(wanted.means, axis=0), atol=0.01)


@pytest.mark.parametrize("name", PLAIN)
def test_a_file_of_another_run_is_told_by_the_check(run, tmp_path, name):
    (path,) = TARGETS[name].load().write(run, tmp_path)
    moved = shutil.copytree(run.folder, tmp_path / "moved")
    arrays = dict(np.load(moved / "stages" / "splats.npz"))
    key = next(name for name in arrays if name.endswith("means"))
    arrays[key] = arrays[key] + np.float32(0.05)
    np.savez(moved / "stages" / "splats.npz", **arrays)
    checks = TARGETS[name].load().check(open_finished(moved), path.parent)
    assert not all(check.passed for check in checks)


def test_the_scaffold_lies_in_one_file_with_the_gaussians(run, tmp_path):
    import trimesh

    (path,) = TARGETS["gltf_splats"].load().write(run, tmp_path)
    both, alone = trimesh.load_scene(path), trimesh.load_scene(run.scaffold_file)
    assert len(both.geometry) == len(alone.geometry) + 1
    np.testing.assert_allclose(both.geometry["gaussians"].vertices, load_splats(path).means)
    (points,) = (name for name in both.graph.nodes_geometry if both.graph[name][1] == "gaussians")
    np.testing.assert_array_equal(both.graph[points][0], np.eye(4))


def test_labels_are_those_of_the_surface_that_the_gaussian_lies_on(run, tmp_path):
    path, names = TARGETS["labelled_ply"].load().write(run, tmp_path)
    jax.tree.map(np.testing.assert_array_equal, load_ply(path), load_ply(run.splats_file))
    labels, told = read_labels(path), json.loads(names.read_text())
    assert told["objects"] == [thing.id for thing in run.objects] and told["rooms"] == run.rooms
    assert set(labels.room.tolist()) == {0, 1} and labels.object.min() == -1
    for index in np.unique(labels.object[labels.object >= 0])[:6]:
        means = run.gaussians.means[labels.object == index]
        corners = run.objects[index].vertices[run.objects[index].faces]
        other = run.scaffold.vertices[run.scaffold.faces[run.scaffold.face_object != index]]
        for point in means[:5].astype(np.float64):
            assert triangle_distance(point, corners).min() <= triangle_distance(point, other).min() + 0.01


def test_the_nearest_face_is_that_of_all_faces(run):
    points = np.random.default_rng(0).uniform(*run.scaffold.vertices[[0, -1]], size=(40, 3))
    inner = np.flatnonzero(run.scaffold.face_kind != SurfaceKind.EXTERIOR)
    corners = run.scaffold.vertices[run.scaffold.faces]
    found = nearest_faces(run.scaffold, points)
    for point, face in zip(points, found):
        assert triangle_distance(point, corners[face]) <= triangle_distance(point, corners[inner]).min() + 0.01


def test_distances_to_a_triangle_are_to_plane_edge_and_corner():
    corners = np.array([[0.0, 0, 0], [2, 0, 0], [0, 2, 0]])
    points = np.array([[0.5, 0.5, 3], [1, -1, 0], [-3, -4, 0], [2, 2, 0]])
    np.testing.assert_allclose(triangle_distance(points, corners), [3, 1, 5, np.sqrt(2)])


def test_what_came_back_otherwise_is_named(run, tmp_path):
    gaussians = run.gaussians
    turned = gaussians.replace(quats=np.roll(gaussians.quats, 1, axis=1), opacity_logits=gaussians.opacity_logits + 1)
    found = deviations(turned, gaussians, Steps(means=1e-6, log_scales=1e-6, degrees=1.0))
    assert {d.what for d in found if d.worst > 1} == {"opacities", "rotations"}


def test_a_file_without_labels_is_refused(run):
    with pytest.raises(ExportError, match="no gaussians with labels"):
        read_labels(run.splats_file)
