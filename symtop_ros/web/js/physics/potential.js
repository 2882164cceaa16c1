// Twin of physics/potential.py: constants of the motion, and the effective potential.

import { cosineAndSine } from "./elementary.js";

/** @typedef {import("./state.js").State} State */
/** @typedef {import("./precession.js").Top} Top */

/**
 * Energy, and the angular momentum about the axis and about the vertical.
 * @param {Top} top
 * @param {State} state
 */
export const findConstants = ({ Ix, Iz, Mgl }, state) => {
  const [x, y, z] = state.omega;
  const [gx, gy, gz] = state.vertical;
  return {
    energy: (Ix * x * x + Ix * y * y + Iz * z * z) / 2 + Mgl * gz,
    L_z: Iz * z,
    "L_z'": Ix * x * gx + Ix * y * gy + Iz * z * gz,
  };
};

export class EffectivePotential {
  /**
   * @param {Top} top
   * @param {State} state
   */
  constructor(top, state) {
    const constants = findConstants(top, state);
    const [x, y] = state.omega;
    this.top = top;
    this.axial = constants.L_z;
    this.vertical = constants["L_z'"];
    /** The energy without that of the spin about the axis. */
    this.energy = (top.Ix * (x * x + y * y)) / 2 + top.Mgl * state.vertical[2];
  }

  /** @param {number} theta */
  at(theta) {
    const { Ix, Mgl } = this.top;
    const [cosine, sine] = cosineAndSine(theta);
    const [, halfSine] = cosineAndSine(theta / 2);
    // b - a u as (b - a) + a (1 - u): for an upright axis nothing is left of the difference.
    const turning =
      (this.vertical - this.axial) / Ix + (this.axial / Ix) * (2 * (halfSine * halfSine));
    const share = turning === 0 ? 0 : turning / sine;
    return (Ix * share * share) / 2 + Mgl * cosine;
  }
}
