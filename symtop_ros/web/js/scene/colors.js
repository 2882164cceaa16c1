// Colours of the scene, which its legend shares.

/** Visible on white and on black, and different for colour-blind people. */
export const COLORS = {
  L: "#0a46be",
  omega: "#009e73",
  torque: "#a81c10",
  gravity: "#a81c10",
  Coriolis: "#1e96f0",
  centrifugal: "#690fff",
  sum: "#d23ca5",
  trace: "#e69600",
  circles: "#5a86b8",
  nodes: "#963cbe",
  sphere: "#8c94a2",
  ball: "#ec8c00",
  ghost: "#c9ced6",
};

export const FICTITIOUS = "fictitious torques";

/** Layers of the scene, and whether they are shown at first. @type {{[layer: string]: boolean}} */
export const LAYERS = {
  L: true,
  omega: true,
  torque: true,
  trace: true,
  "turning circles": true,
  "line of nodes": true,
  ghost: true,
  sphere: true,
  handle: true,
  [FICTITIOUS]: false,
};

/** What the legend says: a colour, its name, and the layer that has it. */
/** @type {[keyof typeof COLORS, string, string][]} */
export const LEGEND = [
  ["L", "L, angular momentum", "L"],
  ["omega", "omega, angular velocity", "omega"],
  ["torque", "torque", "torque"],
  ["trace", "trace of the axis", "trace"],
  ["circles", "turning circles", "turning circles"],
  ["nodes", "line of nodes", "line of nodes"],
  ["ghost", "pale: ghost, not kicked", "ghost"],
  ["gravity", "gravity", FICTITIOUS],
  ["Coriolis", "Coriolis", FICTITIOUS],
  ["centrifugal", "centrifugal", FICTITIOUS],
  ["sum", "sum, Ix theta''", FICTITIOUS],
];
