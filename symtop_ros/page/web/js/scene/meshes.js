// The shapes of the scene as triangles: surfaces of revolution, in sectors of two colours that make
// the spin visible. Lengths are in scene units: the pivot is the origin, and the axis ends at 1.

import { spread } from "../physics/spread.js";
import { readColor } from "./colors.js";

/** @import { Color } from "./colors.js" */
/** @import { Top } from "../physics/kernel.js" */
/** @typedef {[number, number][]} Profile radius and height, from the lowest point upwards */
/**
 * Place, normal and colour, three numbers each, of every corner of a triangle.
 * @typedef {Float32Array<ArrayBuffer>} Mesh
 */

const WIDTH = 9; // numbers of a corner
const SECTORS = 6; // three pairs of colours: after half a turn the colours are exchanged
const LARGEST = 0.46; // radius of a rotor: it stays above the ground
const FACETS = 16; // of a sector
const PIECES = 5; // of an edge of a curve
/** Cosine and sine of the angles at which facets meet, once around. */
const AROUND = Array.from({ length: SECTORS * FACETS + 1 }, (_, k) => {
  const angle = (2 * Math.PI * k) / (SECTORS * FACETS);
  return [Math.cos(angle), Math.sin(angle)];
});
const SHARP = 0.6; // cosine: edges that meet in a larger angle have a crease between them

/** @param {number[]} radii @param {number[]} heights @returns {Profile} */
const createProfile = (radii, heights) => radii.map((radius, k) => [radius, heights[k]]);

/**
 * A curve through points (Catmull-Rom), for profiles and legs that shall have no kinks.
 * @param {number[][]} points @returns {number[][]}
 */
const createCurve = (points) => {
  const last = points.length - 1;
  const curve = points.slice(1).flatMap((_, k) => {
    const near = [Math.max(k - 1, 0), k, k + 1, Math.min(k + 2, last)].map((n) => points[n]);
    return Array.from({ length: PIECES }, (_, piece) => mix(near, piece / PIECES));
  });
  return [...curve, points[last]];
};

/** Between the second and the third of four points. @param {number[][]} points @param {number} t */
const mix = ([a, b, c, d], t) =>
  b.map((_, k) => {
    const [bend, turn] = [2 * a[k] - 5 * b[k] + 4 * c[k] - d[k], 3 * (b[k] - c[k]) + d[k] - a[k]];
    return b[k] + (t * (c[k] - a[k] + t * (bend + t * turn))) / 2;
  });

/** Of the two triangles of a facet: whether a corner is at its end, and whether it is above. */
const CORNERS = createProfile([0, 1, 0, 1, 1, 0], [0, 0, 1, 0, 1, 1]);

const STEEL = readColor("#c4cad2");
const BRASS = readColor("#deb25c");
const ENAMEL = readColor("#96202c");
const IVORY = readColor("#f0e6cd");
const STONE = readColor("#8b93a1");

/** The normals of the edges of a profile, outwards and up. @param {Profile} profile @returns {Profile} */
const findNormals = (profile) =>
  profile.slice(1).map(([s, y], k) => {
    const [r, z] = profile[k];
    const length = Math.hypot(y - z, r - s) || 1;
    return [(y - z) / length, (r - s) / length];
  });

/**
 * The normal of an edge where another one joins it: the mean of both, unless there is a crease.
 * @param {[number, number]} own @param {[number, number]} other @returns {[number, number]}
 */
const joinNormals = (own, other = own) => {
  const cosine = own[0] * other[0] + own[1] * other[1];
  if (cosine < SHARP) return own;
  const size = Math.sqrt(2 + 2 * cosine);
  return [(own[0] + other[0]) / size, (own[1] + other[1]) / size];
};

/**
 * The surface of a profile turned about z.
 * @param {Profile} profile @param {Color} first @param {Color} second @returns {Mesh}
 */
export const createLathe = (profile, first, second = first) => {
  const normals = findNormals(profile);
  const count = SECTORS * FACETS;
  const mesh = new Float32Array(normals.length * count * CORNERS.length * WIDTH);
  let place = 0;
  normals.forEach((normal, edge) => {
    const ends = [edge - 1, edge + 1].map((each) => joinNormals(normal, normals[each]));
    for (let facet = 0; facet < count; facet += 1) {
      const color = Math.floor(facet / FACETS) % 2 ? second : first;
      for (let k = 0; k < CORNERS.length; k += 1, place += WIDTH) {
        // by index: to take arrays apart takes several times as long here
        const around = AROUND[facet + CORNERS[k][0]];
        const point = profile[edge + CORNERS[k][1]];
        const end = ends[CORNERS[k][1]];
        mesh[place] = point[0] * around[0];
        mesh[place + 1] = point[0] * around[1];
        mesh[place + 2] = point[1];
        mesh[place + 3] = end[0] * around[0];
        mesh[place + 4] = end[0] * around[1];
        mesh[place + 5] = end[1];
        for (let part = 0; part < 3; part += 1) mesh[place + 6 + part] = color[part];
      }
    }
  });
  return mesh;
};

/** @param {Mesh[]} meshes @returns {Mesh} */
const join = (meshes) => {
  const mesh = new Float32Array(meshes.reduce((sum, each) => sum + each.length, 0));
  let place = 0;
  for (const each of meshes) {
    mesh.set(each, place);
    place += each.length;
  }
  return mesh;
};

export const CENTER = 0.56; // height of the rotor along the axle

/** The radius of a rotor, wider for a larger Iz/Ix. @param {Top} top */
export const findRadius = ({ Ix, Iz }) => Math.min(0.22 + 0.4 * Math.sqrt(Iz / Ix), LARGEST);

/** The rotor: a flat pear, widest at the centre of mass. @param {number} radius @param {number} height */
const createRotor = (radius, height) => {
  const radii = [0.022, 0.1, 0.35, 0.72, 0.94, 0.94, 0.8, 0.45, 0.16, 0.022];
  const heights = [-0.2, -0.17, -0.11, -0.06, -0.035, 0.035, 0.05, 0.075, 0.105, 0.14];
  const scaled = createProfile(
    radii.map((each) => Math.max(0.022, each * radius)),
    heights.map((each) => height + each),
  );
  const [lower, upper] = [scaled.slice(0, 5), scaled.slice(5)].map(createCurve);
  /** @type {Profile} */
  const rim = spread(-Math.PI / 2, Math.PI / 2, 13).map((angle) => {
    return [(0.94 + 0.06 * Math.cos(angle)) * radius, height + 0.035 * Math.sin(angle)];
  });
  return join([
    createLathe(/** @type {Profile} */ (lower), IVORY, ENAMEL),
    createLathe(/** @type {Profile} */ (upper), IVORY, ENAMEL),
    createLathe(rim, BRASS),
  ]);
};

/** The body of a top: its rotor is at the centre of mass. @param {Top} top */
export const createBody = (top) => {
  const height = CENTER * Math.sign(top.Mgl);
  const low = Math.min(0, height - 0.22);
  const heights = [low, low + 0.03, 0.93, 0.95, 0.985, 1];
  const axle = createProfile([0, 0.022, 0.022, 0.034, 0.034, 0], heights);
  return join([createLathe(axle, STEEL), createRotor(findRadius(top), height)]);
};

/**
 * A box between two squares, by their half widths, places and heights: four sides.
 * @param {[x: number, y: number, z: number, half: number][]} ends @returns {Mesh}
 */
const createBeam = ([[x, y, z, half], [u, v, w, last]]) => {
  const sides = Array.from({ length: 4 }, (_, side) => {
    const [c, s] = [Math.cos((Math.PI * side) / 2), Math.sin((Math.PI * side) / 2)];
    return CORNERS.flatMap(([corner, isUpper]) => {
      const [a, b, height, size] = isUpper ? [u, v, w, last] : [x, y, z, half];
      const across = corner ? size : -size;
      return [a + size * c - across * s, b + size * s + across * c, height, c, s, 0, ...STONE];
    });
  });
  return new Float32Array(sides.flat());
};

/** The tower of a toy gyroscope: four legs that bend outwards, two floors, and a cup for the peg. */
export const createStand = () => {
  const heights = [-0.36, -0.31, -0.26, -0.2, -0.13, -0.08, -0.03];
  const widths = [0.18, 0.13, 0.096, 0.072, 0.047, 0.031, 0.022];
  const curve = createCurve(createProfile(widths, heights));
  const legs = [0, 1, 2, 3].flatMap((leg) =>
    curve.slice(1).map((end, k) => {
      const ends = [curve[k], end].map(([width, height]) => {
        const [x, y] = [leg % 2 ? 1 : -1, leg > 1 ? 1 : -1].map((sign) => sign * width);
        return /** @type {[number, number, number, number]} */ ([
          x,
          y,
          height,
          0.006 + 0.06 * width,
        ]);
      });
      return createBeam(ends);
    }),
  );
  const floors = [-0.26, -0.13].map((height) => {
    const half = 0.025 - 0.27 * height;
    return createBeam([
      [0, 0, height - 0.008, half],
      [0, 0, height + 0.008, half],
    ]);
  });
  const cup = createProfile([0, 0.034, 0.036, 0.026, 0], [-0.05, -0.045, -0.006, -0.002, -0.012]);
  return join([...legs, ...floors, createLathe(cup, STONE)]);
};

/** A shaft of length 1 along z, to be scaled, and a head whose tip is the origin. @param {Color} color */
export const createArrow = (color) => ({
  shaft: createLathe(createProfile([0, 0.013, 0.013], [0, 0, 1]), color),
  head: createLathe(createProfile([0, 0.036, 0], [-0.1, -0.1, 0]), color),
});

/** A ball of radius 1. @param {Color} color */
export const createBall = (color) => {
  /** @type {Profile} */
  const profile = spread(0, Math.PI, 33).map((angle) => [Math.sin(angle), -Math.cos(angle)]);
  return createLathe(profile, color);
};

/** A flat disc of radius 1, with its own x and y in place of a colour. @returns {Mesh} */
export const createDisc = () => {
  const disc = createLathe(createProfile([1, 0], [0, 0]), [0, 0, 0]);
  return disc.map((number, k) => (k % WIDTH === 6 || k % WIDTH === 7 ? disc[k - 6] : number));
};
