// wm's files are right-handed with z up, the page's world with y up: (x, y, z) there is (x, z, -y) here. Both are in metres.
import { Matrix4, Vector3 } from "three";

const FROM_Z_UP = new Matrix4().set(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);

export function point([x, y, z = 0]) {
  return new Vector3(x, z, -y);
}

// A 4 x 4 matrix, as rows, that takes a camera's or an object's frame to wm's world.
export function pose(rows) {
  return FROM_Z_UP.clone().multiply(new Matrix4().set(...rows.flat()));
}
