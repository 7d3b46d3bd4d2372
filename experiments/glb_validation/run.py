"""Writes GLB files of several kinds and asks the Khronos validator about them. See README.md."""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))  # the plan generator lives with the tests
from tests.geometry.mesh.test_glb import quad
from tests.geometry.mesh.test_scene_mesh import wedge
from tests.geometry.plans import random_plan
from wm.geometry import GlbNode, atlas_nodes, build_atlas, build_structure, object_nodes, save_glb

HERE = Path(__file__).parent
VALIDATOR = "gltf-validator@2.0.0-dev.3.10"


def write_cases(folder: Path) -> list[Path]:
    """One file a case: nothing, things that glow, textures, a scaffold with its atlas, a building 9 km from the origin."""
    mesh = build_structure(random_plan(2, 6))
    skin = GlbNode("scaffold", mesh.vertices, mesh.faces, base_color=np.array([0.8, 0.8, 0.8]))
    objects = object_nodes([wedge(seed) for seed in range(5)])
    cases = {
        "nothing": [],
        "objects": objects,
        "textured": [quad(), quad(name="copy", texture=quad().texture), quad(name="screen", emission=3.0)],
        "scene": [skin, *objects, quad()],
        "atlas": [*atlas_nodes(build_atlas(mesh, 0.05), mesh), *objects],
        "far": [GlbNode("scaffold", mesh.vertices + 9000.0, mesh.faces)],
    }
    for name, nodes in cases.items():
        save_glb(folder / f"{name}.glb", nodes)
    return [folder / f"{name}.glb" for name in cases]


def validate(files: list[Path], folder: Path) -> list[dict]:
    """The validator's counts for each file; `folder` is where npm may put it."""
    shutil.copy(HERE / "validate.mjs", folder)
    subprocess.run(["npm", "install", "--silent", "--no-save", "--prefix", folder, VALIDATOR], check=True)
    command = ["node", folder / "validate.mjs", *(path.resolve() for path in files)]
    run = subprocess.run(command, check=True, capture_output=True, text=True)
    return [json.loads(line) for line in run.stdout.splitlines()]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path, help="GLB files to validate instead of the built-in cases")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        results = validate(arguments.files or write_cases(folder), folder)
    for result in results:
        result["path"] = Path(result["path"]).name
        print(json.dumps(result))
    if not arguments.files:
        (HERE / "results.json").write_text(json.dumps(results, indent=2) + "\n")
    sys.exit(any(result["numErrors"] for result in results))


if __name__ == "__main__":
    main()
