"""Target `mjcf`: the house as MuJoCo's model file.

mjcf/house.xml and mjcf/meshes. Geoms of group 2 are what one sees, those of group 3 what collides (MuJoCo's custom), and of
group 4 the building's outer skin, which is not shown at first. Each object is a body of its id with a free joint, or none where
it is fixed. MuJoCo writes six digits of each number: a body of a house 100 m wide lies within half a millimetre.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from wm.export.records import Check, ExportError
from wm.export.simulation.bodies import Body, rigid_body
from wm.export.simulation.files import write_files
from wm.export.simulation.house import House, simulated
from wm.export.simulation.hulls import Hull
from wm.export.simulation.library import library
from wm.export.simulation.looks import Appearance, body_appearance
from wm.export.simulation.rotations import quaternion
from wm.export.simulation.settling import Settled, settle
from wm.export.simulation.shell import prisms
from wm.export.simulation.wavefront import obj_files, png
from wm.finished import FinishedRun
from wm.types import SurfaceKind

FOLDER, MAIN = "mjcf", "house.xml"
SHOWN, COLLIDES, SKIN = 2, 3, 4
"""Groups of geoms."""
_SUN = np.array([0.3, 0.2, -1.0])


def write(run: FinishedRun, folder: Path) -> Sequence[Path]:
    """Writes mjcf/house.xml and its meshes, and loads it again.

    Raises:
      ExportError: MuJoCo refuses it, or reads other bodies than the run's.
    """
    files = _Model(run, simulated(run)).files()
    paths = write_files(folder / FOLDER, files, MAIN)
    wrong = _differences(run, paths[0])
    if wrong:
        raise ExportError(f"{paths[0]}: read back, {'; '.join(wrong)}")
    return paths


def check(run: FinishedRun, folder: Path) -> Sequence[Check]:
    """Loads mjcf/house.xml, compares it with the run, and lets everything that may move stand for two seconds."""
    path = folder / FOLDER / MAIN
    wrong = _differences(run, path)
    told = "; ".join(wrong[:5]) or f"{len(run.objects)} equal"
    same = Check("mjcf", "bodies, masses and poses in MuJoCo", told, "equal", not wrong)
    if wrong:
        return [same]
    settled = settle(path)
    bodies = simulated(run).bodies
    open_parts, parts = sum(body.open_parts for body in bodies), sum(max(len(body.hulls), body.open_parts) for body in bodies)
    return [
        same,
        Check("mjcf", "open parts of objects, whose hulls stand for them", f"{open_parts} of {parts}", "any", True),
        _all_but(settled.moved, settled, "standing objects that move less than 2 cm in 2 s"),
        _all_but(settled.tipped, settled, "standing objects that do not tip in 2 s"),
    ]


def _all_but(bad: Sequence[str], settled: Settled, what: str) -> Check:
    count = len(settled.names)
    told = f"{count - len(bad)} of {count}" + (f" (not {', '.join(bad[:5])})" if bad else "")
    return Check("mjcf", what, told, "all", not bad)


class _Model:
    """The model under construction, and the files that it names."""

    def __init__(self, run: FinishedRun, house: House) -> None:
        mujoco = library("mujoco")

        self.mujoco = mujoco
        self.run, self.house = run, house
        self.assets: dict[str, bytes] = {}
        self.spec: Any = mujoco.MjSpec()
        self.spec.modelname = "house"
        self.spec.meshdir = self.spec.texturedir = "meshes"
        self.spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        self.spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        self.spec.visual.headlight.ambient, self.spec.visual.headlight.diffuse = [0.5] * 3, [0.4] * 3
        self.spec.worldbody.add_light(
            name="sun", type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL, dir=_SUN, diffuse=[0.3] * 3, castshadow=False
        )

    def files(self) -> dict[str, bytes | str]:
        self._add_house()
        for body, name in zip(self.house.bodies, self.house.names):
            self._add_body(body, name)
        self.spec.assets = self.assets
        try:
            self.spec.compile()
            text = self.spec.to_xml()
        except (ValueError, self.mujoco.FatalError) as error:
            raise ExportError(f"mjcf: MuJoCo refuses the model of {self.run.folder}: {error}") from error
        return {MAIN: text, **{f"meshes/{name}": data for name, data in self.assets.items()}}

    def _add_house(self) -> None:
        """A fixed body for the surfaces of each kind of each room, at the corner of the building in whole metres."""
        corner = np.floor(self.run.structure.vertices.min(axis=0))
        for part in self.house.parts:
            name = self.house.part_name(part)
            body = self.spec.worldbody.add_body(name=f"house/{name}", pos=corner)
            for k, look in enumerate(part.looks):
                moved = Appearance(**{**vars(look), "vertices": look.vertices - corner})
                self._add_look(body, moved, f"{name}_{k}", SKIN if part.kind == SurfaceKind.EXTERIOR else SHOWN)
            for k, prism in enumerate(prisms(self.run.structure, part.faces)):
                self._add_hull(body, Hull(prism.vertices - corner, prism.faces), f"house/{name}/{k}")

    def _add_body(self, body: Body, name: str) -> None:
        made = self.spec.worldbody.add_body(
            name=body.id,
            pos=body.T_world_body[:3, 3],
            quat=quaternion(body.T_world_body[:3, :3]),
            explicitinertial=True,
            mass=body.mass,
            ipos=body.center,
            fullinertia=body.inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]],
        )
        if body.moves:
            made.add_freejoint(name=body.id)
        self._add_look(made, body_appearance(body), name, SHOWN)
        for k, hull in enumerate(body.hulls):
            self._add_hull(made, hull, f"{body.id}/{k}")

    def _add_hull(self, body: Any, hull: Hull, name: str) -> None:
        common = {"name": name, "group": COLLIDES, "rgba": [0.6, 0.6, 0.6, 0.5]}
        if hull.box is not None:
            center, size = hull.box
            body.add_geom(type=self.mujoco.mjtGeom.mjGEOM_BOX, pos=center, size=size / 2, **common)
            return
        convex = self.mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
        self.spec.add_mesh(name=name, uservert=hull.vertices.reshape(-1), inertia=convex)
        body.add_geom(type=self.mujoco.mjtGeom.mjGEOM_MESH, meshname=name, **common)

    def _add_look(self, body: Any, look: Appearance, name: str, group: int) -> None:
        files = obj_files(look, name)
        self.assets[f"{name}.png"] = png(files.image)
        self.spec.add_texture(name=name, type=self.mujoco.mjtTexture.mjTEXTURE_2D, file=f"{name}.png")
        for mesh in files.meshes:
            title = f"{name}_glow" if mesh.glow else name
            self.assets[f"{title}.obj"] = mesh.obj.encode()
            shine = 1.0 if mesh.unlit else min(mesh.glow, 1.0)
            material = self.spec.add_material(name=title, emission=shine, specular=0.0, shininess=0.0)
            material.textures[self.mujoco.mjtTextureRole.mjTEXROLE_RGB] = name
            shell = self.mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
            self.spec.add_mesh(name=title, file=f"{title}.obj", inertia=shell)
            seen = {"group": group, "contype": 0, "conaffinity": 0, "density": 0.0}
            body.add_geom(type=self.mujoco.mjtGeom.mjGEOM_MESH, meshname=title, material=title, **seen)


def _differences(run: FinishedRun, path: Path) -> list[str]:
    """In what a file, as MuJoCo reads it, differs from the run."""
    mujoco = library("mujoco")

    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        return [f"MuJoCo refuses it: {error}"]
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    found = {model.body(k).name: k for k in range(1, model.nbody) if not model.body(k).name.startswith("house/")}
    ours = {thing.id: thing for thing in run.objects}
    wrong = [f"{len(found)} bodies for {len(ours)} objects"] if set(found) != set(ours) else []
    for name in sorted(set(found) & set(ours)):
        wrong += [f"{name} {what}" for what in _body_differences(rigid_body(ours[name]), model, data, found[name])]
    return wrong


def _body_differences(body: Body, model: Any, data: Any, index: int) -> Iterator[str]:
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = data.xmat[index].reshape(3, 3), data.xpos[index]
    room = 1e-5 * (1 + np.abs(body.T_world_body[:3, 3]).max())
    if not np.abs(pose - body.T_world_body).max() < room:
        yield f"stands elsewhere, by {np.abs(pose - body.T_world_body).max():.2g}"
    if not np.isclose(model.body_mass[index], body.mass, rtol=1e-4):
        yield f"weighs {model.body_mass[index]:.4g} kg for {body.mass:.4g}"
    if (model.body_dofnum[index] == 6) != body.moves:
        yield "is free where it should be fixed" if not body.moves else "is fixed where it should be free"
    collide = sum(model.geom_contype[k] != 0 for k in np.flatnonzero(model.geom_bodyid == index))
    if collide != len(body.hulls):
        yield f"has {collide} hulls for {len(body.hulls)}"
