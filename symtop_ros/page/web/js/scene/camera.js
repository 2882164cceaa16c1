// The camera: turned by a drag or by the arrows with Shift, moved nearer by the wheel, by two fingers,
// or by + and -.

import { add, cross, createPerspective, createView, multiplyMatrices } from "./matrices.js";
import { normalize, scale, subtract } from "./matrices.js";

/** @import { Vector } from "../physics/kernel.js" */

const ANGLE = (42 * Math.PI) / 180; // of the view
const STEEPEST = 1.5; // rad above or below the horizon
const [NEAREST, FARTHEST] = [1.2, 12];
const TURN = 0.008; // rad for a px

export class Camera {
  /** @param {HTMLElement} element */
  constructor(element) {
    this.size = { width: 0, height: 0 }; // px
    // To ask the element in every frame would have the browser lay out the whole page again.
    const measure = () => {
      this.size = { width: element.clientWidth, height: element.clientHeight };
    };
    measure();
    new ResizeObserver(measure).observe(element);
    /** @type {Vector} */
    this.target = [0, 0, 0];
    this.distance = 3;
    this.around = 0; // rad from x
    this.above = 0; // rad over the horizon
    /** @type {Map<number, {x: number, y: number}>} */
    this.pointers = new Map();
    element.addEventListener("pointerdown", (event) => {
      if (event.defaultPrevented) return;
      element.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    element.addEventListener("pointermove", (event) => this.drag(event));
    for (const name of ["pointerup", "pointercancel"]) {
      element.addEventListener(name, (event) =>
        this.pointers.delete(/** @type {PointerEvent} */ (event).pointerId),
      );
    }
    element.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.approach(Math.exp(event.deltaY * 0.001));
      },
      { passive: false },
    );
  }

  /** @param {Vector} eye @param {Vector} target */
  place(eye, target) {
    const [x, y, z] = subtract(eye, target);
    this.target = target;
    this.distance = Math.hypot(x, y, z);
    this.around = Math.atan2(y, x);
    this.above = Math.asin(z / this.distance);
  }

  /** @param {PointerEvent} event */
  drag(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const now = { x: event.clientX, y: event.clientY };
    if (this.pointers.size === 1) this.turn(now.x - last.x, now.y - last.y);
    else {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId);
      const between = (/** @type {{x: number, y: number}} */ p) =>
        Math.hypot(p.x - (other?.[1].x ?? 0), p.y - (other?.[1].y ?? 0));
      this.approach(between(last) / Math.max(between(now), 1));
    }
    this.pointers.set(event.pointerId, now);
  }

  /** @param {number} right px @param {number} down px */
  turn(right, down) {
    this.around -= right * TURN;
    this.above = Math.min(Math.max(this.above + down * TURN, -STEEPEST), STEEPEST);
  }

  /** @param {number} factor of the distance */
  approach(factor) {
    this.distance = Math.min(Math.max(this.distance * factor, NEAREST), FARTHEST);
  }

  /** @returns {Vector} */
  get eye() {
    const across = Math.cos(this.above);
    /** @type {Vector} */
    const direction = [
      across * Math.cos(this.around),
      across * Math.sin(this.around),
      Math.sin(this.above),
    ];
    return add(this.target, scale(direction, this.distance));
  }

  get matrix() {
    const { width, height } = this.size;
    const aspect = width / Math.max(height, 1);
    // A narrow page sees as much to the sides as a wide one.
    const angle = aspect < 1 ? 2 * Math.atan(Math.tan(ANGLE / 2) / aspect) : ANGLE;
    return multiplyMatrices(createPerspective(angle, aspect), createView(this.eye, this.target));
  }

  /** Where a point is on the element, in px, and how far away; null behind the eye. @param {Vector} point */
  project([x, y, z]) {
    const m = this.matrix;
    const [a, b, w] = [0, 1, 3].map(
      (row) => m[row] * x + m[row + 4] * y + m[row + 8] * z + m[row + 12],
    );
    if (w <= 0) return null;
    const { width, height } = this.size;
    return { x: ((a / w + 1) / 2) * width, y: ((1 - b / w) / 2) * height, depth: w };
  }

  /**
   * The point that a px of the element shows, in the plane through a point that faces the eye.
   * @param {number} px @param {number} py @param {Vector} through @returns {Vector}
   */
  unproject(px, py, through) {
    const here = this.project(through);
    if (!here) return through;
    const back = normalize(subtract(this.eye, this.target));
    const right = normalize([-back[1], back[0], 0]);
    const up = cross(back, right);
    const beside = this.project(add(through, right));
    const size = beside ? Math.hypot(beside.x - here.x, beside.y - here.y) || 1 : 1;
    const [x, y] = [(px - here.x) / size, (here.y - py) / size];
    return add(through, add(scale(right, x), scale(up, y)));
  }
}
