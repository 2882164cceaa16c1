// The ball at the end of the axle, which the pointer pulls: of a top that runs the pull is a push,
// and of a top that waits it is the new tilt. With Shift it is a push in both cases.

import { normalize } from "./matrices.js";
import { State } from "../physics/state.js";

/** @import { Vector } from "../physics/kernel.js" */
/** @import { LocalTop } from "../run/local.js" */

const REACH = 24; // px around the ball in which a pull begins

/** The angles of an axis that points somewhere. @param {Vector} direction */
export const findAngles = (direction) => {
  const [x, y, z] = normalize(direction);
  return { theta: Math.atan2(Math.hypot(x, y), z), phi: Math.atan2(x, -y) };
};

export class Grip {
  /** @param {HTMLElement} canvas @param {import("./camera.js").Camera} camera @param {LocalTop} top */
  constructor(canvas, camera, top) {
    this.canvas = canvas;
    this.camera = camera;
    this.top = top;
    /** Where the ball is pulled to. @type {Vector | null} */
    this.end = null;
    this.isTilting = false;
    canvas.addEventListener("pointerdown", (event) => this.take(event), true);
    canvas.addEventListener("pointermove", (event) => this.pull(event));
    canvas.addEventListener("pointerup", () => this.release());
    canvas.addEventListener("pointercancel", () => {
      this.end = null;
    });
  }

  /** @returns {Vector} the end of the axle */
  get axis() {
    return this.top.state.toWorld([0, 0, 1]);
  }

  /** @param {PointerEvent} event */
  take(event) {
    const ball = this.camera.project(this.axis);
    if (!ball || !this.top.layers.handle) return;
    if (Math.hypot(event.offsetX - ball.x, event.offsetY - ball.y) > REACH) return;
    event.preventDefault(); // the camera does not turn
    event.stopImmediatePropagation();
    this.canvas.setPointerCapture(event.pointerId);
    this.isTilting = !this.top.isRunning && !event.shiftKey;
    this.end = this.axis;
  }

  /** @param {PointerEvent} event */
  pull({ offsetX, offsetY }) {
    if (this.end) this.end = this.camera.unproject(offsetX, offsetY, this.axis);
  }

  release() {
    const { end, isTilting } = this;
    this.end = null;
    if (!end) return;
    if (isTilting) this.top.take({ act: "tilt", ...findAngles(end) });
    else this.top.take({ act: "pull", end });
  }

  /** The attitude of a top that is being tilted. @returns {State | null} */
  get preview() {
    if (!this.end || !this.isTilting) return null;
    const { psi } = this.top.state.angles;
    return State.fromEuler(this.top.kernel, { ...findAngles(this.end), psi });
  }
}
