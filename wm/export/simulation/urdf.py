"""Target `urdf`: the house as a robot description, the format that ROS, Drake, Isaac and PyBullet read.

urdf/house.urdf and urdf/meshes. The building hangs on the link "house"; every object is a link of its id, joined to "house" by a
joint that is fixed, or floating where the object may move (yourdfpy's `split_along_joints` makes files of their own of those).
Meshes are named relative to the file. Hulls are boxes, or STL files of one convex solid each; looks are OBJ files with an image.
"""

import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from wm.export.records import Check, ExportError
from wm.export.simulation.bodies import Body
from wm.export.simulation.files import write_files
from wm.export.simulation.house import House, simulated
from wm.export.simulation.hulls import Hull
from wm.export.simulation.library import library
from wm.export.simulation.looks import Appearance, body_appearance
from wm.export.simulation.rotations import roll_pitch_yaw
from wm.export.simulation.shell import prisms
from wm.export.simulation.wavefront import mtl, obj_files, png, stl
from wm.finished import FinishedRun

FOLDER, MAIN = "urdf", "house.urdf"
ROOT = "house"


def write(run: FinishedRun, folder: Path) -> Sequence[Path]:
    """Writes urdf/house.urdf and its meshes, and loads it again.

    Raises:
      ExportError: yourdfpy refuses it, or reads other links than the run's.
    """
    house = simulated(run)
    paths = write_files(folder / FOLDER, _Description(run, house).files(), MAIN)
    wrong = _differences(house, paths[0])
    if wrong:
        raise ExportError(f"{paths[0]}: read back, {'; '.join(wrong[:5])}")
    return paths


def check(run: FinishedRun, folder: Path) -> Sequence[Check]:
    """Loads urdf/house.urdf with all of its meshes, lets yourdfpy validate it, and compares it with the run."""
    wrong = _differences(simulated(run), folder / FOLDER / MAIN)
    told = "; ".join(wrong[:5]) or f"{len(run.objects)} equal"
    return [Check("urdf", "links, masses, poses and meshes in yourdfpy", told, "equal", not wrong)]


class _Description:
    """The description under construction, and the files that it names."""

    def __init__(self, run: FinishedRun, house: House) -> None:
        self.run, self.house = run, house
        self.meshes: dict[str, bytes | str] = {}
        self.robot = ElementTree.Element("robot", name="house")

    def files(self) -> dict[str, bytes | str]:
        _element(self.robot, "link", name=ROOT)
        for part in self.house.parts:
            name = self.house.part_name(part)
            link = self._link(f"house/{name}", "fixed", np.eye(4))
            for k, look in enumerate(part.looks):
                self._add_look(link, look, f"house_{name}_{k}")
            for k, prism in enumerate(prisms(self.run.structure, part.faces)):
                self._add_hull(link, prism, f"house_{name}_{k}")
        for body, name in zip(self.house.bodies, self.house.names):
            self._add_body(body, name)
        ElementTree.indent(self.robot)
        text = ElementTree.tostring(self.robot, encoding="unicode", xml_declaration=True)
        return {MAIN: f"{text}\n", **{f"meshes/{name}": data for name, data in self.meshes.items()}}

    def _add_body(self, body: Body, name: str) -> None:
        link = self._link(body.id, "floating" if body.moves else "fixed", body.T_world_body)
        inertial = _element(link, "inertial")
        _element(inertial, "origin", xyz=_text(body.center), rpy="0 0 0")
        _element(inertial, "mass", value=_text([body.mass]))
        row, column = [0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]
        names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        _element(inertial, "inertia", **{key: _text([value]) for key, value in zip(names, body.inertia[row, column])})
        self._add_look(link, body_appearance(body), name)
        for k, hull in enumerate(body.hulls):
            self._add_hull(link, hull, f"{name}_{k}")

    def _link(self, name: str, joint: str, pose: np.ndarray) -> ElementTree.Element:
        link = _element(self.robot, "link", name=name)
        joined = _element(self.robot, "joint", name=f"{name}/joint", type=joint)
        _element(joined, "parent", link=ROOT)
        _element(joined, "child", link=name)
        _element(joined, "origin", xyz=_text(pose[:3, 3]), rpy=_text(roll_pitch_yaw(pose[:3, :3])))
        return link

    def _add_look(self, link: ElementTree.Element, look: Appearance, name: str) -> None:
        files = obj_files(look, name)
        self.meshes |= {f"{name}.png": png(files.image), f"{name}.mtl": mtl(name, f"{name}.png")}
        for mesh in files.meshes:
            title = f"{name}_glow" if mesh.glow else name
            self.meshes[f"{title}.obj"] = mesh.obj
            visual = _element(link, "visual", name=title)
            _element(_element(visual, "geometry"), "mesh", filename=f"meshes/{title}.obj")

    def _add_hull(self, link: ElementTree.Element, hull: Hull, name: str) -> None:
        collision = _element(link, "collision", name=name)
        if hull.box is not None:
            center, size = hull.box
            _element(collision, "origin", xyz=_text(center), rpy="0 0 0")
            _element(_element(collision, "geometry"), "box", size=_text(size))
            return
        self.meshes[f"{name}.stl"] = stl(hull)
        _element(_element(collision, "geometry"), "mesh", filename=f"meshes/{name}.stl")


def _element(parent: ElementTree.Element, tag: str, **attributes: str) -> ElementTree.Element:
    return ElementTree.SubElement(parent, tag, attributes)


def _text(numbers: Sequence[float] | np.ndarray) -> str:
    return " ".join(f"{float(number) + 0.0:.9g}" for number in numbers)


def _differences(house: House, path: Path) -> list[str]:
    """In what a file, as yourdfpy reads it, differs from the house."""
    yourdfpy = library("yourdfpy")

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of trimesh about how yourdfpy calls it
            urdf = yourdfpy.URDF.load(str(path), build_collision_scene_graph=True, load_collision_meshes=True)
    except Exception as error:  # a parser that is handed anything raises anything
        return [f"yourdfpy refuses it: {error}"]
    if not urdf.validate():
        return [f"yourdfpy finds errors: {'; '.join(str(error) for error in urdf.errors)}"]
    lost = sorted(name for name in _mesh_names(urdf) if not (path.parent / name).is_file())
    if lost:
        return [f"{len(lost)} of its meshes are not there, such as {lost[0]}"]
    links = {name: link for name, link in urdf.link_map.items() if name != ROOT and not name.startswith("house/")}
    ours = {body.id: body for body in house.bodies}
    wrong = [f"{len(links)} links for {len(ours)} objects"] if set(links) != set(ours) else []
    for name in sorted(set(links) & set(ours)):
        wrong += [f"{name} {what}" for what in _link_differences(ours[name], urdf, links[name])]
    return wrong


def _link_differences(body: Body, urdf: Any, link: Any) -> Iterator[str]:
    if f"{link.name}/joint" not in urdf.joint_map:
        yield "has no joint"
        return
    gap = np.abs(urdf.get_transform(link.name, ROOT) - body.T_world_body).max()
    if not gap < 1e-6 * (1 + np.abs(body.T_world_body[:3, 3]).max()):
        yield f"stands elsewhere, by {gap:.2g}"
    inertial = link.inertial
    if inertial is None:
        yield "has no mass"
        return
    if not np.isclose(inertial.mass, body.mass, rtol=1e-6):
        yield f"weighs {inertial.mass:.4g} kg for {body.mass:.4g}"
    if not np.allclose(inertial.inertia, body.inertia, rtol=1e-6, atol=1e-12):
        yield "has another inertia"
    if len(link.collisions) != len(body.hulls):
        yield f"has {len(link.collisions)} hulls for {len(body.hulls)}"
    kind = urdf.joint_map[f"{link.name}/joint"].type
    if (kind == "floating") != body.moves:
        yield f"has a {kind} joint"


def _mesh_names(urdf: Any) -> set[str]:
    shapes = [shape.geometry for link in urdf.robot.links for shape in (*link.visuals, *link.collisions)]
    return {shape.mesh.filename for shape in shapes if shape.mesh is not None}
