"""What three web renderers make of a run's splats: agreement with wm's render, first frame, memory. README.md has the results.

npm install @sparkjsdev/spark@2.2.0 three@0.180.0 @mkkellogg/gaussian-splats-3d@0.4.7 playcanvas@2.23.3
python experiments/viewer/measure.py RUN node_modules
"""

import base64
import io
import json
import shutil
import sys
from pathlib import Path

import numpy as np
import psutil
from PIL import Image
from playwright.sync_api import sync_playwright

from wm.finished import open_finished
from wm.splat.scene.scene_render import SceneRenderer
from wm.view.server import serve

PAGES = Path(__file__).parent / "pages"
ARGUMENTS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def main(folder, modules):
    run = open_finished(folder)
    view = run.views[0]
    pose = np.diag([1.0, -1.0, -1.0, 1.0])  # three.js's cameras look along -z with y up, wm's along z with y down
    pose = (np.linalg.inv(view.camera.T_cam_world) @ pose).tolist()
    told = {"pose": pose, "fov": float(2 * np.degrees(np.arctan(view.camera.height / 2 / view.camera.focal[1])))}
    site = {f"node_modules/{path.relative_to(modules).with_suffix('.js')}": path for path in scripts(modules)}
    site |= {"splats.ply": run.splats_file, "camera.json": json.dumps(told).encode()}
    site |= {path.name: path for path in PAGES.iterdir()}
    truth = SceneRenderer(run.gaussians_by_room, run.raster).render(view.camera, range(len(run.rooms))).rgb
    print(f"{len(run.gaussians.means)} gaussians, {run.splats_file.stat().st_size / 1e6:.1f} MB, {view.name}")
    with serve(site) as address, sync_playwright() as library:
        for page in sorted(PAGES.glob("*.html")):
            measure(library, f"{address}{page.name}", page.stem, view.camera, np.clip(np.asarray(truth), 0, 1))


def measure(library, address, name, camera, truth):
    browser = library.chromium.launch(executable_path=shutil.which("chromium"), args=ARGUMENTS)
    page = browser.new_page(viewport={"width": camera.width, "height": camera.height})
    page.on("pageerror", lambda error: print(name, error))
    page.on("console", lambda message: message.type == "error" and print(name, message.text))
    page.goto(address)
    page.wait_for_selector("body[data-state=done]", state="attached", timeout=120_000)
    first = page.evaluate("window.first") / 1000
    data = page.evaluate("window.picture").split(",")[1]
    picture = np.asarray(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB"), np.float64) / 255
    psnr = -10 * np.log10(np.mean((picture - truth) ** 2))
    print(f"{name}: PSNR {psnr:.1f} dB, first frame {first:.1f} s, {memory():.0f} MB")
    Image.fromarray((255 * np.concatenate([picture, truth])).astype(np.uint8)).save(f"{name}.png")
    browser.close()


def memory():
    """Megabytes (unique set size) of all processes of the browser."""
    return sum(one.memory_full_info().uss for one in psutil.Process().children(recursive=True) if "chrom" in one.name()) / 1e6


def scripts(modules):
    wanted = [
        "three/build/*.js",
        "three/examples/jsm/**/*.js",
        "@sparkjsdev/spark/dist/*.js",
        "@mkkellogg/gaussian-splats-3d/build/*.js",
    ]
    return [path for pattern in [*wanted, "playcanvas/build/playcanvas.min.mjs"] for path in modules.glob(pattern)]


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
