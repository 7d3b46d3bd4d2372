"""Target `usd`: the house as an OpenUSD stage, z up, in metres.

    usd/house.usdc   /House/Scaffold/<room>/<object>: an Xform of each object with its mesh, its hulls and its mass
                     /House/Scaffold/<room>/<wall, floor, ...>: the building's surfaces and their prisms
                     /House/Splats: the gaussians, a payload; /House/Looks: materials; /House/PhysicsScene
    usd/splats.usdc  a ParticleField3DGaussianSplat for each room
    usd/textures     the rooms' painted images, and those of objects

The variant set "shows" of /House has scaffold (at first), splats and both. Prims are named by identifiers made of ids; labels are
in the semantics "category", and the ids are the prims' display names. Colliders have the purpose guide, which viewers hide at
first. Everything is written in one order, so equal runs give equal bytes.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from wm.export.records import Check, ExportError
from wm.export.simulation.bodies import Body
from wm.export.simulation.files import write_files
from wm.export.simulation.house import House, simulated
from wm.export.simulation.library import library
from wm.export.simulation.usd_splats import splat_differences, splat_layer
from wm.export.simulation.usd_stage import SPLATS, layer_bytes, stage_files
from wm.finished import FinishedRun

FOLDER, MAIN, SPLAT_FILE = "usd", "house.usdc", "splats.usdc"


def write(run: FinishedRun, folder: Path) -> Sequence[Path]:
    """Writes usd/house.usdc, its textures and, of a fitted run, its splats, and opens them again.

    Raises:
      ExportError: usd-core reads something else than the run, or its validators find an error.
    """
    house = simulated(run)
    splats = splat_layer(run, house)
    files = stage_files(run, house, MAIN, None if splats is None else SPLAT_FILE)
    if splats is not None:
        files[SPLAT_FILE] = layer_bytes(splats)
    paths = write_files(folder / FOLDER, files, MAIN)
    wrong = [*_differences(run, house, paths[0]), *_findings(paths[0])]
    if wrong:
        raise ExportError(f"{paths[0]}: read back, {'; '.join(wrong[:5])}")
    return paths


def check(run: FinishedRun, folder: Path) -> Sequence[Check]:
    """Opens usd/house.usdc, runs all validators of usd-core on it (those of usdchecker), and compares it with the run."""
    path = folder / FOLDER / MAIN
    wrong = _differences(run, simulated(run), path)
    told = "; ".join(wrong[:5]) or f"{len(run.objects)} equal"
    same = Check("usd", "prims, masses, poses and splats in usd-core", told, "equal", not wrong)
    if not path.is_file():
        return [same]
    found = _findings(path)
    return [same, Check("usd", "findings of usd-core's validators", "; ".join(found[:5]) or "none", "none", not found)]


def _findings(path: Path) -> list[str]:
    """What the validators of usd-core say of a stage, its payloads loaded."""
    Usd, UsdValidation = (library(f"pxr.{name}") for name in ("Usd", "UsdValidation"))

    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    found = UsdValidation.ValidationContext(validators).Validate(Usd.Stage.Open(str(path)))
    return sorted({error.GetMessage() for error in found})


def _differences(run: FinishedRun, house: House, path: Path) -> list[str]:
    """In what a file, as usd-core reads it, differs from the run."""
    Tf, Usd, UsdGeom, UsdPhysics = (library(f"pxr.{name}") for name in ("Tf", "Usd", "UsdGeom", "UsdPhysics"))

    try:
        stage = Usd.Stage.Open(str(path))
    except Tf.ErrorException as error:
        return [f"usd-core cannot open it: {error}"]
    axes = UsdGeom.GetStageUpAxis(stage), UsdGeom.GetStageMetersPerUnit(stage)
    wrong = [] if axes == ("Z", 1.0) else [f"its up axis and metres per unit are {axes}"]
    bodies = {prim.GetDisplayName(): prim for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.RigidBodyAPI)}
    ours = {body.id: body for body in house.bodies}
    wrong += [f"{len(bodies)} rigid bodies for {len(ours)} objects"] if set(bodies) != set(ours) else []
    places = UsdGeom.XformCache()
    for name in sorted(set(bodies) & set(ours)):
        pose = np.array(places.GetLocalToWorldTransform(bodies[name])).T
        wrong += [f"{name} {what}" for what in _body_differences(ours[name], bodies[name], pose)]
    return [*wrong, *splat_differences(run, house, stage, SPLATS)]


def _body_differences(body: Body, prim: Any, pose: np.ndarray) -> Iterator[str]:
    Usd, UsdGeom, UsdPhysics, UsdSemantics = (library(f"pxr.{name}") for name in ("Usd", "UsdGeom", "UsdPhysics", "UsdSemantics"))

    gap = np.abs(pose - body.T_world_body).max()
    if not gap < 1e-9 * (1 + np.abs(body.T_world_body[:3, 3]).max()):
        yield f"stands elsewhere, by {gap:.2g}"
    mass = UsdPhysics.MassAPI(prim).GetMassAttr().Get()
    if not np.isclose(mass, body.mass, rtol=1e-6):
        yield f"weighs {mass:.4g} kg for {body.mass:.4g}"
    if UsdPhysics.RigidBodyAPI(prim).GetRigidBodyEnabledAttr().Get() != body.moves:
        yield "is free where it should be fixed" if not body.moves else "is fixed where it should be free"
    if list(UsdSemantics.LabelsAPI(prim, "category").GetLabelsAttr().Get()) != [body.thing.label]:
        yield "has another label"
    below = list(Usd.PrimRange(prim))
    hulls = sum(one.HasAPI(UsdPhysics.CollisionAPI) for one in below)
    if hulls != len(body.hulls):
        yield f"has {hulls} hulls for {len(body.hulls)}"
    faces = sum(len(UsdGeom.Mesh(one).GetFaceVertexCountsAttr().Get()) for one in below if one.GetName() == "mesh")
    if faces != len(body.thing.faces):
        yield f"has {faces} triangles for {len(body.thing.faces)}"
