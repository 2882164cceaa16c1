// Colours of the scene, which its legend shares.

/** @typedef {[number, number, number]} Color red, green and blue, 0 to 1 */

/** @param {string} hex @returns {Color} */
export const readColor = (hex) =>
  /** @type {Color} */ ([1, 3, 5].map((place) => parseInt(hex.slice(place, place + 2), 16) / 255));

/** Visible on white and on black, and different for colour-blind people. */
export const COLORS = {
  L: "#0a46be",
  omega: "#009e73",
  torque: "#a81c10",
  gravity: "#e0b050",
  Coriolis: "#1e96f0",
  centrifugal: "#690fff",
  sum: "#d23ca5",
  trace: "#e69600",
  circles: "#5a86b8",
  nodes: "#963cbe",
  sphere: "#8c94a2",
  ball: "#ec8c00",
  lift: "#d81b60",
  ghost: "#c9ced6",
  points: "#1f77d0",
};

export const FICTITIOUS = "fictitious torques";
export const CHANGE = "change of L"; // and gravity, which makes it
export const WAY = "way"; // of the axle

/** Layers of the scene, and whether they are shown at first. @type {{[layer: string]: boolean}} */
export const LAYERS = {
  torque: false,
  L: false,
  omega: false,
  trace: true,
  ghost: true,
  push: true,
  points: true,
  "turning circles": false,
  "line of nodes": false,
  sphere: false,
  [CHANGE]: false,
  [WAY]: false,
  handle: true,
  [FICTITIOUS]: false,
};

/**
 * Arrows that come one by one: each has a word in the scene, which shows it.
 * @type {(keyof typeof COLORS)[]}
 */
export const ARROWS = ["torque", "L", "omega"];

/**
 * Colours that the legend names, and the layer that has them.
 * @type {[keyof typeof COLORS, string][]}
 */
export const LEGEND = [
  ["torque", "torque"],
  ["L", "L"],
  ["omega", "omega"],
  ["trace", "trace"],
  ["ghost", "ghost"],
  ["ball", "push"],
  ["points", "points"],
  ["circles", "turning circles"],
  ["nodes", "line of nodes"],
  ["gravity", FICTITIOUS],
  ["Coriolis", FICTITIOUS],
  ["centrifugal", FICTITIOUS],
  ["sum", FICTITIOUS],
];
