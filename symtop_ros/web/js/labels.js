// Labels of the scene: elements over the picture, each in the colour of its arrow.

/** @typedef {import("./state.js").Vector} Vector */

export class Labels {
  /**
   * @param {HTMLElement} place
   * @param {import("./camera.js").Camera} camera
   */
  constructor(place, camera) {
    this.place = place;
    this.camera = camera;
    /** @type {{[name: string]: HTMLElement}} */
    this.names = {};
    /** Labels of this picture. @type {Set<string>} */
    this.shown = new Set();
  }

  begin() {
    this.shown.clear();
  }

  /**
   * @param {string} name
   * @param {string} color
   * @param {Vector} point
   */
  put(name, color, point) {
    const at = this.camera.project(point);
    if (!at) return;
    const label = this.find(name, color);
    this.shown.add(name);
    label.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px) translate(-50%, -50%)`;
  }

  /**
   * @param {string} name
   * @param {string} color
   */
  find(name, color) {
    if (!this.names[name]) {
      const label = document.createElement("span");
      Object.assign(label, { className: "label", textContent: name });
      label.style.borderColor = color;
      this.place.append(label);
      this.names[name] = label;
    }
    return this.names[name];
  }

  /** Hide those that were not put into this picture. */
  end() {
    for (const [name, label] of Object.entries(this.names)) label.hidden = !this.shown.has(name);
  }
}
