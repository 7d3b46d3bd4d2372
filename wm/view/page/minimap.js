// The floor plan, as SVG: rooms, openings, furniture, and where the visitor stands and looks.
const SVG = "http://www.w3.org/2000/svg";
const MARGIN = 0.3; // metres

function node(name, attributes, parent) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent?.append(made);
  return made;
}

const path = (points) => points.map(([x, y]) => `${x.toFixed(3)},${(-y).toFixed(3)}`).join(" ");

export class Minimap {
  constructor(svg, world, onPick) {
    const points = world.rooms.flatMap((room) => room.polygon);
    const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
    const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    svg.setAttribute("viewBox", [x0 - MARGIN, -y1 - MARGIN, x1 - x0 + 2 * MARGIN, y1 - y0 + 2 * MARGIN].join(" "));
    svg.style.setProperty("--shape", String((x1 - x0 + 2 * MARGIN) / (y1 - y0 + 2 * MARGIN)));
    this.rooms = world.rooms.map((room) => node("polygon", { points: path(room.polygon), class: "room" }, svg));
    for (const thing of world.objects.filter((one) => one.outline)) {
      node("polygon", { points: path(thing.outline), class: "thing" }, svg);
    }
    for (const room of world.rooms) node("polygon", { points: path(room.polygon), class: "wall" }, svg);
    for (const { ends, kind } of world.openings) node("polyline", { points: path(ends), class: `opening ${kind}` }, svg);
    this.here = node("g", { class: "here" }, svg);
    node("path", { d: "M0,0 L1.5,-0.95 A1.78,1.78 0 0 1 1.5,0.95 Z", class: "sight" }, this.here);
    node("circle", { r: 0.2 }, this.here);
    svg.addEventListener("click", (event) => {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      onPick([at.x, -at.y]);
    });
  }

  // Position in wm's plane; heading in radians, counter-clockwise from x; the index of the room or -1.
  show([x, y], heading, room) {
    this.here.setAttribute("transform", `translate(${x} ${-y}) rotate(${(-heading * 180) / Math.PI})`);
    this.rooms.forEach((one, k) => one.classList.toggle("current", k === room));
  }
}
