// As print_motions.c, in a page: reads motions from bytes and returns what the kernel says of them.

class Reader {
  constructor(bytes) {
    this.view = new DataView(bytes.buffer);
    this.place = 0;
  }
  number() {
    this.place += 8;
    return this.view.getFloat64(this.place - 8, true);
  }
  numbers(count) {
    return Array.from({ length: count }, () => this.number());
  }
  stamps(count) {
    this.place += 8 * count;
    return new BigInt64Array(this.view.buffer.slice(this.place - 8 * count, this.place));
  }
}

function read_motion(kernel, reader) {
  const [Ix, Iz, Mgl] = reader.numbers(3);
  const [orientation, angular_velocity] = [reader.numbers(4), reader.numbers(3)];
  const [friction, torque] = [reader.numbers(2), reader.numbers(3)];
  return kernel.motion({ Ix, Iz, Mgl, orientation, angular_velocity, friction, torque });
}

function* list_rows({ orientation, angular_velocity }) {
  for (let n = 0; 4 * n < orientation.length; n++) {
    yield* orientation.subarray(4 * n, 4 * n + 4);
    yield* angular_velocity.subarray(3 * n, 3 * n + 3);
  }
}

function read_states_of_clock(kernel, motion, clock, stamps) {
  const { exports } = kernel;
  const count = stamps.length;
  const place = exports.malloc(8 * (8 * count + 6));
  const given = place + 40;
  const orientation = given + 8 * count;
  const omega = orientation + 32 * count;
  kernel.doubles(place, 5).set(clock);
  new BigInt64Array(exports.memory.buffer, given, count).set(stamps);
  const ends = [Infinity, orientation, omega, omega + 24 * count];
  kernel.demand(exports.symtop_states_of_clock(motion.handle, place, given, count, ...ends));
  const states = {
    orientation: kernel.doubles(orientation, 4 * count).slice(),
    angular_velocity: kernel.doubles(omega, 3 * count).slice(),
  };
  exports.free(place);
  return states;
}

function* describe(kernel, kinds, reader) {
  const motion = read_motion(kernel, reader);
  const { rates } = motion;
  yield kinds.indexOf(motion.kind);
  yield* motion.turning_angles;
  yield motion.nutation_period;
  yield* [rates.mean_precession_rate, rates.mean_spin_rate, rates.precession_per_nutation];
  yield Number(rates.spin_reverses);
  const times = reader.numbers(reader.number());
  for (const t of times) yield* motion.at(t);
  yield* list_rows(motion.states(times));
  const clock = reader.numbers(5);
  const stamps = reader.stamps(reader.number());
  yield* list_rows(read_states_of_clock(kernel, motion, clock, stamps));
  if (reader.number()) {
    const [t, ...torque] = reader.numbers(4);
    yield* motion.continue(t, torque).at(t);
  }
}

const decode = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/** All numbers, as base64 of their bytes. */
async function print_motions(Kernel, kinds, module, samples) {
  const kernel = await Kernel.load(decode(module));
  const reader = new Reader(decode(samples));
  const numbers = [];
  const count = reader.number();
  for (let n = 0; n < count; n++) numbers.push(...describe(kernel, kinds, reader));
  let text = "";
  const bytes = new Uint8Array(Float64Array.from(numbers).buffer);
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text);
}
