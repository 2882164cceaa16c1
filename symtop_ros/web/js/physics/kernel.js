// The kernel in WebAssembly: motions of the top in a page, with the bits of Python and no server.

/**
 * What a motion starts from, in SI units. Friction is axial and transverse; the torque is in the
 * world frame.
 * @typedef {object} Start
 * @property {number} Ix
 * @property {number} Iz
 * @property {number} Mgl
 * @property {number[]} orientation w, x, y, z
 * @property {number[]} angular_velocity x, y, z in the body frame
 * @property {number[]} [friction]
 * @property {number[]} [torque]
 */

/**
 * @typedef {object} Exports
 * @property {WebAssembly.Memory} memory
 * @property {() => void} _initialize
 * @property {(size: number) => number} malloc
 * @property {(place: number) => void} free
 * @property {(status: number) => number} symtop_describe_status
 * @property {(start: number, motion: number) => number} symtop_new
 * @property {(motion: number) => void} symtop_free
 * @property {(motion: number, t: number, torque: number, continued: number) => number}
 *   symtop_continue
 * @property {(motion: number, t: number, orientation: number, omega: number) => number}
 *   symtop_state
 * @property {(motion: number, times: number, count: number, steps: number, orientation: number,
 *   omega: number, written: number) => number} symtop_states
 * @property {(motion: number, clock: number, stamps: number, count: number, steps: number,
 *   orientation: number, omega: number, written: number) => number} symtop_states_of_clock
 * @property {(motion: number, t: number, steps: number, reached: number) => number} symtop_reach
 * @property {(motion: number) => number} symtop_find_kind
 * @property {(motion: number, angles: number) => void} symtop_find_turning_angles
 * @property {(motion: number, rates: number) => void} symtop_find_rates
 */

// In the order of symtop_kind.
const KINDS = [
  "regular",
  "unidirectional",
  "cusps",
  "looping",
  "through the pole",
  "asymptotic",
  "sleeping",
  "driven",
];
const OK = 0;
const MORE_STEPS = 11;
const NUMBERS = 15; // of symtop_start
const STATE = 7;
const CLOCK = 5; // numbers of symtop_clock

export class Kernel {
  /** @param {Exports} exports */
  constructor(exports) {
    this.exports = exports;
    /** Room for the arguments and the result of one call. */
    this.place = exports.malloc(8 * (NUMBERS + STATE + 2));
    /** @type {FinalizationRegistry<number>} */
    this.registry = new FinalizationRegistry((handle) => exports.symtop_free(handle));
  }

  /**
   * @param {BufferSource} bytes of kernel.wasm
   * @returns {Promise<Kernel>}
   */
  static async load(bytes) {
    const { instance } = await WebAssembly.instantiate(bytes, {});
    const exports = /** @type {Exports} */ (/** @type {unknown} */ (instance.exports));
    exports._initialize();
    return new Kernel(exports);
  }

  /**
   * Make a motion; a start that is refused throws a RangeError.
   * @param {Start} start
   * @returns {Motion}
   */
  motion({ Ix, Iz, Mgl, orientation, angular_velocity, friction = [0, 0], torque = [0, 0, 0] }) {
    const numbers = [Ix, Iz, Mgl, ...orientation, ...angular_velocity, ...friction, ...torque];
    if (numbers.length !== NUMBERS) {
      const names = "orientation, angular_velocity, friction and torque";
      throw new RangeError(`${names} must have 4, 3, 2 and 3 numbers`);
    }
    this.doubles(this.place, NUMBERS).set(numbers);
    const result = this.place + 8 * NUMBERS;
    this.demand(this.exports.symtop_new(this.place, result));
    return this.wrap(result);
  }

  /**
   * The numbers at a place. The memory moves when it grows: they are for one use.
   * @param {number} place
   * @param {number} count
   */
  doubles(place, count) {
    return new Float64Array(this.exports.memory.buffer, place, count);
  }

  /** @param {number} place where a handle has been written */
  wrap(place) {
    const handle = new Uint32Array(this.exports.memory.buffer, place, 1)[0];
    const motion = new Motion(this, handle);
    this.registry.register(motion, handle);
    return motion;
  }

  /** @param {number} status */
  demand(status) {
    if (status === OK) return;
    const bytes = new Uint8Array(this.exports.memory.buffer);
    const first = this.exports.symtop_describe_status(status);
    throw new RangeError(new TextDecoder().decode(bytes.subarray(first, bytes.indexOf(0, first))));
  }
}

export class Motion {
  /**
   * @param {Kernel} kernel
   * @param {number} handle
   */
  constructor(kernel, handle) {
    this.kernel = kernel;
    this.handle = handle;
  }

  /**
   * The state at a time in s.
   * @param {number} t
   * @returns {number[]} w, x, y, z, and the angular velocity in the body frame
   */
  at(t) {
    const { kernel, handle } = this;
    const { place } = kernel;
    kernel.demand(kernel.exports.symtop_state(handle, t, place, place + 32));
    return [...kernel.doubles(place, STATE)];
  }

  /**
   * The state at a time that is not rounded: a whole number of ns, as of the stamps of a node.
   * @param {number} passed ns
   * @returns {number[]} as of `at`
   */
  atNanosecond(passed) {
    const { kernel, handle } = this;
    const { place } = kernel;
    const [stamp, orientation] = [place + 8 * CLOCK, place + 8 * (CLOCK + 1)];
    const [omega, written] = [orientation + 32, orientation + 8 * STATE];
    kernel.doubles(place, CLOCK).set([1, 0, 0, 0, 0]); // factor and elapsed time
    new BigInt64Array(kernel.exports.memory.buffer, stamp, 1)[0] = BigInt(passed);
    kernel.demand(
      kernel.exports.symtop_states_of_clock(
        handle,
        place,
        stamp,
        1,
        Infinity,
        orientation,
        omega,
        written,
      ),
    );
    return [...kernel.doubles(orientation, STATE)];
  }

  /**
   * States at times in s.
   * @param {ArrayLike<number>} times
   * @returns {{orientation: Float64Array, angular_velocity: Float64Array}} four and three a time
   */
  states(times) {
    const { kernel, handle } = this;
    const { exports } = kernel;
    const count = times.length;
    const place = exports.malloc(8 * (8 * count + 1));
    const [orientation, omega] = [place + 8 * count, place + 40 * count];
    try {
      kernel.doubles(place, count).set(times);
      const written = omega + 24 * count;
      kernel.demand(
        exports.symtop_states(handle, place, count, Infinity, orientation, omega, written),
      );
      return {
        orientation: kernel.doubles(orientation, 4 * count).slice(),
        angular_velocity: kernel.doubles(omega, 3 * count).slice(),
      };
    } finally {
      exports.free(place);
    }
  }

  /**
   * Integrate towards a time in so many steps; returns the time up to which states are at hand.
   * @param {number} t
   * @param {number} steps
   */
  reach(t, steps) {
    const { kernel, handle } = this;
    const status = kernel.exports.symtop_reach(handle, t, steps, kernel.place);
    if (status !== MORE_STEPS) kernel.demand(status);
    return kernel.doubles(kernel.place, 1)[0];
  }

  /**
   * The motion that goes on from a time with another torque; its times count from there.
   * @param {number} t
   * @param {number[]} torque
   */
  continue(t, torque) {
    const { kernel, handle } = this;
    const { place } = kernel;
    kernel.doubles(place, 3).set(torque);
    kernel.demand(kernel.exports.symtop_continue(handle, t, place, place + 24));
    return kernel.wrap(place + 24);
  }

  get kind() {
    return KINDS[this.kernel.exports.symtop_find_kind(this.handle)];
  }

  /** The smallest and the largest theta in rad. */
  get turning_angles() {
    const { kernel, handle } = this;
    kernel.exports.symtop_find_turning_angles(handle, kernel.place);
    return [...kernel.doubles(kernel.place, 2)];
  }

  /** Period of theta in s; infinite if it does not return. */
  get nutation_period() {
    return this.rates.nutation_period;
  }

  /** What is the same in every nutation, as in symtop_rates. */
  get rates() {
    const { kernel, handle } = this;
    const { place } = kernel;
    kernel.exports.symtop_find_rates(handle, place);
    const [nutation_period, mean_precession_rate, mean_spin_rate, precession_per_nutation] =
      kernel.doubles(place, 4);
    const [reverses] = new Int32Array(kernel.exports.memory.buffer, place + 32, 1);
    return {
      nutation_period,
      mean_precession_rate,
      mean_spin_rate,
      precession_per_nutation,
      spin_reverses: reverses !== 0,
    };
  }
}
