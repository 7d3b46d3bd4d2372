"""The stage of target `usd`: prims of rooms, objects, colliders and materials. usd-core is imported when it is built."""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from wm.color import to_linear
from wm.export.simulation.bodies import Body
from wm.export.simulation.house import House
from wm.export.simulation.hulls import Hull
from wm.export.simulation.identifiers import identifiers
from wm.export.simulation.library import library
from wm.export.simulation.looks import Appearance, HousePart, body_appearance
from wm.export.simulation.rotations import quaternion
from wm.export.simulation.shell import prisms
from wm.export.simulation.wavefront import png
from wm.finished import FinishedRun
from wm.types import SurfaceKind

SCAFFOLD, SPLATS = "/House/Scaffold", "/House/Splats"
SKY = 1.0  # intensity of the dome light: a white sky


def stage_files(run: FinishedRun, house: House, main: str, splats: str | None) -> dict[str, bytes]:
    """The stage under the name `main` and the textures that it names; `splats` is the file of /House/Splats, if there is one."""
    stage = _Stage(run, house)
    stage.add_all(splats)
    return {main: layer_bytes(stage.layer), **stage.textures}


def layer_bytes(layer: Any) -> bytes:
    """A layer as a binary USD file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "layer.usdc"
        layer.Export(str(path))
        return path.read_bytes()


class _Stage:
    """The stage under construction."""

    def __init__(self, run: FinishedRun, house: House) -> None:
        Gf, Kind, Sdf, Usd, UsdGeom, UsdLux, UsdPhysics, UsdSemantics, UsdShade = (
            library(f"pxr.{name}")
            for name in ("Gf", "Kind", "Sdf", "Usd", "UsdGeom", "UsdLux", "UsdPhysics", "UsdSemantics", "UsdShade")
        )

        self.Gf, self.Sdf, self.UsdGeom, self.UsdLux, self.UsdPhysics = Gf, Sdf, UsdGeom, UsdLux, UsdPhysics
        self.UsdSemantics, self.UsdShade = UsdSemantics, UsdShade
        self.run, self.house = run, house
        self.textures: dict[str, bytes] = {}
        self._images: dict[
            int, tuple[str, np.ndarray]
        ] = {}  # id of an array, its file, and the array, so that the id stays its own
        self._materials: dict[tuple[Any, ...], Any] = {}
        self.layer: Any = Sdf.Layer.CreateAnonymous(".usdc")
        self.stage: Any = Usd.Stage.Open(self.layer, Usd.Stage.LoadNone)
        UsdGeom.SetStageUpAxis(self.stage, UsdGeom.Tokens.z)
        UsdGeom.SetStageMetersPerUnit(self.stage, 1.0)
        UsdPhysics.SetStageKilogramsPerUnit(self.stage, 1.0)
        root = UsdGeom.Xform.Define(self.stage, "/House").GetPrim()
        self.stage.SetDefaultPrim(root)
        Usd.ModelAPI(root).SetKind(Kind.Tokens.assembly)

    def add_all(self, splats: str | None) -> None:
        gravity = self.UsdPhysics.Scene.Define(self.stage, "/House/PhysicsScene")
        gravity.CreateGravityDirectionAttr(self.Gf.Vec3f(0, 0, -1))
        gravity.CreateGravityMagnitudeAttr(9.81)
        self.UsdLux.DomeLight.Define(self.stage, "/House/Sky").CreateIntensityAttr(SKY)
        self.stage.DefinePrim("/House/Looks", "Scope")
        self.UsdGeom.Xform.Define(self.stage, SCAFFOLD)
        for name, room in zip(self.house.rooms, self.run.plan.rooms):
            prim = self.UsdGeom.Xform.Define(self.stage, f"{SCAFFOLD}/{name}").GetPrim()
            self._label(prim, room.name, room.id)
        for part in self.house.parts:
            self._add_part(part)
        for body, name in zip(self.house.bodies, self.house.names):
            self._add_body(body, f"{SCAFFOLD}/{self.house.rooms[body.thing.room]}/{name}")
        if splats is not None:
            self.stage.DefinePrim(SPLATS, "Xform").GetPayloads().AddPayload(f"./{splats}")
            self._add_variants()

    def _add_variants(self) -> None:
        """What is shown: meshes, gaussians, or both, which lie on each other."""
        root = self.stage.GetPrimAtPath("/House")
        shows = root.GetVariantSets().AddVariantSet("shows")
        for variant, hidden in (("scaffold", SPLATS), ("splats", SCAFFOLD), ("both", None)):
            shows.AddVariant(variant)
            if hidden is not None:
                shows.SetVariantSelection(variant)
                with shows.GetVariantEditContext():
                    self.UsdGeom.Imageable(self.stage.GetPrimAtPath(hidden)).MakeInvisible()
        shows.SetVariantSelection("scaffold")

    def _add_part(self, part: HousePart) -> None:
        kind = part.kind.name.lower()
        path = f"{SCAFFOLD}/{kind}" if part.room < 0 else f"{SCAFFOLD}/{self.house.rooms[part.room]}/{kind}"
        prim = self.UsdGeom.Xform.Define(self.stage, path).GetPrim()
        self._label(prim, {SurfaceKind.PANE: "window", SurfaceKind.EXTERIOR: "wall"}.get(part.kind, kind), None)
        for k, look in enumerate(part.looks):
            self._add_mesh(f"{path}/mesh_{k}", look)
        self._add_hulls(path, prisms(self.run.structure, part.faces))

    def _add_body(self, body: Body, path: str) -> None:
        xform = self.UsdGeom.Xform.Define(self.stage, path)
        xform.AddTransformOp().Set(self.Gf.Matrix4d(body.T_world_body.T.tolist()))
        prim = xform.GetPrim()
        self._label(prim, body.thing.label, body.id)
        self.UsdPhysics.RigidBodyAPI.Apply(prim).CreateRigidBodyEnabledAttr(body.moves)
        mass = self.UsdPhysics.MassAPI.Apply(prim)
        mass.CreateMassAttr(body.mass)
        mass.CreateCenterOfMassAttr(self.Gf.Vec3f(*body.center.tolist()))
        moments, axes = np.linalg.eigh(body.inertia)
        axes = axes * np.sign(np.linalg.det(axes))
        mass.CreateDiagonalInertiaAttr(self.Gf.Vec3f(*moments.tolist()))
        mass.CreatePrincipalAxesAttr(self.Gf.Quatf(*quaternion(axes).tolist()))
        self._add_mesh(f"{path}/mesh", body_appearance(body), double_sided=True)
        self._add_hulls(path, body.hulls)

    def _label(self, prim: Any, label: str, title: str | None) -> None:
        self.UsdSemantics.LabelsAPI.Apply(prim, "category").CreateLabelsAttr([label])
        if title is not None:
            prim.SetDisplayName(title)

    def _add_hulls(self, path: str, hulls: Any) -> None:
        if not hulls:
            return
        scope = self.UsdGeom.Xform.Define(self.stage, f"{path}/colliders")
        scope.CreatePurposeAttr(self.UsdGeom.Tokens.guide)
        for k, hull in enumerate(hulls):
            self.UsdPhysics.CollisionAPI.Apply(self._hull(f"{path}/colliders/hull_{k}", hull))

    def _hull(self, path: str, hull: Hull) -> Any:
        if hull.box is not None:
            center, size = hull.box
            cube = self.UsdGeom.Cube.Define(self.stage, path)
            cube.CreateSizeAttr(1.0)
            cube.CreateExtentAttr([(-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)])
            cube.AddTranslateOp().Set(self.Gf.Vec3d(*center.tolist()))
            cube.AddScaleOp().Set(self.Gf.Vec3f(*size.tolist()))
            return cube.GetPrim()
        prim = self._mesh(path, hull.vertices, hull.faces).GetPrim()
        self.UsdPhysics.MeshCollisionAPI.Apply(prim).CreateApproximationAttr(self.UsdPhysics.Tokens.convexHull)
        return prim

    def _mesh(self, path: str, vertices: np.ndarray, faces: np.ndarray) -> Any:
        Vt = library("pxr.Vt")

        mesh = self.UsdGeom.Mesh.Define(self.stage, path)
        points = np.ascontiguousarray(vertices, np.float32)
        mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
        mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(faces), 3, np.int32)))
        mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(np.ascontiguousarray(faces.reshape(-1), np.int32)))
        mesh.CreateSubdivisionSchemeAttr(self.UsdGeom.Tokens.none)
        mesh.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(np.stack([points.min(axis=0), points.max(axis=0)])))
        return mesh

    def _add_mesh(self, path: str, look: Appearance, *, double_sided: bool = False) -> None:
        """The surface, a subset of its faces for each of its materials."""
        Vt = library("pxr.Vt")

        mesh = self._mesh(path, look.vertices, look.faces)
        mesh.CreateDoubleSidedAttr(double_sided)
        if look.texture is not None:
            uv = look.texture.corner_uv.reshape(-1, 2) * np.array([1, -1]) + np.array([0, 1])  # USD counts v upward
            primvar = self.UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(
                "st", self.Sdf.ValueTypeNames.TexCoord2fArray, self.UsdGeom.Tokens.faceVarying
            )
            primvar.Set(Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(uv, np.float32)))
        used = np.unique(look.face_slot).tolist()
        binding = self.UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim())
        if len(used) == 1:
            binding.Bind(self._material(look, used[0]))
            return
        for slot, name in zip(used, identifiers([look.slots[slot] for slot in used])):
            faces = Vt.IntArray.FromNumpy(np.flatnonzero(look.face_slot == slot).astype(np.int32))
            subset = binding.CreateMaterialBindSubset(name, faces)
            self.UsdShade.MaterialBindingAPI.Apply(subset.GetPrim()).Bind(self._material(look, slot))
        binding.SetMaterialBindSubsetsFamilyType(self.UsdGeom.Tokens.partition)

    def _material(self, look: Appearance, slot: int) -> Any:
        """The material of a slot; equal ones are one prim."""
        image = look.texture.image if look.texture is not None and look.texture.slots[slot] else None
        color, glow = tuple(look.slot_colors[slot].tolist()), float(look.emission[slot])
        key = (
            look.slots[slot],
            color if image is None else None,
            glow,
            look.unlit,
            None if image is None else self._image(image),
        )
        if key not in self._materials:
            name = identifiers([*(material.GetPrim().GetName() for material in self._materials.values()), look.slots[slot]])[-1]
            self._materials[key] = self._define_material(f"/House/Looks/{name}", color, glow, look.unlit, key[-1])
        return self._materials[key]

    def _image(self, image: np.ndarray) -> str:
        """The file of an image."""
        if id(image) not in self._images:
            name = f"textures/image_{len(self._images)}.png"
            self._images[id(image)] = (name, image)
            self.textures[name] = png(image)
        return self._images[id(image)][0]

    def _define_material(self, path: str, color: tuple[float, ...], glow: float, unlit: bool, file: str | None) -> Any:
        types, shade = self.Sdf.ValueTypeNames, self.UsdShade
        material = shade.Material.Define(self.stage, path)
        surface = shade.Shader.Define(self.stage, f"{path}/surface")
        surface.CreateIdAttr("UsdPreviewSurface")
        surface.CreateInput("roughness", types.Float).Set(0.8)
        material.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
        linear = to_linear(np.asarray(color, np.float64))
        plain = self.Gf.Vec3f(*(np.zeros(3) if unlit else linear).tolist())
        diffuse, emissive = surface.CreateInput("diffuseColor", types.Color3f), None
        diffuse.Set(plain)
        if glow > 0 or unlit:
            emissive = surface.CreateInput("emissiveColor", types.Color3f)
            emissive.Set(self.Gf.Vec3f(*(linear * glow).tolist()))
        if file is not None:
            pixels = self._texture_output(path, file, glow if glow > 0 else 1.0)
            (diffuse if emissive is None else emissive).ConnectToSource(pixels)
        return material

    def _texture_output(self, path: str, file: str, scale: float) -> Any:
        types, shade = self.Sdf.ValueTypeNames, self.UsdShade
        reader = shade.Shader.Define(self.stage, f"{path}/st")
        reader.CreateIdAttr("UsdPrimvarReader_float2")
        reader.CreateInput("varname", types.String).Set("st")
        texture = shade.Shader.Define(self.stage, f"{path}/image")
        texture.CreateIdAttr("UsdUVTexture")
        texture.CreateInput("file", types.Asset).Set(f"./{file}")
        texture.CreateInput("sourceColorSpace", types.Token).Set("sRGB")
        texture.CreateInput("scale", types.Float4).Set(self.Gf.Vec4f(scale, scale, scale, 1.0))
        for wrap in ("wrapS", "wrapT"):
            texture.CreateInput(wrap, types.Token).Set("clamp")
        texture.CreateInput("st", types.Float2).ConnectToSource(reader.CreateOutput("result", types.Float2))
        return texture.CreateOutput("rgb", types.Float3)
