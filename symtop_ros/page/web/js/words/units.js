// Units that people type, each in that of SI, which comes first.
//
// Written by `python -m workshop.twins`: change base/units.py, and not this file.

/** @type {{[unit: string]: {[name: string]: number}}} */
export const UNITS = {
  rad: {
    rad: 1,
    "°": 0.017453292519943295,
    deg: 0.017453292519943295,
    degrees: 0.017453292519943295,
  },
  "rad/s": {
    "rad/s": 1,
    "°/s": 0.017453292519943295,
    "deg/s": 0.017453292519943295,
    rpm: 0.10471975511965977,
    "rev/s": 6.283185307179586,
  },
  s: { s: 1, ms: 0.001, min: 60 },
  kg: { kg: 1, g: 0.001 },
  m: { m: 1, cm: 0.01, mm: 0.001 },
  "kg m^2": { "kg m^2": 1, "g cm^2": 1e-7 },
  J: { J: 1, mJ: 0.001, "N m": 1 },
  "N m s": { "N m s": 1 },
  "1/s": { "1/s": 1 },
  "1/s^2": { "1/s^2": 1 },
  "m/s^2": { "m/s^2": 1 },
};

/** The unit of SI of what has a name. @type {{[name: string]: string}} */
export const QUANTITIES = {
  theta: "rad",
  phi: "rad",
  psi: "rad",
  dip: "rad",
  theta_dot: "rad/s",
  phi_dot: "rad/s",
  psi_dot: "rad/s",
  precession_rate: "rad/s",
  precession_rate_change: "rad/s",
  precession_period: "s",
  nutation_period: "s",
  duration: "s",
  energy: "J",
  p_phi: "N m s",
  p_psi: "N m s",
  alpha: "1/s^2",
  a: "1/s",
  b: "1/s",
  gravity: "m/s^2",
};
