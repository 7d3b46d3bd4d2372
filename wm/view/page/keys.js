// Which keys are held, and what they ask of a visitor: {forward, right, turn, tilt, fast}, each in -1..1.
const HELD = {
  KeyW: "forward", ArrowUp: "forward", KeyS: "back", ArrowDown: "back",
  KeyA: "left", KeyD: "right",
  ArrowLeft: "turnLeft", KeyQ: "turnLeft", ArrowRight: "turnRight", KeyE: "turnRight",
  PageUp: "up", PageDown: "down",
};

export class Keys {
  constructor(onPress) {
    this.held = new Set();
    this.fast = false;
    window.addEventListener("keydown", (event) => {
      this.fast = event.shiftKey;
      if (event.ctrlKey || event.altKey || event.metaKey || event.target.closest("input, select, textarea, dialog")) return;
      const move = HELD[event.code];
      if (move) {
        this.held.add(move);
        event.preventDefault();
      } else if (!event.repeat) {
        onPress(event);
      }
    });
    window.addEventListener("keyup", (event) => {
      this.fast = event.shiftKey;
      this.held.delete(HELD[event.code]);
    });
    window.addEventListener("blur", () => this.held.clear());
    document.addEventListener("visibilitychange", () => this.held.clear());
  }

  // What two opposite keys make.
  axis(plus, minus) {
    return Number(this.held.has(plus)) - Number(this.held.has(minus));
  }

  get any() {
    return this.held.size > 0;
  }
}
