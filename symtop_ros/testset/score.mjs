/* Score a trajectory against a problem of the test set: score.py in JavaScript, in one file.

     node score.mjs                          # lists the problems
     node score.mjs cusps trajectory.csv     # scores a trajectory
     node score.mjs cusps.turned turned.csv  # that of another description of the body

It reads problems.csv and states.csv next to it, and prints what score.py prints. A page imports
run(args, read), where read(name) returns the text of a file with a character for each byte. */

const QUATERNION = ["w", "x", "y", "z"];
const RATES = ["wx", "wy", "wz"];
const WORLD_RATES = ["omega_x", "omega_y", "omega_z"];
const DESCRIPTIONS = ["turned", "offset", "nested", "nested_half"]; // of the body
const BOM = "\u00ef\u00bb\u00bf"; // of UTF-8, with a character for each byte
const SAME_TIME = 1e-9; // relatively: a clock that adds up its steps
const LARGEST_NORM_ERROR = 0.01;
const LARGEST_NUMBER = 1e100;
const SHOWN = 60;
// An error above SMALL (rad, or part of the largest rate) is a mistake if it is MUCH smaller without.
const SMALL = 0.05;
const MUCH = 10;
const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
const SPECIAL = /^[+-]?(nan|inf|infinity)$/i;
const LINE = /\r\n|\n|\r/;

class Refused extends Error {}

const conjugate = ([w, x, y, z]) => [w, -x, -y, -z];
const reorder = ([x, y, z, w]) => [w, x, y, z];
const scale = (v, factor) => v.map((each) => each * factor);
const norm = (v) => Math.sqrt(v.reduce((sum, each) => sum + each * each, 0));
const radians = (v) => scale(v, Math.PI / 180);
const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];

/** A vector of the world in the frame of the body. */
function turnToBody(q, v) {
  const xyz = scale(q.slice(1), -1);
  const twice = scale(cross(xyz, v), 2);
  const rest = cross(xyz, twice);
  return v.map((each, i) => each + q[0] * twice[i] + rest[i]);
}

const ATTITUDES = {
  "the quaternions have the order x, y, z, w": reorder,
  "the quaternions are conjugate: world to body": conjugate,
  "the quaternions are conjugate, in the order x, y, z, w": (q) => conjugate(reorder(q)),
};
const VELOCITIES = {
  "the angular velocities are in deg/s": (q, omega) => radians(omega),
  "the angular velocities are in the world frame": turnToBody,
  "the angular velocities are in deg/s, in the world frame": (q, v) => turnToBody(q, radians(v)),
};

/** A decimal as a sum of two doubles, which hold about 32 digits. */
export function splitDecimal(text) {
  const [, sign, whole, part = "", power = "0"] =
    /^([+-]?)(\d*)\.?(\d*)(?:e([+-]?\d+))?$/i.exec(text);
  const high = Number(text);
  let numerator = BigInt(`${sign}${whole}${part}`);
  let denominator = 1n;
  const exponent = Number(power) - part.length;
  if (exponent < 0) denominator = 10n ** BigInt(-exponent);
  else numerator *= 10n ** BigInt(exponent);
  const [mantissa, places] = splitDouble(high);
  // text - mantissa 2^places, over one denominator
  if (places < 0) {
    numerator = (numerator << BigInt(-places)) - mantissa * denominator;
    denominator <<= BigInt(-places);
  } else {
    numerator -= (mantissa << BigInt(places)) * denominator;
  }
  return [high, divide(numerator, denominator)];
}

/** A double as an integer times a power of two. */
function splitDouble(value) {
  const bits = new DataView(new ArrayBuffer(8));
  bits.setFloat64(0, value);
  const raw = bits.getBigUint64(0);
  const power = Number((raw >> 52n) & 0x7ffn);
  const digits = (raw & 0xfffffffffffffn) | (power ? 1n << 52n : 0n);
  return [raw >> 63n ? -digits : digits, Math.max(power, 1) - 1075];
}

function divide(numerator, denominator) {
  const size = (n) => (n < 0n ? -n : n).toString(2).length;
  const shift = Math.max(size(denominator) - size(numerator) + 64, 0);
  return Number((numerator << BigInt(shift)) / denominator) * 2 ** -shift;
}

/** Angle of the rotation that would correct an attitude, which is of either sign. */
function measureAngle(q, high, low) {
  const far = q.reduce((sum, each, i) => sum + each * high[i], 0) < 0;
  const apart = q.map((each, i) => (far ? -each : each) - high[i] - low[i]);
  return 4 * Math.asin(Math.min(norm(apart) / 2, 1));
}

/** Numbers as C and Python write them: %.{digits}g, and %.{digits}e. */
function formatGeneral(value, digits) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
  const exponent = value === 0 ? 0 : Number(value.toExponential(digits - 1).split("e")[1]);
  if (exponent < -4 || exponent >= digits) {
    const [mantissa, power] = formatExponent(value, digits - 1).split("e");
    return `${mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa}e${power}`;
  }
  return String(Number(value.toFixed(digits - 1 - exponent)));
}

function formatExponent(value, digits) {
  const [mantissa, power] = value.toExponential(digits).split("e");
  return `${mantissa}e${power[0]}${power.slice(1).padStart(2, "0")}`;
}

/** The beginning of a line, with other characters than ASCII replaced. */
function show(text) {
  const line = text.trim().replaceAll("\t", " ").slice(0, SHOWN);
  return line.replace(/[^ -~]/g, "?") || "nothing";
}

const unquote = (text) => text.trim().replace(/^"+|"+$/g, "");

/** Problems by their names, each with its level, duration and description. */
function readProblems(read) {
  const [head, ...rows] = read("problems.csv").split(LINE).filter(Boolean);
  const names = head.split(",");
  return new Map(
    rows.map((row) => {
      const cells = row.split(",");
      const what = unquote(cells.slice(names.length - 1).join(",")); // the last column has commas
      const find = (name) => cells[names.indexOf(name)];
      return [find("name"), { level: find("level"), duration: Number(find("duration")), what }];
    }),
  );
}

function readStates(read, name, prefix) {
  const [head, ...rows] = read("states.csv").split(LINE);
  const names = head.split(",");
  const places = (columns) => columns.map((each) => names.indexOf(each));
  const [time, limit, limit32] = places(["t", "orientation_limit", "orientation_limit_float32"]);
  return rows
    .filter((row) => row.startsWith(`${name},`))
    .map((row) => {
      const cells = row.split(",");
      const pairs = (columns) =>
        places(columns.map((each) => prefix + each)).map((each) => splitDecimal(cells[each]));
      const [q, omega] = [pairs(QUATERNION), pairs(RATES)];
      return {
        t: Number(cells[time]),
        q: q.map(([high]) => high),
        qLow: q.map(([, low]) => low),
        omega: omega.map(([high]) => high),
        omegaLow: omega.map(([, low]) => low),
        limit: Number(cells[limit]),
        limit32: Number(cells[limit32]),
      };
    });
}

function readNumber(text) {
  const cell = unquote(text ?? "");
  if (NUMBER.test(cell)) return Number(cell);
  if (!SPECIAL.test(cell)) throw new RangeError(cell);
  if (/nan/i.test(cell)) return NaN;
  return cell.startsWith("-") ? -Infinity : Infinity;
}

/** Numbers of the rows at the times of the states, and whether they have rates. */
function readTrajectory(text, path, states) {
  const [first, ...rows] = (text.startsWith(BOM) ? text.slice(BOM.length) : text).split(LINE);
  const head = first.trim();
  const separator = [",", ";", "\t"].find((each) => head.includes(each));
  const split = (row) => (separator ? row.split(separator) : row.trim().split(/\s+/));
  const header = split(head.replace(/^#/, "")).map(unquote);
  const has = (columns) => columns.every((each) => header.includes(each));
  if (!has(["t", ...QUATERNION])) {
    throw new Refused(`${path} must have the columns t, w, x, y, z, got the header ${show(head)}`);
  }
  const rates = [RATES, WORLD_RATES].find(has) ?? [];
  const places = ["t", ...QUATERNION, ...rates].map((each) => header.indexOf(each));
  const found = pick(rows, split, places, states);
  if (rates !== WORLD_RATES) return found;
  return found.map((row) => {
    const q = row.slice(0, 4);
    return [...q, ...turnToBody(scale(q, 1 / norm(q)), row.slice(4))];
  });
}

function pick(rows, split, places, states) {
  const found = states.map(() => null);
  const nearest = states.map(() => null);
  rows.forEach((row, number) => {
    if (!row.trim()) return;
    try {
      const cells = split(row);
      const read = (place) => {
        if (place < cells.length) return readNumber(cells[place]);
        throw new Refused(`line ${number + 2} must have all columns, got ${show(row)}`);
      };
      const t = read(places[0]);
      if (!Number.isFinite(t)) return;
      states.forEach((state, k) => {
        const apart = Math.abs(state.t - t);
        if (nearest[k] === null || apart < Math.abs(state.t - nearest[k])) nearest[k] = t;
        if (apart <= SAME_TIME * state.t) {
          found[k] = places.slice(1).map(read);
        }
      });
    } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      throw new Refused(`line ${number + 2} must consist of numbers, got ${show(row)}`);
    }
  });
  const absent = found.indexOf(null);
  if (absent >= 0) {
    const near = nearest[absent];
    const text = near === null ? "there is no row" : `the nearest is ${formatGeneral(near, 12)} s`;
    const t = formatGeneral(states[absent].t, 12);
    throw new Refused(`trajectory must have a state at each time, got none at ${t} s; ${text}`);
  }
  return found;
}

function check(name, rows) {
  const wrong = rows.flat().find((each) => !(Math.abs(each) <= LARGEST_NUMBER));
  if (wrong !== undefined) {
    const got = formatGeneral(wrong, 6);
    throw new Refused(`${name} must be finite numbers up to 1e+100, got ${got}`);
  }
}

/** The mistake without which a large error would be small, in a list. */
function nameMistake(errors, changes, size) {
  const others = Object.entries(changes).map(([text, list]) => [text, Math.max(...list)]);
  const [text, least] = others.reduce((best, each) => (each[1] < best[1] ? each : best));
  const largest = Math.max(...errors);
  return largest > SMALL * size && least < largest / MUCH ? [text] : [];
}

const changeAll = (changes, measure) =>
  Object.fromEntries(Object.entries(changes).map(([text, mend]) => [text, measure(mend)]));

/** Errors at the times of a problem: {angles, rates, mistakes}. */
export function score(rows, states) {
  const given = rows.map((row) => row.slice(0, 4));
  check("orientations", given);
  const norms = given.map(norm);
  const worst = norms.reduce((a, b) => (Math.abs(b - 1) > Math.abs(a - 1) ? b : a));
  if (Math.abs(worst - 1) > LARGEST_NORM_ERROR) {
    const got = formatGeneral(worst, 6);
    throw new Refused(`orientations must be unit quaternions, got a norm of ${got}`);
  }
  const q = given.map((each, k) => each.map((component) => component / norms[k]));
  const measure = (mend) => q.map((each, k) => measureAngle(mend(each), states[k].q, states[k].qLow));
  const angles = measure((each) => each);
  const mistakes = nameMistake(angles, changeAll(ATTITUDES, measure), 1);
  if (rows[0].length === 4) return { angles, rates: null, mistakes };
  const omega = rows.map((row) => row.slice(4));
  check("angular_velocities", omega);
  const apart = (mend) =>
    omega.map((each, k) => {
      const { q: exact, omega: high, omegaLow: low } = states[k];
      return norm(mend(exact, each).map((value, i) => value - high[i] - low[i]));
    });
  const rates = apart((_, each) => each);
  const size = Math.max(...states.map((each) => norm(each.omega)));
  mistakes.push(...nameMistake(rates, changeAll(VELOCITIES, apart), size));
  return { angles, rates, mistakes };
}

/** The score in a line, and likely mistakes in lines of their own. */
function formatScore(name, { angles, rates, mistakes }, states) {
  const largest = (values) => formatExponent(Math.max(...values), 1);
  const limits = (key) => formatGeneral(Math.max(...angles.map((a, k) => a / states[k][key])), 2);
  const mean = angles.reduce((sum, each) => sum + each, 0) / angles.length;
  const line =
    `${name}: attitude ${largest(angles)} rad at most (mean ${formatExponent(mean, 1)}), ` +
    `${limits("limit")} limits (${limits("limit32")} of float32)` +
    (rates ? `; angular velocity ${largest(rates)} rad/s at most` : "");
  return [line, ...mistakes.map((each) => `likely mistake: ${each}`)].join("\n");
}

function listProblems(problems) {
  const rows = [...problems].map(([name, { level, duration, what }]) => {
    const end = `${formatGeneral(duration, 6)} s`;
    return `${level.padStart(5)}  ${name.padEnd(18)}${end.padStart(8)}  ${what}`;
  });
  return ["level  name              duration  what", ...rows].join("\n");
}

function demand(what, known, name, text) {
  if (known.includes(name)) return;
  const got = text.trim().split(/\s+/).join(" ").slice(0, SHOWN);
  throw new Refused(`${what} must be one of ${known.join(", ")}, got ${got}`);
}

/** Score, or list the problems; the functions return the text of a file, or throw. */
export function run([name, path], readSet, readFile) {
  try {
    const problems = readProblems(readSet);
    if (!name) return { status: 0, out: listProblems(problems), err: "" };
    const [base, ...rest] = name.split(".");
    const description = rest.join(".");
    demand("problem", [...problems.keys()], base, name);
    if (rest.length) demand("description", DESCRIPTIONS, description, description);
    if (path === undefined) {
      throw new Refused(`trajectory must be a CSV file for ${name}, got none`);
    }
    const states = readStates(readSet, base, description === "turned" ? "turned_" : "");
    const found = score(readTrajectory(readFile(path), path, states), states);
    return { status: 0, out: formatScore(name, found, states), err: "" };
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
    return { status: 1, out: "", err: error.message };
  }
}

const CAUSES = { ENOENT: "No such file or directory", EISDIR: "Is a directory" };

async function main() {
  const { readFileSync } = await import("node:fs");
  const args = process.argv.slice(2);
  if (args.length > 2 || args.some((each) => each.startsWith("-"))) {
    console.error("usage: node score.mjs [PROBLEM [TRAJECTORY]]");
    return 2;
  }
  const read = (name, place, encoding) => {
    try {
      return readFileSync(place, encoding);
    } catch (error) {
      throw new Refused(`${name}: ${CAUSES[error.code] ?? error.code}`);
    }
  };
  const readSet = (name) => read(name, new URL(name, import.meta.url), "utf8");
  const { status, out, err } = run(args, readSet, (name) => read(name, name, "latin1"));
  if (out) console.log(out);
  if (err) console.error(err);
  return status;
}

if (typeof process !== "undefined" && process.argv?.[1]?.endsWith("score.mjs")) {
  process.exitCode = await main();
}
