// The kernel in WebAssembly, by symtop.h: all physics of a page, with the bits of Python.

import { NAMES, RECORDS, STATUS } from "./records.js";

/** @typedef {[number, number, number]} Vector */
/** @typedef {[number, number, number, number]} Quaternion */
/** @typedef {{Ix: number, Iz: number, Mgl: number}} Top */
/** @typedef {"spin_rate" | "spin_momentum"} Hold what a kick holds with theta': psi', or L_z */
/** @typedef {"rises" | "falls" | "stays"} Direction */
/**
 * What a motion starts from, in SI units: w, x, y, z, body to world; angular velocity in the body
 * frame; coefficients of friction in the order of symtop_friction_kind; the torque in the world frame;
 * pushes on the axle, the first of which leaves this state; and whether a hand holds phi.
 * @typedef {Top & {orientation: number[], angular_velocity: number[], friction?: number[],
 *   torque?: number[], pushes?: Pushes | null, clamped?: boolean}} Start
 */
/** A part of a body on the axis, in kg and m. @typedef {{kind: string, mass: number, size: number, distance: number}} Part */
/** Equal pushes: N m s, 1/s, and how many. @typedef {{impulse: number, rate: number, number: number}} Pushes */
/** @typedef {ArrayLike<number> | Int32Array | BigInt64Array} Numbers */
/** @typedef {{writes: number | string}} Room for so many doubles, a handle, or a record */
/** @typedef {{[name: string]: any}} Found a record of symtop.h, with names for the enums */

const LARGEST = 1024; // bytes of a record
/** @type {number[]} */
export const NO_FRICTION = NAMES.friction_kind.map(() => 0);
// The vectors of a start, in the order of symtop_start.
const LENGTHS = [4, 3, NO_FRICTION.length, 3];
export const GRAVITY = 9.81; // m/s^2, as in Python

/** Reads memory as C has laid it out: all records hold doubles, and begin at multiples of 8. */
class Reader {
  /** @param {DataView} view @param {number} place */
  constructor(view, place) {
    this.view = view;
    this.place = place;
  }

  /** @param {number} size of what is read next @param {number} step to which it is aligned */
  skip(size, step = size) {
    const begin = Math.ceil(this.place / step) * step;
    this.place = begin + size;
    return begin;
  }

  /** @param {string} type @returns {any} */
  read(type) {
    if (type === "double") return this.view.getFloat64(this.skip(8), true);
    const [kind, more] = type.split(" ");
    if (more && more !== "bits") return Array.from({ length: Number(more) }, () => this.read(kind));
    if (kind in RECORDS) {
      this.skip(0, 8);
      const found = Object.fromEntries(
        RECORDS[kind].map(([each, name]) => [name, this.read(each)]),
      );
      this.skip(0, 8);
      return found;
    }
    const number = this.view.getInt32(this.skip(4), true);
    if (kind === "handle") return number;
    if (kind === "flag") return number !== 0;
    return more ? NAMES[kind].filter((_, bit) => (number >> bit) & 1) : NAMES[kind][number];
  }
}

/** @param {any} given @returns {given is number | bigint} */
const isNumber = (given) => typeof given === "number" || typeof given === "bigint";

/** The bytes that a function writes. @param {Room["writes"]} type */
const measure = (type) => {
  if (typeof type === "number") return 8 * type;
  const reader = new Reader(new DataView(new ArrayBuffer(LARGEST)), 0);
  reader.read(type);
  return Math.max(reader.place, 8);
};

/** @param {number | Room["writes"]} type @returns {Room} */
export const room = (type) => ({ writes: type });

/** The numbers of symtop_start. @param {Start} start */
export const pack = ({ Ix, Iz, Mgl, ...given }) => {
  const { orientation, angular_velocity, friction = NO_FRICTION, torque = [0, 0, 0] } = given;
  const parts = [orientation, angular_velocity, friction, torque];
  if (String(parts.map((each) => each.length)) === String(LENGTHS))
    return [Ix, Iz, Mgl, ...orientation, ...angular_velocity, ...friction, ...torque];
  const names = "orientation, angular_velocity, friction and torque";
  const [last] = LENGTHS.slice(-1);
  throw new RangeError(`${names} must have ${LENGTHS.slice(0, -1).join(", ")} and ${last} numbers`);
};

export class Kernel {
  /** @param {WebAssembly.Instance} instance */
  constructor({ exports }) {
    /** The functions, and the memory. @type {{[name: string]: any}} */
    this.exports = exports;
    this.size = LARGEST;
    /** Room for what one call takes and writes. @type {number} */
    this.place = this.exports.malloc(this.size);
    /** @type {FinalizationRegistry<number>} */
    this.registry = new FinalizationRegistry((handle) => this.exports.symtop_free(handle));
  }

  /** @param {BufferSource} bytes of kernel.wasm */
  static async load(bytes) {
    const { instance } = await WebAssembly.instantiate(bytes, {});
    /** @type {{[name: string]: any}} */ (instance.exports)._initialize();
    return new Kernel(instance);
  }

  /** @param {number} size in bytes @returns {number} a place with so much room, for one call */
  reserve(size) {
    if (size <= this.size) return this.place;
    this.exports.free(this.place);
    Object.assign(this, { place: this.exports.malloc(size), size });
    return this.place;
  }

  /**
   * Call a function with numbers, arrays and rooms; returns what it writes, a value for each room.
   * What it refuses is a RangeError.
   * @param {string} name
   * @param {(number | bigint | Numbers | Room)[]} given
   * @returns {any[]}
   */
  call(name, ...given) {
    const sizes = given.map((each) =>
      isNumber(each) ? 0 : "writes" in each ? measure(each.writes) : 8 * each.length,
    );
    let place = this.reserve(sizes.reduce((sum, each) => sum + each, 0));
    /** @type {(() => any)[]} */
    const rooms = [];
    const taken = given.map((each, k) => {
      if (isNumber(each)) return each;
      const begin = place;
      place += sizes[k];
      if ("writes" in each) rooms.push(() => this.read(each.writes, begin));
      else this.write(each, begin);
      return begin;
    });
    const status = this.exports[`symtop_${name}`](...taken); // nothing if it cannot refuse
    if (status && status !== STATUS.MORE_STEPS) throw new RangeError(this.describe(status));
    return rooms.map((read) => read());
  }

  /** @param {Room["writes"]} type @param {number} place */
  read(type, place) {
    const { buffer } = this.exports.memory; // another one when the memory has grown
    if (typeof type === "number") return new Float64Array(buffer, place, type).slice();
    return new Reader(new DataView(buffer), place).read(type);
  }

  /** @param {Numbers} numbers @param {number} place */
  write(numbers, place) {
    const range = /** @type {const} */ ([this.exports.memory.buffer, place, numbers.length]);
    if (numbers instanceof BigInt64Array) new BigInt64Array(...range).set(numbers);
    else if (numbers instanceof Int32Array) new Int32Array(...range).set(numbers);
    else new Float64Array(...range).set(numbers);
  }

  /** @param {number} status */
  describe(status) {
    const bytes = new Uint8Array(this.exports.memory.buffer);
    const first = this.exports.symtop_describe_status(status);
    return new TextDecoder().decode(bytes.subarray(first, bytes.indexOf(0, first)));
  }

  /** Make a motion. @param {Start} start */
  motion(start) {
    const { pushes, clamped } = start;
    const series = pushes ? [[pushes.impulse, pushes.rate, pushes.number]] : [];
    const name = pushes ? "new_pushed" : clamped ? "new_clamped" : "new";
    return new Motion(this, this.call(name, pack(start), ...series, room("handle"))[0]);
  }

  /**
   * The rates phi' of regular precession: slow and fast, one or none.
   * @param {Top} top
   * @param {number} theta
   * @param {number} spin psi', or omega_z if the axial momentum is held
   * @param {Hold} hold
   * @returns {number[]}
   */
  findRegularRates({ Ix, Iz, Mgl }, theta, spin, hold = "spin_rate") {
    const given = [[Ix, Iz, Mgl], [theta], [spin], 1, NAMES.hold.indexOf(hold)];
    const [rates] = this.call("find_regular_rates", ...given, room(2));
    return [...rates].filter((rate) => !Number.isNaN(rate));
  }

  /**
   * The disc on an axle that moves as a top does: mass, radius, distance; NaN if there is none.
   * @param {Top} top @param {number} gravity in m/s^2 @returns {number[]} in kg and m
   */
  findDisc({ Ix, Iz, Mgl }, gravity) {
    return [...this.call("find_disc", [Ix, Iz, Mgl], gravity, room(3))[0]];
  }

  /**
   * The body that parts on an axle make, and the top that it is.
   * @param {Part[]} parts @param {number} gravity in m/s^2
   * @returns {{mass: number, arm: number, top: Top}}
   */
  findBody(parts, gravity) {
    const kinds = Int32Array.from(parts, ({ kind }) => NAMES.part_kind.indexOf(kind));
    const numbers = parts.flatMap(({ mass, size, distance }) => [mass, size, distance]);
    const given = [kinds, numbers, parts.length];
    const [body] = this.call("find_body", ...given, room("body"), room(1));
    const { mass, arm, Ix, Iz } = body;
    const [top] = this.call("find_body_top", [mass, arm, Ix, Iz], gravity, room("top"));
    return { mass, arm, top };
  }

  /**
   * The starts that have what is known of them, or what a number would have to be.
   * @param {Top} top @param {string} question names of what is known @param {number[]} known
   * @param {number[]} halfWidths by how much each may be off: each start has the `least` and the `most`
   * of its numbers then, NaN if there may be more or fewer starts
   * @returns {Found}
   */
  solveStart({ Ix, Iz, Mgl }, question, known, halfWidths) {
    const fill = (/** @type {number[]} */ numbers) => [...numbers, 0].slice(0, 3);
    const given = [[Ix, Iz, Mgl], NAMES.question.indexOf(question), fill(known)];
    const [{ each, number, ...found }] = this.call("solve_start", ...given, room("solutions"));
    const [{ least, most }] = this.call(
      "find_spreads",
      ...given,
      fill(halfWidths),
      room("spreads"),
    );
    const starts = each
      .slice(0, number)
      .map((/** @type {object} */ start, /** @type {number} */ k) => ({
        start,
        least: least[k],
        most: most[k],
      }));
    return { ...found, starts };
  }

  /** The time in s from which on rounding shows in a motion. @param {number[]} start @returns {number} */
  findDoubt(start) {
    return this.call("find_doubt", start, room(1))[0][0];
  }

  /**
   * The angular velocity after a kick.
   * @param {Top} top
   * @param {{orientation: Quaternion, omega: Vector}} state
   * @param {string} kind
   * @param {number[]} amount
   * @param {Hold} hold
   * @returns {Vector}
   */
  kick({ Ix, Iz, Mgl }, { orientation, omega }, kind, amount, hold) {
    const how = [NAMES.kick_kind.indexOf(kind), NAMES.hold.indexOf(hold)];
    const given = [[Ix, Iz, Mgl], orientation, omega, ...how, amount, 1];
    return this.call("kick", ...given, room(3), room(1))[0];
  }

  /** @param {number[]} start @param {number} factor @param {Hold} hold @returns {Found} */
  judge(start, factor, hold) {
    const given = [start, [factor], 1, NAMES.hold.indexOf(hold)];
    return this.call("judge", ...given, room("verdict"), room(1))[0];
  }

  /**
   * Two states of a top, and what it has gained from the first to the last, as in symtop_exchange.
   * @param {Top} top
   * @param {{orientation: Quaternion, omega: Vector}} first
   * @param {{orientation: Quaternion, omega: Vector}} last
   * @returns {Found}
   */
  findExchange({ Ix, Iz, Mgl }, first, last) {
    const orientations = [...first.orientation, ...last.orientation];
    const given = [[Ix, Iz, Mgl], orientations, [...first.omega, ...last.omega]];
    return this.call("find_exchange", ...given, room("exchange"))[0];
  }

  /** What follows if the precession of a start is held. @param {number[]} start @returns {Found} */
  judgeClamp(start) {
    return this.call("judge_clamp", start, room("held"))[0];
  }

  /** Why the weight speeds up, slows down or turns now. @param {number[]} start @returns {Found} */
  explainPresent(start) {
    return this.call("explain_present", start, room("present"))[0];
  }

  /** @param {number[]} before @param {number[]} after @param {Hold | null} hold @returns {Found} */
  judgeKick(before, after, hold) {
    return this.call("judge_kick", before, after, NAMES.hold.indexOf(hold), room("verdict"))[0];
  }
}

export class Motion {
  /** @param {Kernel} kernel @param {number} handle */
  constructor(kernel, handle) {
    this.kernel = kernel;
    this.handle = handle;
    kernel.registry.register(this, handle);
  }

  /** The numbers of the state at a time in s. @param {number} t @returns {number[]} */
  at(t) {
    return this.kernel.call("state", this.handle, t, room(4), room(3)).flatMap((part) => [...part]);
  }

  /** The parts of a state at a whole number of ns, not rounded, as of a node. @param {number} passed */
  atNanosecond(passed) {
    const given = [this.handle, [1, 0, 0, 0, 0], BigInt64Array.of(BigInt(passed)), 1, Infinity];
    return this.kernel.call("states_of_clock", ...given, room(4), room(3), room(1)).slice(0, 2);
  }

  /**
   * What moves between two pushes: its start, the time in ns at which it begins, and the number of
   * pushes up to then.
   * @param {number} passed whole ns
   * @returns {Found}
   */
  findPiece(passed) {
    const given = [this.handle, [1, 0, 0, 0, 0], BigInt(passed), Infinity];
    return this.kernel.call("find_piece", ...given, room("piece"))[0];
  }

  /**
   * Integrate towards a time in so many steps; returns the time up to which states are at hand.
   * @param {number} t @param {number} steps @returns {number}
   */
  reach(t, steps) {
    return this.kernel.call("reach", this.handle, t, steps, room(1))[0][0];
  }

  /** @returns {string} */
  get kind() {
    return NAMES.kind[this.kernel.exports.symtop_find_kind(this.handle)];
  }

  /** The smallest and the largest theta in rad. @returns {[number, number]} */
  get turning_angles() {
    const [[low, high]] = this.kernel.call("find_turning_angles", this.handle, room(2));
    return [low, high];
  }

  /** What is the same in every nutation, as in symtop_rates. */
  get rates() {
    return this.kernel.call("find_rates", this.handle, room("rates"))[0];
  }

  /** Period of theta in s; infinite if it does not return. @returns {number} */
  get nutation_period() {
    return this.rates.nutation_period;
  }
}
