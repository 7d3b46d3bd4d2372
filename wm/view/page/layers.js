// What can be shown: splats, the textured scaffold, the navmesh, the building's walls and the run's cameras.
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { SplatEdit, SplatEditSdf, SplatEditSdfType, SplatFileType, SplatMesh } from "spark";
import { point, pose } from "./axes.js";

// A file's bytes; progress(done, total) is told as they come, total 0 where the server does not say.
export async function fetched(url, progress = () => {}) {
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${url}: ${answer.status} ${answer.statusText}`);
  const total = Number(answer.headers.get("Content-Length")) || 0;
  const reader = answer.body.getReader();
  const parts = [];
  let done = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    parts.push(part.value);
    done += part.value.length;
    progress(done, total);
  }
  const bytes = new Uint8Array(done);
  parts.reduce((at, part) => (bytes.set(part, at), at + part.length), 0);
  return bytes;
}

// Gaussians in 32 bits and not as Spark packs them by default, so that pictures agree with wm's (experiments/viewer).
export async function splatLayer(url, progress) {
  const fileBytes = await fetched(url, progress);
  const splats = new SplatMesh({ fileBytes, fileType: SplatFileType.PLY, extSplats: true });
  await splats.initialized;
  splats.rotation.x = -Math.PI / 2;
  return splats;
}

// Takes away the splats above a height, so that rooms can be looked into from above.
export class SplatCut {
  constructor() {
    this.plane = new SplatEditSdf({ type: SplatEditSdfType.PLANE, opacity: 0 });
    this.plane.rotation.x = Math.PI / 2; // what is removed lies behind its z axis, which then points down
    this.edit = new SplatEdit({ sdfs: [this.plane] });
    this.edit.add(this.plane);
  }

  at(height) {
    this.plane.position.y = height;
  }
}

// The scaffold. Rooms have what was painted as their colour and need no light; furniture is lit from above, its forms to be seen.
export async function scaffoldLayer(url) {
  const bytes = await fetched(url);
  const { scene } = await new GLTFLoader().parseAsync(bytes.buffer, "");
  const layer = new THREE.Group();
  const lamp = new THREE.DirectionalLight(0xffffff, 1.1);
  lamp.position.set(0.4, 1, 0.7);
  layer.add(scene, new THREE.HemisphereLight(0xffffff, 0x8d867c, 2.2), lamp);
  return layer;
}

// Splats write no depth, so what is drawn over them would shine through walls. Between the two the scaffold's depth is drawn, and
// nothing of its colour. All three are transparent to three.js, which draws those in the order of their renderOrder.
const [AFTER_SPLATS, OVER] = [1, 2];

export function hidingLayer(scaffold) {
  const layer = scaffold.clone();
  layer.traverse((one) => one.isLight && (one.visible = false));
  const offset = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4 };
  const material = new THREE.MeshBasicMaterial({ colorWrite: false, transparent: true, ...offset });
  layer.traverse((one) => one.isMesh && Object.assign(one, { material, renderOrder: AFTER_SPLATS }));
  return layer;
}

function lines(points, color, opacity) {
  const geometry = points.isBufferGeometry ? points : new THREE.BufferGeometry().setFromPoints(points);
  const material = new THREE.LineBasicMaterial({ color, transparent: true, opacity });
  const made = new THREE.LineSegments(geometry, material);
  made.renderOrder = OVER;
  return made;
}

export function navmeshLayer(navmesh) {
  const layer = new THREE.Group();
  const corners = navmesh.vertices.map(([x, y, z]) => point([x, y, z + 0.02]));
  const surface = new THREE.BufferGeometry().setFromPoints(navmesh.triangles.flat().map((k) => corners[k]));
  const material = { color: 0x35c2a1, transparent: true, opacity: 0.28, side: THREE.DoubleSide, depthWrite: false };
  const floor = new THREE.Mesh(surface, new THREE.MeshBasicMaterial(material));
  floor.renderOrder = OVER;
  layer.add(floor);
  layer.add(lines(navmesh.triangles.flatMap(([a, b, c]) => [a, b, b, c, c, a].map((k) => corners[k])), 0x7df0d2, 0.8));
  return layer;
}

// The edges of everything solid. The lines are of the scaffold's own meshes.
export function colliderLayer(scaffold) {
  const layer = new THREE.Group();
  scaffold.updateMatrixWorld(true);
  scaffold.traverse((one) => {
    if (!one.isMesh) return;
    const edges = lines(new THREE.EdgesGeometry(one.geometry, 20), 0xf0b45a, 0.75);
    edges.matrixAutoUpdate = false;
    edges.matrix.copy(one.matrixWorld);
    layer.add(edges);
  });
  return layer;
}

// The run's cameras as frusta a quarter of a metre deep.
export function cameraLayer(cameras) {
  const depth = 0.25;
  const ends = cameras.flatMap(({ T_world_cam, focal, width, height }) => {
    const [x, y] = [(depth * width) / 2 / focal, (depth * height) / 2 / focal];
    const at = pose(T_world_cam);
    const [eye, a, b, c, d] = [
      [0, 0, 0], [-x, -y, -depth], [x, -y, -depth], [x, y, -depth], [-x, y, -depth],
    ].map((corner) => new THREE.Vector3(...corner).applyMatrix4(at));
    return [eye, a, eye, b, eye, c, eye, d, a, b, b, c, c, d, d, a];
  });
  return lines(ends, 0x8ab4ff, 0.9);
}
