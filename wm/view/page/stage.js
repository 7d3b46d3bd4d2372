// The canvas: three.js and Spark with the settings under which a picture agrees with wm's own renders. It draws when something
// has changed, and not otherwise.
import * as THREE from "three";
import { SparkRenderer } from "spark";

// wm adds 0.3 px^2 to a projected covariance and leaves opacities as they are (preBlur); it sorts by depth along the view; the
// last deviation is where an opacity of 1 falls under the 1/255 below which wm drops contributions: sqrt(2 ln 255).
function sparkSettings(raster) {
  const [preBlurAmount, blurAmount] = raster.antialias ? [0, raster.blur] : [raster.blur, 0];
  const maxStdDev = Math.sqrt(2 * Math.log(1 / raster.alpha_min));
  return { preBlurAmount, blurAmount, maxStdDev, minAlpha: raster.alpha_min, sortRadial: false, accumExtSplats: true };
}

export class Stage {
  constructor(canvas, raster) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: false, powerPreference: "high-performance" });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(70, 1, raster.near, 200);
    this.changed = true;
    this.quiet = 0; // frames since something changed
    this.spark = new SparkRenderer({ renderer: this.renderer, onDirty: () => this.invalidate(), ...sparkSettings(raster) });
    this.scene.add(this.spark);
    this.lens = null; // {tan, aspect}: what is to be seen whole; null for the default field of view
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  invalidate() {
    this.changed = true;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.fit();
  }

  // Sets the vertical field of view: 65 degrees, more in a tall window, or so that a camera's whole image is in view.
  fit() {
    const { aspect } = this.camera;
    const tan = this.lens ? this.lens.tan * Math.max(1, this.lens.aspect / aspect) : Math.tan(0.5672) * Math.max(1, 0.9 / aspect);
    this.camera.fov = (2 * Math.atan(tan) * 180) / Math.PI;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  // Draws if something has changed. Returns whether it drew.
  frame() {
    const busy = this.spark.sorting || this.spark.sortDirty;
    if (!this.changed && !busy) {
      this.quiet += 1;
      return false;
    }
    this.changed = false;
    this.quiet = busy ? 0 : this.quiet;
    this.draw();
    return true;
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
  }

  // The picture as a PNG. It is drawn anew, since a canvas does not keep what it has shown.
  picture() {
    this.draw();
    return new Promise((resolve) => this.canvas.toBlob(resolve, "image/png"));
  }
}
