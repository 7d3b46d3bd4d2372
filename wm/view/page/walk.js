// Walking on a navmesh: a position (x, y) of wm's plane, z up, that steps cannot take off the mesh. Nothing here knows of three.js.
const STEP = 0.04; // metres; much less than two walls' distance, so that the nearest point is never behind a wall

function nearestOnSegment(p, a, b) {
  const [ux, uy] = [b[0] - a[0], b[1] - a[1]];
  const length = ux * ux + uy * uy;
  const t = length > 0 ? Math.min(1, Math.max(0, ((p[0] - a[0]) * ux + (p[1] - a[1]) * uy) / length)) : 0;
  return [a[0] + t * ux, a[1] + t * uy];
}

function left(a, b, p) {
  return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0;
}

function nearestOnTriangle(p, [a, b, c]) {
  if (left(a, b, p) && left(b, c, p) && left(c, a, p)) return p;
  let best = null;
  let least = Infinity;
  for (const [from, to] of [[a, b], [b, c], [c, a]]) {
    const q = nearestOnSegment(p, from, to);
    const far = (q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2;
    if (far < least) [best, least] = [q, far];
  }
  return best;
}

// The connected piece of each triangle, by the vertices that triangles share.
function pieces(triangles, count) {
  const root = Array.from({ length: count }, (_, k) => k);
  const find = (k) => {
    while (root[k] !== k) k = root[k] = root[root[k]];
    return k;
  };
  for (const [a, b, c] of triangles) {
    root[find(b)] = find(a);
    root[find(c)] = find(a);
  }
  return triangles.map(([a]) => find(a));
}

export class Walk {
  constructor(navmesh) {
    this.corners = navmesh.triangles.map((triangle) => triangle.map((k) => navmesh.vertices[k]));
    this.room = navmesh.triangle_room;
    this.piece = pieces(navmesh.triangles, navmesh.vertices.length);
    this.boxes = this.corners.map((corners) => {
      const [xs, ys] = [0, 1].map((axis) => corners.map((corner) => corner[axis]));
      return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
    });
    this.position = null;
    this.triangle = -1;
  }

  get empty() {
    return this.corners.length === 0;
  }

  // The index of the room that the position is in; -1 in a doorway.
  get currentRoom() {
    return this.triangle < 0 ? -1 : this.room[this.triangle];
  }

  // The nearest point of the mesh, of one piece of it where that is given: {point, triangle, distance}.
  nearest(p, piece = null) {
    let best = { point: null, triangle: -1, distance: Infinity };
    for (let k = 0; k < this.corners.length; k++) {
      if (piece !== null && this.piece[k] !== piece) continue;
      const [x0, y0, x1, y1] = this.boxes[k];
      const away = Math.hypot(Math.max(x0 - p[0], 0, p[0] - x1), Math.max(y0 - p[1], 0, p[1] - y1));
      if (away >= best.distance) continue;
      const q = nearestOnTriangle(p, this.corners[k]);
      const distance = Math.hypot(q[0] - p[0], q[1] - p[1]);
      if (distance < best.distance) best = { point: q, triangle: k, distance };
      if (distance === 0) break;
    }
    return best;
  }

  place(p) {
    const { point, triangle } = this.nearest(p);
    if (triangle >= 0) [this.position, this.triangle] = [[...point], triangle];
  }

  // Goes by (dx, dy) metres as far as walls and furniture allow, along them where they are met at an angle.
  move(dx, dy) {
    if (this.position === null) return;
    const steps = Math.max(1, Math.ceil(Math.hypot(dx, dy) / STEP));
    for (let k = 0; k < steps; k++) {
      const wanted = [this.position[0] + dx / steps, this.position[1] + dy / steps];
      const { point, triangle } = this.nearest(wanted, this.piece[this.triangle]);
      [this.position, this.triangle] = [[...point], triangle];
    }
  }
}
