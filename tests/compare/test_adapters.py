"""Each adapter reads back what the system's code has written: exactly, or within the format's quantisation."""

import dataclasses
import pathlib
import pickle

import numpy as np
import pytest
import trimesh

from tests.compare import writers
from wm.compare.adapters.registry import ADAPTERS, adapter_for, identity_of, read_scene
from wm.compare.drawing import drawer_of
from wm.compare.errors import CompareError
from wm.compare.records import ComparedScene, Source
from wm.finished import UnfinishedRunError, open_finished
from wm.geometry import cast, make_camera
from wm.splat import save_ply
from wm.splat.rasterizer.harmonics import SH_C0
from wm.types import Gaussians

DOCS = pathlib.Path(__file__).parents[2] / "docs" / "comparison.md"


def read(adapter: str, path: pathlib.Path, **told) -> ComparedScene:
    return read_scene(Source(method="theirs", adapter=adapter, path=path, **told))


def assert_close(found: Gaussians, wanted: Gaussians, *, atol: float = 1e-5) -> None:
    for field in dataclasses.fields(Gaussians):
        np.testing.assert_allclose(getattr(found, field.name), getattr(wanted, field.name), atol=atol, err_msg=field.name)


def up_of(scene: ComparedScene) -> list[float]:
    """The file's direction that points up."""
    return (np.asarray(scene.R_world_file).T @ [0, 0, 1]).round(9).tolist()


@pytest.mark.parametrize("adapter", ["worldexplorer", "splats"])
def test_inria_files_are_read_as_they_are(adapter, tmp_path):
    wanted = writers.some_gaussians(degree=3)
    writers.inria_ply(tmp_path / "splat.ply", wanted)
    scene = read(adapter, tmp_path / "splat.ply")
    assert_close(scene.gaussians, wanted)
    assert scene.antialias == (adapter == "worldexplorer")
    assert up_of(scene) == [0, 0, 1]


def test_dreamscene360_reads_the_last_iteration(tmp_path):
    wanted = writers.some_gaussians(degree=3, seed=1)
    writers.inria_ply(tmp_path / "point_cloud/iteration_7000/point_cloud.ply", writers.some_gaussians(degree=3))
    writers.inria_ply(tmp_path / "point_cloud/iteration_10000/point_cloud.ply", wanted)
    assert_close(read("dreamscene360", tmp_path).gaussians, wanted)


def test_the_last_layer_of_layerpano3d_is_the_scene(tmp_path):
    base, whole = writers.some_gaussians(10, degree=3), writers.some_gaussians(30, degree=3, seed=2)
    flat = dataclasses.replace(whole, sh=np.concatenate([whole.sh[:, :1], 0 * whole.sh[:, 1:]], axis=1))
    writers.inria_ply(tmp_path / "gsplat_layer0.ply", base)
    writers.inria_ply(tmp_path / "gsplat_layer1.ply", flat)
    scene = read("layerpano3d", tmp_path)
    assert_close(scene.gaussians, flat)
    assert up_of(scene) == [0, -1, 0]
    (tmp_path / "gsplat_layer0.ply").unlink()
    with pytest.raises(CompareError, match=r"theirs: .*lacks gsplat_layer0\.ply of 2 layers"):
        read("layerpano3d", tmp_path)


def test_flexworld_is_turned_back_and_its_colours_are_no_logits(tmp_path):
    wanted = writers.some_gaussians()
    writers.flexworld_ply(tmp_path / "room_gs_final_2.ply", wanted)
    scene = read("flexworld", tmp_path)
    assert_close(scene.gaussians, wanted)
    assert up_of(scene) == [0, 1, 0]


def test_wonderworlds_ply_is_activated(tmp_path):
    wanted = writers.some_gaussians()
    writers.wonderworld_ply(tmp_path / "finished_3dgs.ply", wanted)
    assert_close(read("wonderworld", tmp_path).gaussians, wanted)


def test_a_splat_file_is_read_within_a_step_of_its_bytes(tmp_path):
    g = writers.some_gaussians()
    writers.wonderworld_splat(tmp_path / "campus_finished_3dgs.splat", g)
    found = read("wonderworld", tmp_path).gaussians
    order = [int(np.argmin(np.abs(g.means - mean).sum(axis=1))) for mean in found.means]
    assert sorted(order) == list(range(len(g.means)))
    np.testing.assert_array_equal(found.means, g.means[order])
    np.testing.assert_allclose(found.log_scales, g.log_scales[order], atol=1e-5)
    np.testing.assert_allclose(SH_C0 * found.sh, SH_C0 * g.sh[order], atol=1 / 255)
    opacity = [1 / (1 + np.exp(-x)) for x in (found.opacity_logits, g.opacity_logits[order])]
    np.testing.assert_allclose(*opacity, atol=1 / 255)
    np.testing.assert_allclose(found.quats, g.quats[order], atol=1 / 128)


def spatialgen(tmp_path: pathlib.Path) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(0)
    points, colors = random.uniform(-2, 2, (2, 4, 6, 3)), random.uniform(0, 1, (2, 4, 6, 3))
    T_layout_first = np.eye(4)
    T_layout_first[:3, :3] = [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]  # the first view looks along +x, z up
    T_layout_first[:3, 3] = [0.5, -0.25, 1.5]
    writers.spatialgen_npz(tmp_path / "inference_results.npz", writers.spatialgen_room(points, colors, T_layout_first, 0.2))
    return points.reshape(-1, 3), colors.reshape(-1, 3)


def test_spatialgen_comes_back_into_the_layout_in_metres(tmp_path):
    points, colors = spatialgen(tmp_path)
    scene = read("spatialgen", tmp_path)
    kept = np.arange(len(points)) != len(points) // 2  # without the masked pixel
    np.testing.assert_allclose(scene.gaussians.means, points[kept], atol=1e-5)
    np.testing.assert_allclose(0.5 + SH_C0 * scene.gaussians.sh[:, 0], colors[kept], atol=1e-6)
    assert scene.metric
    camera = scene.cameras[0]
    np.testing.assert_allclose(np.linalg.inv(camera.T_cam_world)[:3, 3], [0.5, -0.25, 1.5], atol=1e-6)
    np.testing.assert_allclose(np.asarray(camera.T_cam_world)[2, :3], [1, 0, 0], atol=1e-6)


@dataclasses.dataclass
class Harmful:
    touches: pathlib.Path

    def __reduce__(self):
        return pathlib.Path.touch, (self.touches,)


def test_a_pickle_that_would_run_something_is_refused(tmp_path):
    touched = tmp_path / "touched-by-a-pickle"
    writers.spatialgen_npz(tmp_path / "inference_results.npz", {"input_points": Harmful(touched)})
    with pytest.raises(CompareError, match="arrays and plain values would be right"):
        read("spatialgen", tmp_path)
    assert pickle.dumps(Harmful(touched))
    assert not touched.exists()


FILES = {
    "wonderworld": ("x_finished_3dgs.splat", lambda path: writers.wonderworld_splat(path, writers.some_gaussians())),
    "flexworld": ("x_gs_final_2.ply", lambda path: writers.flexworld_ply(path, writers.some_gaussians())),
    "layerpano3d": ("gsplat_layer0.ply", lambda path: writers.inria_ply(path, writers.some_gaussians(degree=3))),
    "worldexplorer": ("splat.ply", lambda path: writers.inria_ply(path, writers.some_gaussians(degree=3))),
    "dreamscene360": ("point_cloud.ply", lambda path: writers.inria_ply(path, writers.some_gaussians(degree=3))),
    "splats": ("scene.ply", lambda path: save_ply(path, writers.some_gaussians(degree=1))),
    "spatialgen": ("inference_results.npz", lambda path: spatialgen(path.parent)),
}


@pytest.mark.parametrize("adapter", FILES)
@pytest.mark.parametrize("damage", ["truncated", "empty", "another"])
def test_a_wrong_file_is_one_error_with_method_file_and_what_was_expected(adapter, damage, tmp_path):
    name, write = FILES[adapter]
    file = tmp_path / name
    write(file)
    raw = file.read_bytes()
    file.write_bytes({"truncated": raw[: len(raw) - 7], "empty": b"", "another": b"PNG is what this is not" * 3}[damage])
    with pytest.raises(CompareError) as caught:
        read(adapter, file)
    message = str(caught.value)
    assert message.startswith("theirs: ") and str(file) in message and "expected" in message and "\n" not in message


@pytest.mark.parametrize("adapter", [name for name in ADAPTERS if name != "ours"])
def test_what_is_not_there_is_one_error_too(adapter, tmp_path):
    for path in (tmp_path, tmp_path / "nothing"):
        with pytest.raises(CompareError, match=r"theirs: .*(expected|would be right)"):
            identity_of(Source(method="theirs", adapter=adapter, path=path))


def test_the_adapter_is_that_of_the_name_or_of_the_file(tmp_path):
    assert adapter_for("WonderWorld", tmp_path) == "wonderworld"
    assert adapter_for("any", tmp_path / "a.PLY") == "splats"
    assert adapter_for("any", tmp_path / "a.glb") == "mesh"
    trimesh.creation.box().export(tmp_path / "mesh.ply")
    save_ply(tmp_path / "splats.ply", writers.some_gaussians())
    assert [adapter_for("any", tmp_path / f"{name}.ply") for name in ("mesh", "splats")] == ["mesh", "splats"]
    with pytest.raises(CompareError, match="any:ADAPTER="):
        adapter_for("any", tmp_path)


def test_the_documentation_has_a_row_for_every_adapter():
    rows = {line.split("`")[1]: line for line in DOCS.read_text("utf-8").splitlines() if line.startswith("| `")}
    for name, module in ADAPTERS.items():
        assert module.SYSTEM.commit[:7] in rows[name]
        assert module.SYSTEM.source.partition(":")[0] in rows[name] or not module.SYSTEM.commit


def test_a_run_of_ours_is_its_gaussians_in_metres_with_its_own_antialiasing(run_folder):
    scene = read("ours", run_folder)
    run = open_finished(run_folder)
    assert_close(scene.gaussians, run.gaussians)
    assert scene.metric and scene.run is not None and up_of(scene) == [0, 0, 1]
    assert scene.antialias == run.raster.antialias
    assert read("ours", run_folder, antialias=not run.raster.antialias).antialias == (not run.raster.antialias)
    with pytest.raises(UnfinishedRunError, match="nothing"):
        read("ours", run_folder.parent / "nothing")


def test_the_scaffold_of_a_run_is_seen_as_the_run_casts_it(run_folder):
    run = open_finished(run_folder)
    scene = read("mesh", run.scaffold_file)
    assert up_of(scene) == [0, 1, 0]
    camera = run.views[0].camera
    seen, cast_depth = drawer_of(scene)(camera), cast(run.rays, camera).depth
    same = (np.abs(seen.depth - cast_depth) < 1e-3) | ((seen.depth == 0) & (cast_depth == 0))
    assert same.mean() > 0.999  # at an edge a ray may take either face
    assert np.ptp(seen.rgb[seen.alpha > 0], axis=0).min() > 0.2  # the textures are there


@pytest.mark.parametrize("suffix", ["obj", "ply", "glb"])
def test_a_mesh_of_trimesh_keeps_its_place_and_colours(suffix, tmp_path):
    box = trimesh.creation.box((2, 4, 6))
    box.visual.vertex_colors = np.column_stack([np.where(box.vertices > 0, 255, 0), np.full(8, 255)]).astype(np.uint8)
    box.export(tmp_path / f"box.{suffix}")
    scene = read("mesh", tmp_path / f"box.{suffix}", up="z")
    camera = make_camera(np.zeros(3), np.array([1.0, 0, 0]), width=40, height=40, fov_deg=90.0)
    seen = drawer_of(scene)(camera)
    np.testing.assert_allclose(seen.depth, 1, atol=1e-5)  # the wall at x = 1
    across = 1 - (np.arange(40) + 0.5) / 20  # y of a column, z of a row
    y, z = np.meshgrid(across, across)
    exact = [np.ones_like(y), 0.5 + y / 4, 0.5 + z / 6]
    np.testing.assert_allclose(seen.rgb, np.stack(exact, -1), atol=0.01)


def test_the_identity_of_a_source_follows_what_decides_the_picture(tmp_path):
    file = tmp_path / "splat.ply"
    save_ply(file, writers.some_gaussians())
    source = Source(method="a", adapter="splats", path=file)
    known = identity_of(source)
    assert identity_of(dataclasses.replace(source, method="b")) == known
    assert identity_of(dataclasses.replace(source, up="y")) != known
    save_ply(file, writers.some_gaussians(seed=1))
    assert identity_of(source) != known
