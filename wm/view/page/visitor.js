// Where the visitor is: on foot (on the navmesh, at eye height) or around the house (orbit).
import { Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { point, pose } from "./axes.js";
import { Walk } from "./walk.js";

const SPEED = 1.4; // metres a second, a person's walk
const RUN = 2.2; // times that with Shift
const TURN = 1.6; // radians a second
const LOOK = 0.0045; // radians a pixel of dragging
const STEEP = 1.45; // radians up or down at most

export class Visitor {
  constructor(stage, world, navmesh) {
    [this.stage, this.world] = [stage, world];
    this.walk = new Walk(navmesh);
    this.eye = world.eye_height;
    [this.heading, this.pitch] = [0, 0]; // radians, counter-clockwise from x; upwards
    this.camera = stage.camera;
    this.orbit = new OrbitControls(this.camera, stage.canvas);
    this.orbit.enabled = false;
    this.orbit.maxPolarAngle = 1.5;
    this.orbit.addEventListener("change", () => stage.invalidate());
    this.mode = "walk";
    this.still = null; // the run's camera that is looked through, if any
    stage.canvas.addEventListener("pointermove", (event) => this.drag(event));
  }

  get room() {
    return this.mode === "walk" ? this.walk.currentRoom : -1;
  }

  goTo(k) {
    const { position, heading } = this.world.rooms[k].spawn;
    this.stand(position, heading);
  }

  stand(position, heading = this.heading) {
    this.walk.place(position);
    [this.heading, this.pitch] = [heading, 0];
    this.setMode("walk");
  }

  // Looks through one of the run's cameras, with its field of view.
  lookThrough(name) {
    const camera = this.world.cameras.find((one) => one.name === name);
    if (!camera) throw new Error(`there is no camera ${name}`);
    this.setMode("walk");
    const at = pose(camera.T_world_cam);
    at.decompose(this.camera.position, this.camera.quaternion, new Vector3());
    const ahead = new Vector3(0, 0, -1).transformDirection(at);
    [this.heading, this.pitch] = [Math.atan2(-ahead.z, ahead.x), Math.asin(Math.max(-1, Math.min(1, ahead.y)))];
    this.walk.place([this.camera.position.x, -this.camera.position.z]);
    this.still = name;
    this.stage.lens = { tan: camera.height / 2 / camera.focal, aspect: camera.width / camera.height };
    this.stage.fit();
  }

  setMode(mode) {
    this.mode = mode;
    this.still = null;
    this.orbit.enabled = mode === "orbit";
    if (this.stage.lens) this.stage.lens = null;
    this.stage.fit();
    if (mode === "orbit") this.aboveTheHouse();
    else this.placeCamera();
  }

  aboveTheHouse() {
    const { low, high } = this.world.bounds;
    const middle = point([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, 0.8]);
    const size = Math.hypot(high[0] - low[0], high[1] - low[1]);
    this.orbit.target.copy(middle);
    this.orbit.maxDistance = 4 * size;
    const far = size * Math.max(0.95, 0.8 / Math.min(1, this.camera.aspect));
    this.camera.position.copy(middle).add(new Vector3(0.35, 0.95, 0.75).normalize().multiplyScalar(far));
    this.orbit.update();
  }

  placeCamera() {
    if (this.walk.position === null || this.still) return;
    const [x, y] = this.walk.position;
    this.camera.position.copy(point([x, y, this.eye]));
    const ahead = [Math.cos(this.heading) * Math.cos(this.pitch), Math.sin(this.heading) * Math.cos(this.pitch), Math.sin(this.pitch)];
    this.camera.up.set(0, 1, 0);
    this.camera.lookAt(this.camera.position.clone().add(point(ahead)));
    this.stage.invalidate();
  }

  leaveStill() {
    if (!this.still) return;
    this.still = null;
    this.stage.lens = null;
    this.stage.fit();
  }

  look(dx, dy) {
    this.leaveStill();
    this.heading += dx;
    this.pitch = Math.max(-STEEP, Math.min(STEEP, this.pitch + dy));
    this.placeCamera();
  }

  drag(event) {
    const locked = document.pointerLockElement === this.stage.canvas;
    if (this.mode !== "walk" || (!locked && !(event.buttons & 1))) return;
    const sign = locked ? -1 : 1; // dragging moves the picture, a locked pointer the eyes
    this.look(sign * event.movementX * LOOK, sign * event.movementY * LOOK);
  }

  // What the held keys do in some seconds.
  step(keys, seconds) {
    if (!keys.any) return;
    const [ahead, aside] = [keys.axis("forward", "back"), keys.axis("right", "left")];
    const [turn, tilt] = [keys.axis("turnLeft", "turnRight") * TURN * seconds, keys.axis("up", "down") * TURN * seconds];
    if (this.mode === "orbit") {
      this.circle(turn + aside * TURN * seconds, ahead * TURN * seconds, tilt);
      return;
    }
    this.leaveStill();
    const far = (SPEED * (keys.fast ? RUN : 1) * seconds) / Math.max(1, Math.hypot(ahead, aside));
    const [cos, sin] = [Math.cos(this.heading), Math.sin(this.heading)];
    if (ahead || aside) this.walk.move((cos * ahead + sin * aside) * far, (sin * ahead - cos * aside) * far);
    this.look(turn, tilt);
  }

  // Around the house by keys: left and right turn, up and down tilt, Page Up and Page Down come nearer and go away.
  circle(turn, tilt, nearer) {
    const offset = this.camera.position.clone().sub(this.orbit.target);
    const length = offset.length() * Math.exp(-nearer);
    const angle = Math.atan2(offset.x, offset.z) - turn;
    const height = Math.max(0.05, Math.min(1.5, Math.asin(offset.y / offset.length()) + tilt));
    const flat = Math.cos(height) * length;
    this.camera.position.copy(this.orbit.target).add(new Vector3(Math.sin(angle) * flat, Math.sin(height) * length, Math.cos(angle) * flat));
    this.orbit.update();
    this.stage.invalidate();
  }

  // Position and heading for the map, in wm's plane.
  get onMap() {
    if (this.mode === "walk" && this.walk.position && !this.still) return { position: this.walk.position, heading: this.heading };
    const ahead = this.camera.getWorldDirection(new Vector3());
    return { position: [this.camera.position.x, -this.camera.position.z], heading: Math.atan2(-ahead.z, ahead.x) };
  }
}
