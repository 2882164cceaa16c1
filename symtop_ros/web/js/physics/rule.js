// Twin of physics/rule/perry.py: whether Perry's rule holds for a change of the precession.

import { TiltQuadratic } from "./precession.js";

/** @typedef {import("./state.js").State} State */
/** @typedef {import("./precession.js").Top} Top */
/** @typedef {import("./kicks.js").Hold} Hold */
/** @typedef {"rises" | "falls" | "stays"} Direction */

const EPS = 2 ** -52;
const STATE_ROUNDING = 8 * EPS;

/** @param {Top} top */
export const nameSubject = ({ Mgl }) => (Mgl < 0 ? "axis" : "top");

/** theta'' as a function of phi', at the tilt and the spin of a state. */
export class TiltAcceleration {
  /**
   * @param {Top} top
   * @param {State} state
   * @param {Hold} hold
   */
  constructor(top, state, hold) {
    const [gx, gy, gz] = state.vertical;
    const spin = hold === "spin_rate" ? state.exactRates[1] : state.omega[2];
    const largest = Math.max(...state.omega.map(Math.abs));
    this.quadratic = new TiltQuadratic(
      top,
      Math.abs(gz) <= STATE_ROUNDING ? 0 : gz,
      Math.abs(spin) <= STATE_ROUNDING * largest ? 0 : spin,
      hold,
    );
    this.sinePerMoment = Math.hypot(gx, gy) / top.Ix;
  }

  /** @param {number} rate */
  at(rate) {
    if (this.quadratic.isBalanced(rate)) return 0;
    return this.quadratic.at(rate).times(this.sinePerMoment).number;
  }

  /** Where a rate lies among the regular ones. @param {number} rate */
  place(rate) {
    const rates = this.quadratic.roots;
    return { kind: this.findPlace(rate, rates), rate, regular_rates: rates };
  }

  /**
   * @param {number} rate
   * @param {number[]} rates
   */
  findPlace(rate, rates) {
    if (!rates.length) return "none";
    const [first, second] = rates;
    if (this.quadratic.isBalanced(rate)) {
      if (rates.length === 1) return "only";
      return Math.abs(first - rate) <= Math.abs(second - rate) ? "slow" : "fast";
    }
    if (rates.length === 1) return rate > first ? "above" : "below";
    return Math.min(first, second) < rate && rate < Math.max(first, second) ? "between" : "outside";
  }
}

/** A change of phi', done or asked about. */
export class PrecessionChange {
  /**
   * @param {Top} top
   * @param {TiltAcceleration} tilt
   * @param {number} before
   * @param {number} after
   * @param {number | null} factor null for an angular impulse
   */
  constructor(top, tilt, before, after, factor) {
    this.top = top;
    this.tilt = tilt;
    this.before = before;
    this.after = after;
    this.factor = factor;
    this.change = tilt.quadratic.change(before, after);
    this.isHurried = factor !== null && factor > 1;
  }

  /**
   * The change that a kick has made; hold is null for an angular impulse.
   * @param {Top} top
   * @param {State} before
   * @param {State} after
   * @param {Hold | null} hold
   */
  static between(top, before, after, hold) {
    const [was] = before.exactRates;
    let [now] = after.exactRates;
    const sine = Math.hypot(...before.vertical.slice(0, 2));
    const rounding = (8 * EPS * Math.hypot(...before.omega.slice(0, 2))) / sine;
    if (Math.abs(now - was) <= rounding) now = was;
    else if (Math.abs(now) <= rounding) now = 0;
    if (hold === null) {
      return new PrecessionChange(
        top,
        new TiltAcceleration(top, after, "spin_rate"),
        was,
        now,
        null,
      );
    }
    const tilt = new TiltAcceleration(top, before, hold);
    return new PrecessionChange(top, tilt, was, now, was ? now / was : 1);
  }

  /** Why the rule says nothing, or null. */
  get silence() {
    if (this.factor === null) return "angular_impulse";
    if (this.before === 0) return "no_precession";
    if (this.factor === 1) return "unchanged";
    if (this.factor < 0) return "reversed";
    return this.change ? null : "no_effect";
  }

  /** @returns {boolean | null} */
  get ruleHolds() {
    if (this.silence) return null;
    return this.isHurried ? this.change < 0 : this.change > 0;
  }

  /** @returns {Direction | null} */
  get expected() {
    if (this.silence) return null;
    return this.change < 0 ? "rises" : "falls";
  }

  /** @param {boolean} isDone */
  explain(isDone) {
    const done = this.isHurried ? "hurried" : "delayed";
    const holds = this.ruleHolds;
    return {
      kind: this.silence ?? (isDone ? done : `if_${done}`),
      rule: holds === null ? null : holds ? "holds" : "fails",
      subject: nameSubject(this.top),
      before: this.before,
      after: this.after,
      theta_ddot_without: this.tilt.at(this.before),
      theta_ddot: this.tilt.at(this.after),
      place: this.tilt.place(isDone ? this.after : this.before),
    };
  }
}
