"""What trimesh and scikit-image do where wm has code of its own. See README.md."""

import csv
import io
import json
import pathlib
import struct
import subprocess
import sys
from collections.abc import Callable, Iterator

import numpy as np
import shapely
import trimesh
from PIL import Image
from scipy import ndimage
from skimage.feature import canny
from skimage.filters import apply_hysteresis_threshold
from skimage.measure import label
from skimage.morphology import isotropic_dilation
from trimesh.visual.material import PBRMaterial

from wm.color import to_linear, to_srgb
from wm.geometry import assemble_scene, build_ray_scene, cast, place_cameras
from wm.offline.furniture.solids import Solid, ball, extrude, lathe, volume
from wm.run import load_config
from wm.synth.canny import depth_edges, normalized_depth
from wm.synth.furnished import furnished_context
from wm.synth.verify import dilate, edge_recall

HERE = pathlib.Path(__file__).parent
RADIUS = 10  # pixels, the paper's at a width of 1376
Row = tuple[str, str, object]


def header(glb: bytes) -> dict:
    """The JSON of a GLB file."""
    return json.loads(glb[20 : 20 + struct.unpack_from("<I", glb, 12)[0]])


def glb_rows() -> Iterator[Row]:
    """trimesh's exporter against what our files need."""
    cube = trimesh.creation.box(bounds=[[0, 0, 0], [1, 2, 3]])
    uv = np.zeros((len(cube.vertices), 2))
    image = Image.fromarray(np.random.default_rng(0).integers(0, 256, (8, 8, 3), np.uint8))
    material = PBRMaterial(baseColorTexture=image, emissiveFactor=[3.0, 3.0, 3.0], baseColorFactor=[0.5, 0.5, 0.5, 1.0])
    cube.visual = trimesh.visual.TextureVisuals(uv=uv, material=material)
    scene = trimesh.Scene()
    scene.add_geometry(cube, node_name="chair 1")
    scene.add_geometry(cube.copy(), node_name="chair 2")
    written = scene.export(file_type="glb")
    found = header(written)
    unlit = PBRMaterial(extensions={"KHR_materials_unlit": {}})
    yield "glb", "an unlit material is written", "unlit" in json.dumps(header(_with(unlit).export(file_type="glb")))
    yield "glb", "sampler (CLAMP_TO_EDGE) is written", "samplers" in found
    bounds = next(a for a in found["accessors"] if a["type"] == "VEC3")
    yield "glb", "z up becomes y up", bounds["max"] != [1.0, 2.0, 3.0]
    yield "glb", "emissive factor written for 3 (the specification allows 1)", found["materials"][0]["emissiveFactor"][0]
    yield "glb", "KHR_materials_emissive_strength is written", "extensionsUsed" in found
    yield "glb", "materials of two meshes with one material", len(found["materials"])
    yield "glb", "images of two meshes with one image", len(found["images"])
    several = trimesh.Scene({"a": trimesh.creation.box(), "b": trimesh.creation.icosphere()})
    yield (
        "glb",
        "several primitives in one mesh can be written",
        any(len(mesh["primitives"]) > 1 for mesh in header(several.export(file_type="glb"))["meshes"]),
    )
    again = [scene.export(file_type="glb") == written, _from_another_process() == _from_another_process()]
    yield "glb", "same scene, same bytes, in one process / in two", f"{again[0]} / {again[1]}"


def _with(material: PBRMaterial) -> trimesh.Trimesh:
    """A box of a material."""
    box = trimesh.creation.box()
    box.visual = trimesh.visual.TextureVisuals(uv=np.zeros((8, 2)), material=material)
    return box


def _from_another_process() -> str:
    code = "import trimesh, hashlib; print(hashlib.sha256(trimesh.creation.box().export(file_type='glb')).hexdigest())"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def factor_rows() -> Iterator[Row]:
    """A base colour factor through trimesh's material, which holds 8 bits of linear light."""
    srgb = np.linspace(0, 1, 1001)
    held = np.array([PBRMaterial(baseColorFactor=[x, x, x, 1.0]).baseColorFactor[0] for x in to_linear(srgb)]) / 255
    off = 255 * np.abs(to_srgb(held) - srgb)
    yield "factor", "largest error of a base colour factor read by trimesh, of 255", round(float(off.max()), 2)


def dropped_rows() -> Iterator[Row]:
    """Colours at vertices of a mesh with a material, through Scene.dump."""
    mesh = trimesh.creation.box()
    mesh.visual = trimesh.visual.TextureVisuals(material=PBRMaterial())
    mesh.visual.vertex_attributes["color"] = np.zeros((8, 4), np.uint8)
    kept = trimesh.Scene([mesh]).dump()[0].visual.vertex_attributes
    yield "vertex colour", "survives Scene.dump beside a material", "color" in kept


def solid_rows() -> Iterator[Row]:
    """Turned and extruded shapes of both."""
    profile = [(0.0, 0.0), (0.2, 0.0), (0.1, 0.3), (0.15, 0.6), (0.0, 0.6)]
    open_profile = profile[1:-1]
    ring = shapely.Point(0, 0).buffer(0.5, 8).difference(shapely.Point(0, 0).buffer(0.2, 8))
    pairs: list[tuple[str, Callable[[], Solid], Callable[[], trimesh.Trimesh]]] = [
        (
            "lathe, profile to the axis",
            lambda: lathe(profile, 24),
            lambda: trimesh.creation.revolve(np.array(profile), sections=24),
        ),
        (
            "lathe, open profile",
            lambda: lathe(open_profile, 24),
            lambda: trimesh.creation.revolve(np.array(open_profile), sections=24),
        ),
        ("ball", lambda: ball((0, 0, 0), 0.5, 12), lambda: trimesh.creation.uv_sphere(radius=0.5, count=[6, 12])),
        ("extrude, a ring", lambda: extrude(ring, 0.0, 1.0, "z"), lambda: trimesh.creation.extrude_polygon(ring, 1.0)),
    ]
    for name, ours, theirs in pairs:
        mine = ours()
        closed = trimesh.Trimesh(mine.vertices, mine.faces, process=False).is_watertight
        yield "solid", f"{name}: ours", f"{len(mine.faces)} triangles, closed {closed}, volume {volume(mine):.5f}"
        try:
            other = theirs()
            same = np.array_equal(mine.vertices, other.vertices) and np.array_equal(mine.faces, other.faces)
            said = f"{len(other.faces)} triangles, closed {other.is_watertight}, volume {other.volume:.5f}, same arrays {same}"
        except (ImportError, ValueError) as error:
            said = f"{type(error).__name__}: {str(error).splitlines()[0]}"
        yield "solid", f"{name}: trimesh", said


def depth_maps() -> Iterator[np.ndarray]:
    """Depth of every training view of two furnished scenes, as verification compares it."""
    for scene in ("gothic", "scandinavian"):
        config = load_config([f"+scene={scene}", "preset=draft"])
        context = furnished_context(config)
        rays = build_ray_scene(assemble_scene(context.structure, context.objects))
        for view in place_cameras(context.plan, rays, config.cameras):
            yield cast(rays, view.camera).depth


def edge_rows() -> Iterator[Row]:
    """scikit-image's Canny and hysteresis against ours, which equal OpenCV's."""
    recall, back, equal, lines = [], [], 0, 0
    count = 0
    for depth in depth_maps():
        ours = depth_edges(depth, depth > 0, low=0.1, high=0.3)
        unit = normalized_depth(depth, depth > 0) / 255
        theirs = canny(unit, sigma=0, low_threshold=0.1, high_threshold=0.3)
        if not (ours.any() and theirs.any()):
            continue
        recall.append(edge_recall(ours, theirs, RADIUS))
        back.append(edge_recall(theirs, ours, RADIUS))
        equal += np.array_equal(ours, theirs)
        count += 1
        lines += int((ours != theirs).sum())
    yield "canny", "depth maps with edges", count
    yield "canny", "of them with the same pixels in both", equal
    yield "canny", "pixels that differ, a map", round(lines / max(count, 1))
    yield "canny", f"ours with one of theirs within {RADIUS} px, mean / least", f"{np.mean(recall):.3f} / {np.min(recall):.3f}"
    yield "canny", f"theirs with one of ours within {RADIUS} px, mean / least", f"{np.mean(back):.3f} / {np.min(back):.3f}"
    diagonal = np.where(np.eye(9, dtype=bool), 0.2, 0.0)
    diagonal[0, 0] = 0.9
    kept = int(apply_hysteresis_threshold(diagonal, 0.1, 0.3).sum())
    yield "canny", "pixels of a diagonal of 9 that apply_hysteresis_threshold keeps (OpenCV: 9)", kept


def mask_rows(trials: int = 2000) -> Iterator[Row]:
    """Labels and dilation of random masks."""
    rng = np.random.default_rng(0)
    labels = dilations = 0
    for _ in range(trials):
        mask = rng.random(rng.integers(1, 40, 2)) < rng.random()
        for connectivity, structure in ((1, None), (2, np.ones((3, 3)))):
            labels += np.array_equal(label(mask, connectivity=connectivity), ndimage.label(mask, structure)[0])
        radius = int(rng.integers(1, 12))
        dilations += not mask.any() or np.array_equal(isotropic_dilation(mask, radius), dilate(mask, radius))
    yield "mask", "skimage.measure.label equals SciPy's, share", labels / (2 * trials)
    yield "mask", "isotropic_dilation equals our dilate where anything is set, share", dilations / trials
    empty = np.zeros((20, 20), bool)
    yield (
        "mask",
        "pixels that isotropic_dilation(radius 5) sets of an empty mask (ours: 0)",
        int(isotropic_dilation(empty, 5).sum()),
    )


def main() -> None:
    rows: list[Row] = [row for make in (glb_rows, factor_rows, dropped_rows, solid_rows, edge_rows, mask_rows) for row in make()]
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([("what", "question", "answer"), *rows])
    (HERE / "result.csv").write_text(text.getvalue())
    print(text.getvalue())


if __name__ == "__main__":
    main()
