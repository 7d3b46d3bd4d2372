"""The stage is the house, as usd-core reads it, and its validators find nothing in it."""

import numpy as np
import pytest

from tests.export.simulation.houses import fit, objects, paint, write_run
from wm.color import to_linear
from wm.export.simulation import usd
from wm.export.simulation.bodies import rigid_body

pytest.importorskip("pxr", reason="the extra simulation is not installed: pip install -e '.[simulation]'")
from pxr import Gf, Usd, UsdGeom, UsdPhysics, UsdSemantics, UsdShade, UsdVol


@pytest.fixture
def run(tmp_path):
    return write_run(tmp_path / "run")


def opened(run, folder):
    return Usd.Stage.Open(str(usd.write(run, folder)[0]))


def test_a_finished_house_passes_its_check_and_is_written_in_the_same_bytes(run, tmp_path):
    paint(run)
    fit(run)
    first, second = (usd.write(run, tmp_path / name) for name in ("one", "two"))
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]
    assert [row for row in usd.check(run, tmp_path / "one") if not row.passed] == []


def test_labels_are_in_names_and_semantics(run, tmp_path):
    stage = opened(run, tmp_path)
    table = stage.GetPrimAtPath("/House/Scaffold/hall/hall_table_1")
    assert table.GetDisplayName() == "hall-table-1"
    assert list(UsdSemantics.LabelsAPI(table, "category").GetLabelsAttr().Get()) == ["table"]
    floor = stage.GetPrimAtPath("/House/Scaffold/study/floor")
    assert list(UsdSemantics.LabelsAPI(floor, "category").GetLabelsAttr().Get()) == ["floor"]


def test_masses_turn_about_the_same_axes_as_the_bodies(run, tmp_path):
    stage = opened(run, tmp_path)
    mass = UsdPhysics.MassAPI(stage.GetPrimAtPath("/House/Scaffold/hall/hall_table_1"))
    turn = np.array(Gf.Matrix3d(mass.GetPrincipalAxesAttr().Get())).T
    inertia = turn @ np.diag(mass.GetDiagonalInertiaAttr().Get()) @ turn.T
    np.testing.assert_allclose(inertia, rigid_body(objects()[0]).inertia, rtol=1e-5, atol=1e-6)


def test_colliders_are_convex_and_everything_that_stands_is_enabled(run, tmp_path):
    stage = opened(run, tmp_path)
    for prim in stage.Traverse():
        if prim.HasAPI(UsdPhysics.CollisionAPI) and prim.IsA(UsdGeom.Mesh):
            assert UsdPhysics.MeshCollisionAPI(prim).GetApproximationAttr().Get() == "convexHull"
    enabled = {p.GetDisplayName() for p in stage.Traverse() if UsdPhysics.RigidBodyAPI(p).GetRigidBodyEnabledAttr().Get()}
    assert {name for name in enabled if name} >= {"hall-table-1", "study-chest-1"}


def test_materials_have_the_colours_in_linear_light(run, tmp_path):
    stage = opened(run, tmp_path)
    mesh = stage.GetPrimAtPath("/House/Scaffold/hall/hall_vase_1/mesh")
    material, _ = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()
    surface = material.ComputeSurfaceSource()[0]
    color = surface.GetInput("diffuseColor").Get()
    np.testing.assert_allclose(color, to_linear(objects()[1].slot_colors[0]), rtol=1e-5)


def test_splats_are_a_payload_of_a_prim_for_each_room(run, tmp_path):
    fit(run)
    stage = opened(run, tmp_path)
    rooms = stage.GetPrimAtPath("/House/Splats").GetChildren()
    assert [prim.GetName() for prim in rooms] == ["hall", "study"]
    splats = UsdVol.ParticleField3DGaussianSplat(rooms[0])
    mine = run.gaussian_room == 0
    np.testing.assert_allclose(splats.GetScalesAttr().Get(), np.exp(run.gaussians.log_scales[mine]), rtol=1e-6)
    np.testing.assert_allclose(splats.GetOpacitiesAttr().Get(), 1 / (1 + np.exp(-run.gaussians.opacity_logits[mine])), rtol=1e-5)
    told = [[q.GetReal(), *q.GetImaginary()] for q in splats.GetOrientationsAttr().Get()]
    ours = run.gaussians.quats[mine]
    np.testing.assert_allclose(told, ours / np.linalg.norm(ours, axis=1, keepdims=True), atol=1e-6)
    assert splats.GetRadianceSphericalHarmonicsDegreeAttr().Get() == 1
    coefficients = np.array(splats.GetRadianceSphericalHarmonicsCoefficientsAttr().Get())
    np.testing.assert_array_equal(coefficients.reshape(-1, 4, 3), run.gaussians.sh[mine])


def test_one_of_meshes_and_splats_is_shown(run, tmp_path):
    fit(run)
    stage = opened(run, tmp_path)
    shows = stage.GetPrimAtPath("/House").GetVariantSet("shows")
    assert shows.GetVariantNames() == ["both", "scaffold", "splats"]

    def shown(path):
        return UsdGeom.Imageable(stage.GetPrimAtPath(path)).ComputeVisibility() == UsdGeom.Tokens.inherited

    for variant, seen in (("scaffold", (True, False)), ("splats", (False, True)), ("both", (True, True))):
        shows.SetVariantSelection(variant)
        assert (shown("/House/Scaffold/hall/floor"), shown("/House/Splats/hall")) == seen


def test_validators_find_what_is_wrong(run, tmp_path):
    fit(run)
    path = usd.write(run, tmp_path)[0]
    stage = Usd.Stage.Open(str(path))
    stage.ClearDefaultPrim()
    UsdPhysics.CollisionAPI.Apply(stage.GetPrimAtPath("/House/Scaffold/hall"))
    (prim,) = [p for p in stage.Traverse() if p.GetDisplayName() == "hall-table-1"]
    UsdPhysics.MassAPI(prim).GetMassAttr().Set(1.0)
    stage.Save()
    rows = usd.check(run, tmp_path)
    assert [row.passed for row in rows] == [False, False]
    path.unlink()
    assert [row.passed for row in usd.check(run, tmp_path)] == [False]
