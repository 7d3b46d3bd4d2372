// The page: loads a run's files and joins canvas, visitor, map, labels and buttons.
import { Plane, Vector3 } from "three";
import { Keys } from "./keys.js";
import { Labels } from "./labels.js";
import { cameraLayer, colliderLayer, fetched, hidingLayer, navmeshLayer, scaffoldLayer, SplatCut, splatLayer } from "./layers.js";
import { Minimap } from "./minimap.js";
import { Stage } from "./stage.js";
import { Visitor } from "./visitor.js";

const LONGEST = 0.1; // seconds that one frame may stand for, so that a slow one takes nobody through half a room
const CUT = 0.35; // metres under the lowest ceiling at which the house is cut open in orbit mode
const AROUND = 0x161617; // around the house in orbit; on foot what no splat covers is black, as in wm's renders
const OVERLAYS = ["collider", "navmesh", "cameras"];
const $ = (id) => document.getElementById(id);
const json = async (url) => JSON.parse(new TextDecoder().decode(await fetched(url)));

class Viewer {
  constructor(world, navmesh) {
    this.world = world;
    this.stage = new Stage($("canvas"), world.raster);
    this.visitor = new Visitor(this.stage, world, navmesh);
    this.labels = new Labels($("label"), this.stage.camera, world);
    this.map = new Minimap($("map"), world, (position) => this.visitor.stand(position));
    this.keys = new Keys((event) => this.pressed(event));
    this.layers = { navmesh: navmeshLayer(navmesh), cameras: cameraLayer(world.cameras) };
    this.cut = new SplatCut();
    this.height = Math.min(...world.rooms.map((room) => room.height)) - CUT;
    this.cut.at(this.height);
    this.shown = { splats: true, scaffold: false, collider: false, navmesh: false, cameras: false };
    this.roomShown = null;
    for (const name of ["navmesh", "cameras"]) this.add(name, this.layers[name]);
    this.buttons();
    const first = world.rooms.findIndex((room) => room.spawn);
    if (first >= 0) this.visitor.goTo(first);
    else this.setMode("orbit");
    this.clock = performance.now();
    requestAnimationFrame((now) => this.loop(now));
  }

  add(name, layer) {
    this.layers[name] = layer;
    layer.visible = this.shown[name] ?? false;
    this.stage.scene.add(layer);
    this.stage.invalidate();
  }

  async load() {
    const splats = await splatLayer("splats.ply", (done, total) => progress("splats", done, total));
    this.add("splats", splats);
    this.setMode(this.visitor.mode);
    $("loading").hidden = true;
    const scaffold = await scaffoldLayer("scaffold.glb");
    this.labels.scaffold = scaffold;
    this.add("scaffold", scaffold);
    this.add("collider", colliderLayer(scaffold));
    this.add("hidden", hidingLayer(scaffold));
    this.toggle("collider", false);
    for (const name of ["scaffold", "collider"]) $(`show-${name}`).disabled = false;
  }

  loop(now) {
    const seconds = Math.min((now - this.clock) / 1000, LONGEST);
    this.clock = now;
    this.visitor.step(this.keys, seconds);
    if (this.stage.frame()) this.tell();
    requestAnimationFrame((next) => this.loop(next));
  }

  // Map, room and camera as they are now.
  tell() {
    const { position, heading } = this.visitor.onMap;
    const { room } = this.visitor;
    this.map.show(position, heading, room);
    if (room >= 0) [$("rooms").value, this.roomShown] = [String(room), room];
    const place = this.visitor.mode === "orbit" ? "The whole house" : (this.world.rooms[this.roomShown]?.name ?? "");
    if ($("where").textContent !== place) $("where").textContent = place; // written only when it changes: it is read aloud
    if (!this.visitor.still) $("cameras").value = "";
  }

  toggle(name, on = !this.shown[name]) {
    this.shown[name] = on;
    $(`show-${name}`).setAttribute("aria-pressed", String(on));
    if (this.layers[name]) this.layers[name].visible = on;
    if (this.layers.hidden) this.layers.hidden.visible = OVERLAYS.some((one) => this.shown[one]);
    this.stage.invalidate();
  }

  // On foot the house is whole, in orbit it is cut open under the ceiling.
  setMode(mode) {
    if (mode === "walk" && this.visitor.walk.position === null) this.visitor.walk.place([0, 0]);
    if (mode !== this.visitor.mode || mode === "orbit") this.visitor.setMode(mode);
    const open = mode === "orbit";
    document.body.dataset.mode = mode;
    for (const one of ["walk", "orbit"]) $(one).setAttribute("aria-pressed", String(one === mode));
    if (open) this.stage.scene.add(this.cut.edit);
    else this.cut.edit.removeFromParent();
    this.stage.renderer.setClearColor(open ? AROUND : 0);
    this.stage.renderer.clippingPlanes = open ? [new Plane(new Vector3(0, -1, 0), this.height)] : [];
    this.labels.hide();
    this.stage.invalidate();
  }

  goTo(k) {
    this.setMode("walk");
    this.visitor.goTo(k);
  }

  lookThrough(name) {
    this.setMode("walk");
    this.visitor.lookThrough(name);
    $("cameras").value = name;
  }

  // Once nothing is left to load, sort or draw.
  async settled() {
    await this.loaded;
    this.stage.invalidate();
    this.stage.quiet = 0;
    while (this.stage.quiet < 12) await new Promise(requestAnimationFrame);
  }

  async save() {
    const room = this.visitor.room;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(await this.stage.picture());
    link.download = `${[this.world.theme, room < 0 ? "house" : this.world.rooms[room].name].join(" ").replace(/\W+/g, "-").slice(0, 60)}.png`;
    link.click();
    URL.revokeObjectURL(link.href);
  }

  pressed(event) {
    const { key } = event;
    const layer = ["splats", "scaffold", "collider", "navmesh", "cameras"][Number(key) - 1];
    if (layer && !$(`show-${layer}`).disabled) this.toggle(layer);
    else if (key === "o") this.setMode(this.visitor.mode === "walk" ? "orbit" : "walk");
    else if (key === "p") this.save();
    else if (key === "h") document.body.classList.toggle("bare");
    else if (key === "l") this.lock();
    else if (key === "n" || key === "b") this.nextRoom(key === "n" ? 1 : -1);
    else if (key === "?") $("help").toggleAttribute("open");
  }

  nextRoom(step) {
    const { rooms } = this.world;
    const now = this.visitor.room >= 0 ? this.visitor.room : (this.roomShown ?? 0);
    let k = now;
    do k = (k + step + rooms.length) % rooms.length;
    while (!rooms[k].spawn && k !== now);
    if (rooms[k].spawn) this.goTo(k);
  }

  lock() {
    if (document.pointerLockElement) document.exitPointerLock();
    else if (this.visitor.mode === "walk") $("canvas").requestPointerLock?.();
  }

  buttons() {
    const { world } = this;
    document.title = `${world.theme} · wm`;
    $("theme").textContent = world.theme;
    world.rooms.forEach((room, k) => room.spawn && $("rooms").add(new Option(room.name, String(k))));
    for (const room of world.rooms) {
      const group = document.createElement("optgroup");
      group.label = room.name;
      for (const { name, room: id } of world.cameras) if (id === room.id) group.append(new Option(name.split("/").pop(), name));
      if (group.children.length) $("cameras").append(group);
    }
    $("rooms").addEventListener("change", (event) => (this.goTo(Number(event.target.value)), event.target.blur()));
    $("cameras").addEventListener("change", (event) => (event.target.value && this.lookThrough(event.target.value), event.target.blur()));
    for (const mode of ["walk", "orbit"]) $(mode).addEventListener("click", () => this.setMode(mode));
    for (const name of Object.keys(this.shown)) $(`show-${name}`).addEventListener("click", () => this.toggle(name));
    $("save").addEventListener("click", () => this.save());
    $("eye").value = String(this.visitor.eye);
    $("eye").addEventListener("input", (event) => {
      this.visitor.eye = Number(event.target.value);
      $("eye-value").textContent = `${this.visitor.eye.toFixed(2)} m`;
      this.visitor.placeCamera();
    });
    $("eye-value").textContent = `${this.visitor.eye.toFixed(2)} m`;
    let last = 0;
    $("canvas").addEventListener("pointermove", (event) => {
      if (event.buttons || document.pointerLockElement || event.timeStamp - last < 50) return event.buttons && this.labels.hide();
      last = event.timeStamp;
      this.labels.show(event.clientX, event.clientY);
    });
    $("canvas").addEventListener("pointerleave", () => this.labels.hide());
    $("canvas").addEventListener("pointerdown", (event) => {
      document.activeElement?.blur();
      $("canvas").setPointerCapture(event.pointerId);
    });
    $("canvas").addEventListener("dblclick", () => this.lock());
  }
}

function progress(what, done, total) {
  const share = total ? done / total : null;
  const bar = $("bar");
  if (share === null) bar.removeAttribute("value");
  else bar.value = share;
  $("loaded").textContent = `${what}: ${(done / 1e6).toFixed(1)}${total ? ` of ${(total / 1e6).toFixed(1)}` : ""} MB`;
}

function failed(error) {
  document.body.dataset.state = "failed";
  $("loading").hidden = false;
  $("loaded").textContent = `This could not be opened: ${error.message}`;
}

async function start() {
  try {
    const viewer = new Viewer(await json("world.json"), await json("navmesh.json"));
    viewer.loaded = viewer.load();
    window.viewer = viewer;
    await viewer.loaded;
    const name = decodeURIComponent(window.location.hash.slice(1));
    if (viewer.world.cameras.some((camera) => camera.name === name)) viewer.lookThrough(name);
    document.body.dataset.state = "ready";
  } catch (error) {
    failed(error);
    throw error;
  }
}

start();
