// Enums and records of symtop.h, for the page.
//
// Written by `python -m workshop.twins`: change the header, and not this file.

/** The numbers of symtop_status. @type {{[name: string]: number}} */
export const STATUS = {
  OK: 0,
  NO_MEMORY: 1,
  BAD_TOP: 2,
  BAD_ORIENTATION: 3,
  BAD_ANGULAR_VELOCITY: 4,
  BAD_FRICTION: 5,
  BAD_TORQUE: 6,
  BAD_TIME: 7,
  TOO_FAR: 8,
  TOO_FAST: 9,
  TOO_STIFF: 10,
  MORE_STEPS: 11,
  BAD_ARITHMETIC: 12,
  BAD_ANGLES: 13,
  BAD_KICK: 14,
  VERTICAL: 15,
  TOO_LONG: 16,
  BAD_POINTER: 17,
  BAD_COUNT: 18,
  BAD_HOLD: 19,
  BAD_KICK_KIND: 20,
  BAD_RATE: 21,
  BAD_STEPS: 22,
  BAD_DISC: 23,
  BAD_PUSHES: 24,
};

/** Names of the enums, in the order of the header. @type {{[list: string]: any[]}} */
export const NAMES = {
  friction_kind: ["axial", "transverse"],
  kind: [
    "regular",
    "unidirectional",
    "cusps",
    "looping",
    "through the pole",
    "asymptotic",
    "sleeping",
    "driven",
  ],
  engine: ["closed form", "free", "taylor"],
  hold: ["spin_rate", "spin_momentum", null],
  kick_kind: ["rate", "change", "factor", "impulse", "axle"],
  subject: ["top", "axis"],
  direction: ["rises", "falls", "stays"],
  rule: [null, "holds", "fails"],
  place_kind: ["none", "only", "above", "below", "slow", "fast", "between", "outside"],
  reason_kind: [
    "hurried",
    "delayed",
    "if_hurried",
    "if_delayed",
    "angular_impulse",
    "no_precession",
    "unchanged",
    "reversed",
    "no_effect",
    "undefined",
    "stable",
    "unstable",
  ],
  lift_kind: ["unchanged", "higher", "lower"],
  fact: ["rises", "falls", "highest_higher", "highest_lower", "lowest_higher", "lowest_lower"],
};

/**
 * A type and a field in turn: a number, a record, one of a list of names, or its bits.
 * @type {{[record: string]: string[][]}}
 */
export const RECORDS = {
  start: [
    ["double", "Ix"],
    ["double", "Iz"],
    ["double", "Mgl"],
    ["double 4", "orientation"],
    ["double 3", "angular_velocity"],
    ["double 2", "friction"],
    ["double 3", "torque"],
  ],
  pushes: [
    ["double", "impulse"],
    ["double", "rate"],
    ["double", "number"],
  ],
  clock: [
    ["double", "factor"],
    ["double 4", "elapsed"],
  ],
  piece: [
    ["start", "start"],
    ["double", "begin"],
    ["double", "number"],
  ],
  rates: [
    ["double", "nutation_period"],
    ["double", "mean_precession_rate"],
    ["double", "mean_spin_rate"],
    ["double", "precession_per_nutation"],
    ["flag", "spin_reverses"],
  ],
  constants: [
    ["kind", "kind"],
    ["engine", "engine"],
    ["double 2", "turning_angles"],
    ["rates", "rates"],
  ],
  top: [
    ["double", "Ix"],
    ["double", "Iz"],
    ["double", "Mgl"],
  ],
  place: [
    ["place_kind", "kind"],
    ["double", "rate"],
    ["double 2", "regular_rates"],
  ],
  reason: [
    ["reason_kind", "kind"],
    ["rule", "rule"],
    ["double", "before"],
    ["double", "after"],
    ["double", "theta_ddot_without"],
    ["double", "theta_ddot"],
    ["place", "place"],
  ],
  average: [
    ["double", "rate"],
    ["double", "turns"],
    ["double", "fast_top_rate"],
    ["flag", "is_fast"],
    ["flag", "spin_reverses"],
  ],
  lift: [
    ["lift_kind", "kind"],
    ["double", "amount"],
  ],
  verdict: [
    ["subject", "subject"],
    ["direction", "direction"],
    ["double 2", "turning_angles"],
    ["kind", "motion"],
    ["reason", "reason"],
    ["average", "average"],
    ["double", "factor"],
    ["lift", "highest"],
    ["lift", "lowest"],
    ["fact bits", "contrary_facts"],
  ],
};
