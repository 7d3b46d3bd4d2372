// The name of what the pointer is on: a ray through the scaffold's nodes, whose names are the ids of objects.
import { Raycaster, Vector2 } from "three";

export class Labels {
  constructor(element, camera, world) {
    [this.element, this.camera] = [element, camera];
    this.objects = new Map(world.objects.map((one) => [one.id, one]));
    this.rooms = world.rooms;
    this.scaffold = null;
    this.ray = new Raycaster();
  }

  // The object's row, or null where a wall, a floor or nothing is met first. x, y in -1..1.
  at(x, y) {
    if (this.scaffold === null) return null;
    this.ray.setFromCamera(new Vector2(x, y), this.camera);
    const [hit] = this.ray.intersectObject(this.scaffold, true);
    for (let one = hit?.object; one; one = one.parent) {
      const found = this.objects.get(one.userData.id ?? one.name);
      if (found) return { ...found, distance: hit.distance };
    }
    return null;
  }

  // Shows the label beside a point of the page, in pixels; hides it where nothing is.
  show(clientX, clientY) {
    const found = this.at((clientX / window.innerWidth) * 2 - 1, 1 - (clientY / window.innerHeight) * 2);
    this.element.hidden = found === null;
    if (found === null) return;
    const [width, depth, height] = found.size.map((metres) => metres.toFixed(2));
    this.element.querySelector("b").textContent = found.label;
    this.element.querySelector("span").textContent = `${width} × ${depth} × ${height} m · ${found.distance.toFixed(1)} m away`;
    const box = this.element.getBoundingClientRect();
    this.element.style.left = `${Math.max(8, Math.min(clientX + 16, window.innerWidth - box.width - 8))}px`;
    this.element.style.top = `${Math.max(8, Math.min(clientY + 16, window.innerHeight - box.height - 8))}px`;
  }

  hide() {
    this.element.hidden = true;
  }
}
