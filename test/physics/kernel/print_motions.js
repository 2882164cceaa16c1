// As print_motions.c, in a page: reads motions from bytes and returns what the kernel says of them.

const FACTOR = 1.4; // of the kick that is judged

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

function read_start(reader) {
  const [Ix, Iz, Mgl] = reader.numbers(3);
  const [orientation, angular_velocity] = [reader.numbers(4), reader.numbers(3)];
  const [friction, torque] = [reader.numbers(2), reader.numbers(3)];
  return { Ix, Iz, Mgl, orientation, angular_velocity, friction, torque };
}

function* list_rows({ orientation, angular_velocity }) {
  for (let n = 0; 4 * n < orientation.length; n++) {
    yield* orientation.subarray(4 * n, 4 * n + 4);
    yield* angular_velocity.subarray(3 * n, 3 * n + 3);
  }
}

/** The numbers of a record, with the places of names in their lists. */
function* flatten(names, record) {
  const lists = { subject: "subjects", direction: "directions", motion: "kinds", rule: "rules" };
  Object.assign(lists, { explanation: "explanations", turn: "turns", pace: "paces" });
  Object.assign(lists, { effect: "effects", sense: "senses", height: "lifts" });
  const bits = { constant: "parts" };
  for (const [field, value] of Object.entries(record)) {
    if (field in bits) {
      yield names[bits[field]].reduce((sum, each, bit) => sum + (value.includes(each) << bit), 0);
    } else if (field === "kind") {
      const list = "amount" in record ? "lifts" : "place" in record ? "reasons" : "places";
      yield names[list].indexOf(value);
    } else if (field in lists) yield names[lists[field]].indexOf(value);
    else if (Array.isArray(value)) yield* value;
    else if (typeof value === "object") yield* flatten(names, value);
    else yield Number(value);
  }
}

const room = (writes) => ({ writes });

/** The rows of states at many times. */
function* list_states({ kernel, handle }, name, count, ...times) {
  const rooms = [room(4 * count), room(3 * count), room(1)];
  const found = kernel.call(name, handle, ...times, count, Infinity, ...rooms);
  yield* list_rows({ orientation: found[0], angular_velocity: found[1] });
}

/** The angular velocity after a hurry; null if the axis is vertical. */
function hurry(kernel, start, hold) {
  const { orientation, angular_velocity: omega } = start;
  try {
    return kernel.kick(start, { orientation, omega }, "factor", [FACTOR], hold);
  } catch (error) {
    if (error.message.startsWith("axis must be tilted")) return null;
    throw error;
  }
}

/** The start from its angles, its regular rates and verdicts by both holds, and on a kick. */
function* describe_start(kernel, names, pack, start) {
  const { orientation, angular_velocity } = start;
  const [angles] = kernel.call("find_angles", orientation, 1, room(3));
  const [rates] = kernel.call("find_angle_rates", orientation, angular_velocity, 1, room(3));
  yield* angles;
  yield* rates;
  const parts = kernel.call("from_angles", angles, rates, 1, room(4), room(3), room(1));
  for (const part of parts.slice(0, 2)) yield* part;
  for (const hold of ["spin_rate", "spin_momentum"]) {
    const found = kernel.findRegularRates(start, angles[1], rates[2], hold);
    yield* [...found, NaN, NaN].slice(0, 2);
    const kicked = hurry(kernel, start, hold);
    if (!kicked) continue;
    yield* kicked;
    const [before, after] = [pack(start), pack({ ...start, angular_velocity: [...kicked] })];
    yield* flatten(names, kernel.judge(before, FACTOR, hold));
    yield* flatten(names, kernel.judgeKick(before, after, hold));
  }
}

function* describe(kernel, names, pack, reader) {
  const start = read_start(reader);
  const motion = kernel.motion(start);
  const { rates } = motion;
  yield names.kinds.indexOf(motion.kind);
  yield* motion.turning_angles;
  yield motion.nutation_period;
  yield* [rates.mean_precession_rate, rates.mean_spin_rate, rates.precession_per_nutation];
  yield rates.mean_cosine;
  yield Number(rates.spin_reverses);
  yield* describe_start(kernel, names, pack, start);
  const times = reader.numbers(reader.number());
  for (const t of times) yield* motion.at(t);
  yield* list_states(motion, "states", times.length, times);
  const clock = reader.numbers(5);
  const stamps = reader.stamps(reader.number());
  yield* list_states(motion, "states_of_clock", stamps.length, clock, stamps);
  if (reader.number()) {
    const [t, ...torque] = reader.numbers(4);
    const torqued = kernel.call("continue", motion.handle, t, torque, room("handle"))[0];
    yield* new motion.constructor(kernel, torqued).at(t);
  }
}

const decode = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/** All numbers, as base64 of their bytes. `names` are those of Python, in the order of symtop.h. */
async function print_motions({ Kernel, pack }, names, module, samples) {
  const kernel = await Kernel.load(decode(module));
  const reader = new Reader(decode(samples));
  const numbers = [];
  const count = reader.number();
  for (let n = 0; n < count; n++) numbers.push(...describe(kernel, names, pack, reader));
  let text = "";
  const bytes = new Uint8Array(Float64Array.from(numbers).buffer);
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text);
}
