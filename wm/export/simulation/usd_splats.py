"""The gaussians as OpenUSD's own prim for them, ParticleField3DGaussianSplat: one for each room.

Its scales are linear and its opacities 0 to 1; coefficients of spherical harmonics are those of `Gaussians.sh`, to whose colour
0.5 is added here and there. The degree is always written, since it falls back to 3.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from wm.export.simulation.house import House
from wm.export.simulation.library import library
from wm.finished import FinishedRun
from wm.stages.reconstruction import BY_ROOM

ROOT = "/Splats"


def is_fitted(run: FinishedRun) -> bool:
    """Whether the run has come to its gaussians."""
    return (run.folder / BY_ROOM).is_file()


def splat_layer(run: FinishedRun, house: House) -> Any | None:
    """A layer with the gaussians of a run that has some; None of a run that is not fitted yet."""
    Sdf, Usd, UsdGeom = (library(f"pxr.{name}") for name in ("Sdf", "Usd", "UsdGeom"))

    if not is_fitted(run):
        return None
    layer = Sdf.Layer.CreateAnonymous(".usdc")
    stage = Usd.Stage.Open(layer)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, ROOT).GetPrim())
    for index, name in enumerate(house.rooms):
        mine = run.gaussian_room == index
        if mine.any():
            _add_room(stage, f"{ROOT}/{name}", run, mine)
    return layer


def _add_room(stage: Any, path: str, run: FinishedRun, mine: np.ndarray) -> None:
    UsdVol, Vt = (library(f"pxr.{name}") for name in ("UsdVol", "Vt"))

    splats, gaussians = UsdVol.ParticleField3DGaussianSplat.Define(stage, path), run.gaussians
    means, quats, log_scales, logits, sh = (
        np.asarray(leaf, np.float32)[mine]
        for leaf in (gaussians.means, gaussians.quats, gaussians.log_scales, gaussians.opacity_logits, gaussians.sh)
    )
    scales = np.exp(log_scales)
    quats = quats / np.linalg.norm(quats, axis=1, keepdims=True)
    splats.CreatePositionsAttr(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(means)))
    splats.CreateOrientationsAttr(Vt.QuatfArray.FromNumpy(np.ascontiguousarray(np.roll(quats, -1, axis=1))))  # the real part last
    splats.CreateScalesAttr(Vt.Vec3fArray.FromNumpy(scales))
    splats.CreateOpacitiesAttr(Vt.FloatArray.FromNumpy(1 / (1 + np.exp(-logits))))
    splats.CreateRadianceSphericalHarmonicsDegreeAttr(round(np.sqrt(sh.shape[1])) - 1)
    coefficients = Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(sh.reshape(-1, 3)))
    splats.CreateRadianceSphericalHarmonicsCoefficientsAttr(coefficients)
    reach = 3 * scales.max(axis=1, keepdims=True)
    extent = np.stack([(means - reach).min(axis=0), (means + reach).max(axis=0)]).astype(np.float32)
    splats.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(extent))


def splat_differences(run: FinishedRun, house: House, stage: Any, root: str) -> Iterator[str]:
    """In what the splats under a prim of a stage differ from the run's."""
    UsdVol = library("pxr.UsdVol")

    for index, name in enumerate(house.rooms if is_fitted(run) else ()):
        means = np.asarray(run.gaussians.means)[run.gaussian_room == index]
        quats = np.asarray(run.gaussians.quats)[run.gaussian_room == index]
        prim = stage.GetPrimAtPath(f"{root}/{name}")
        found = np.array(UsdVol.ParticleField3DGaussianSplat(prim).GetPositionsAttr().Get()) if prim else np.zeros((0, 3))
        if found.shape != means.shape or not np.array_equal(found, means):
            yield f"{name} has {len(found)} splats for {len(means)}, or at other places"
        elif len(found):
            first = UsdVol.ParticleField3DGaussianSplat(prim).GetOrientationsAttr().Get()[0]
            told = np.array([first.GetReal(), *first.GetImaginary()])
            if not np.allclose(told, quats[0] / np.linalg.norm(quats[0]), atol=1e-6):
                yield f"{name}: splats are turned otherwise"
