// The scene: the top, its arrows and lines, the ghost, and the ball that is pulled.

import { find } from "../controls/document.js";
import { Camera } from "./camera.js";
import { listParallel, listPieces, listSphere } from "./curves.js";
import { add, createPose, findSize, normalize, scale, subtract, turnTo } from "./matrices.js";
import {
  CENTER,
  createArrow,
  createBall,
  createBody,
  createDisc,
  createStand,
  findRadius,
} from "./meshes.js";
import { chooseSpan, findChange, findWay } from "./change.js";
import { CHANGE, COLORS, FICTITIOUS, readColor, WAY } from "./colors.js";
import { Grip } from "./grip.js";
import { Labels } from "./labels.js";
import { Painter } from "./painter.js";
import { findPush, listReached, listBracket } from "./push.js";
import { findTorques, findVectors } from "./vectors.js";
import { NANO } from "../physics/course.js";
import { writeNumber } from "../words/numbers.js";
import { writePoint } from "../words/points.js";
import { inDegrees } from "../words/quantities.js";
import { phrase } from "../words/wording.js";

/** @import { LocalTop } from "../run/local.js" */
/** @import { State } from "../physics/state.js" */
/** @import { Twist } from "./push.js" */
/** @import { Vector } from "../physics/kernel.js" */

const LENGTHS = { L: 1.14, omega: 1.13, torque: 0.55 }; // of the largest at the start of a motion
const DEPTHS = { gravity: 0.1, Coriolis: 0.2, centrifugal: 0.3, sum: -0.1 }; // below the pivot
const LONGEST = 2.5; // of a fictitious torque
const TWIST_HEAD = 0.05; // length of the arrow at the end of a twist
const SHORTEST = 0.02; // arrows that are shorter have no direction that can be seen
const GHOST_OPACITY = 0.34;
const BALL = 0.055;
const LEAD = 36; // px from the pale ball to its name
const ASIDE = 16; // px from a bracket to its words
const CROSS = 0.013; // arm of a measured point
const PUSH = 0.34; // length of the arrow of a push, and of the way
const WEIGHT = 0.44; // length of the arrow of gravity
// rad; the axis goes below the pivot: no stand, and the whole sphere
const WIDE = 1.1;
const HORIZON = 1.65;
const GROUND = -0.365;
const SOFT = 0.18; // the edge of a shadow
const FOOT = 0.34; // the stand's
/** @type {{eye: Vector, target: Vector}[]} */
const VIEWS = [
  { eye: [1.46, -1.7, 0.95], target: [0, 0, 0.33] },
  { eye: [2, -2.33, 0.95], target: [0, 0, 0] },
  { eye: [2, -2.33, -0.95], target: [0, 0, 0] },
  { eye: [1.9, -2.2, 1.1], target: [0, 0, 0.25] }, // on the stand, and far from it
];
const STILL = createPose([1, 0, 0, 0]);

/** @param {keyof typeof COLORS} name */
const paint = (name) => readColor(COLORS[name]);

export class Scene {
  /** @param {LocalTop} top */
  constructor(top) {
    const canvas = find("picture", HTMLCanvasElement);
    this.painter = new Painter(canvas);
    /** Says that the picture is lost, or null when it is back. @type {(text: string | null) => void} */
    this.tellLoss = () => {};
    this.camera = new Camera(canvas);
    this.labels = new Labels(find("labels"), this.camera);
    this.top = top;
    /** @type {{[name: string]: number}} */
    this.scales = {};
    this.view = -1; // index of `VIEWS`
    this.torqueScale = 1;
    this.span = 0; // ns for which the change of L is drawn
    this.bodyKey = "";
    /** The motion whose turning circles are loaded. @type {import("../physics/course.js").Course | null} */
    this.circled = null;
    /** What the last kick did. @type {import("./push.js").Push | null} */
    this.push = null;
    this.models = this.loadModels();
    this.grip = new Grip(canvas, this.camera, top);
    canvas.addEventListener("webglcontextlost", (event) => this.lose(event));
    canvas.addEventListener("webglcontextrestored", () => this.restore());
  }

  /** A graphics card may be reset, or be given to another program. @param {Event} event */
  lose(event) {
    event.preventDefault(); // the browser gives it back
    this.labels.begin();
    this.labels.end();
    this.tellLoss(phrase("page.picture_lost"));
  }

  restore() {
    this.painter.programs = this.painter.prepare();
    this.models = this.loadModels();
    this.bodyKey = "";
    this.circled = null;
    this.begin();
    this.tellLoss(null);
  }

  /** Load what is drawn: at first, and after the graphics card has lost everything. */
  loadModels() {
    const { painter } = this;
    const vectors = ["L", "omega", "torque", "ball", ...Object.keys(DEPTHS)];
    const names = /** @type {(keyof typeof COLORS)[]} */ (vectors);
    const arrows = names.map((name) => {
      const { shaft, head } = createArrow(paint(name));
      return [name, { shaft: painter.loadMesh(shaft), head: painter.loadMesh(head) }];
    });
    return {
      arrows: Object.fromEntries(arrows),
      stand: painter.loadMesh(createStand()),
      ball: painter.loadMesh(createBall(paint("ball"))),
      ghost: painter.loadMesh(createBall(paint("ghost"))),
      disc: painter.loadMesh(createDisc()),
      bracket: painter.loadLines([]),
      twist: painter.loadLines([]),
      nodes: painter.loadLines([-0.4, 0, 0, 0.4, 0, 0]),
      sphere: painter.loadLines([]),
      circles: painter.loadLines([]),
      trace: painter.loadLines([]),
      points: painter.loadLines([]),
      body: painter.loadMesh(new Float32Array()),
    };
  }

  /** What holds for a whole motion: the body, circles, the scales of the arrows, the camera. */
  begin() {
    const { painter, top } = this;
    const { course, state } = top;
    const key = JSON.stringify(course.top);
    if (key !== this.bodyKey) {
      painter.loadMesh(createBody(course.top), this.models.body);
      this.bodyKey = key;
    }
    const angles = course.free.motion.turning_angles;
    for (const [name, vector] of Object.entries(findVectors(course, state))) {
      const largest = name === "torque" ? Math.abs(course.top.Mgl) : findSize(vector);
      this.scales[name] = largest
        ? LENGTHS[/** @type {keyof typeof LENGTHS} */ (name)] / largest
        : 0;
    }
    this.push = findPush(top.run.find(top.time));
    const torques = findTorques(course.top, state);
    this.torqueScale =
      Math.max(Math.abs(course.top.Mgl), ...Object.values(torques).slice(0, 3).map(Math.abs)) || 1;
    this.span = chooseSpan(course, state);
    const isBelow = course.top.Mgl < 0 || angles[1] > HORIZON;
    const below = course.top.Mgl < 0 && findVectors(course, state).L[2] < 0 ? 2 : 1;
    const view = isBelow ? below : angles[1] > WIDE ? 3 : 0;
    if (view !== this.view) {
      this.view = view;
      this.camera.place(VIEWS[view].eye, VIEWS[view].target);
    }
    painter.loadLines(listSphere(isBelow), this.models.sphere);
  }

  /** @param {State} state now @param {State[]} states of the trace */
  draw(state, states) {
    const { painter, camera, grip } = this;
    if (painter.gl.isContextLost()) return;
    painter.begin(camera.matrix, camera.eye, camera.size);
    this.labels.begin();
    this.drawBody(grip.preview ?? state);
    this.drawLines(state, states);
    if (!grip.preview) this.drawVectors(state);
    if (this.top.layers.push) this.drawPush(state, states);
    if (this.top.layers.ghost) this.drawGhost();
    if (this.top.layers.points) this.drawPoints();
    this.labels.end();
  }

  /** Measured points of the axis as crosses, and what the motion leaves of the one that is pointed at. */
  drawPoints() {
    const { painter, camera, models, top } = this;
    const { marks, trace } = top;
    const seen = marks.list(trace.since, top.time).filter(({ shows }) => shows.includes("phi"));
    const places = seen.map(({ state }) => state.toWorld([0, 0, 1]));
    const crosses = seen.flatMap(({ state }, k) =>
      [state.toWorld([CROSS, 0, 0]), state.toWorld([0, CROSS, 0])].flatMap((arm) => [
        ...subtract(places[k], arm),
        ...add(places[k], arm),
      ]),
    );
    painter.loadLines(crosses, models.points);
    painter.drawLines(models.points, paint("points"), 2, STILL);
    const dots = seen.flatMap(({ place }, k) => {
      const at = camera.project(places[k]);
      return at ? [/** @type {[number, number, number]} */ ([at.x, at.y, place])] : [];
    });
    marks.keep("picture", dots, camera.size.width);
    const told = marks.describe();
    const pointed = seen.findIndex(({ place }) => place === marks.pointed);
    if (told && pointed >= 0)
      this.labels.put("point", COLORS.points, places[pointed], [0, 0, 0], writePoint(told), LEAD);
  }

  /**
   * Draw another top for a while.
   * @template T
   * @param {LocalTop} top @param {() => T} work with its picture
   */
  lend(top, work) {
    const own = this.top;
    try {
      this.top = top;
      this.begin();
      this.draw(top.state, top.trace.findStates(top.trace.listTimes()));
      return work();
    } finally {
      this.top = own;
      this.begin();
    }
  }

  /** The top that was not pushed, or not clamped; without such an act the one that was measured. */
  drawGhost() {
    const { painter, models, top } = this;
    const spared = top.run.findGhost(top.time);
    const ghost = spared ?? top.marks.findGhost();
    if (!ghost) return;
    painter.drawMesh(models.body, createPose(ghost.orientation), GHOST_OPACITY);
    const axis = ghost.toWorld([0, 0, 1]);
    const size = 0.8 * BALL;
    painter.drawMesh(models.ghost, createPose([1, 0, 0, 0], [size, size, size], axis), 0.8);
    const isFree = top.run.findSpared(top.time) === "clamp";
    const key = isFree ? "scene.ghost_free" : "scene.ghost";
    const name = phrase(spared ? key : "fitted.ghost");
    this.labels.put("ghost", COLORS.sphere, axis, null, name, LEAD);
  }

  /**
   * The push where it was, and the brackets from the old heights to the new ones.
   * @param {State} state @param {State[]} states
   */
  drawPush(state, states) {
    const { push, top } = this;
    if (!push) return;
    const { time } = top;
    if (push.way && time < push.end) {
      const arrow = scale(push.way, PUSH);
      const begin = subtract(push.tip, arrow);
      this.drawArrow("ball", arrow, begin, "");
      const { twist } = push;
      const name = twist ? phrase("scene.push_held", twist) : phrase("scene.push");
      this.labels.put("push", COLORS.ball, begin, push.tip, name, 4);
      if (twist) this.drawTwist(twist);
    }
    const { window, points } = top.trace;
    const past = states.slice(-Math.ceil(((time - push.begin) / (window * NANO)) * points));
    for (const lift of listReached(push, time, past)) this.drawBracket(lift, state);
  }

  /** The twist of a kick, as an arc about the axle with the head of an arrow. @param {Twist} twist */
  drawTwist(twist) {
    const { arc } = twist;
    const [from, to] = arc.slice(-2);
    this.painter.loadLines(listPieces(arc), this.models.twist);
    this.painter.drawLines(this.models.twist, paint("ball"), 4, STILL);
    this.drawArrow("ball", scale(normalize(subtract(to, from)), TWIST_HEAD), to, "");
    const middle = scale(arc[0], 0.9);
    this.labels.put("twist", COLORS.ball, to, middle, phrase("scene.twist", twist));
  }

  /** @param {ReturnType<typeof listReached>[number]} lift @param {State} state */
  drawBracket(lift, state) {
    const { pieces, middle, inside } = listBracket(lift, state);
    this.painter.loadLines(pieces, this.models.bracket);
    this.painter.drawLines(this.models.bracket, paint("lift"), 3, STILL);
    const text = phrase("moved", lift, inDegrees() ? "degrees" : "radians");
    this.labels.put(`bracket-${lift.kind}`, COLORS.lift, middle, inside, text, ASIDE);
  }

  /** The top on its stand, with its shadow and its ball. @param {State} state */
  drawBody(state) {
    const { painter } = this;
    const axis = state.toWorld([0, 0, 1]);
    if (this.view % 3 === 0) {
      this.drawShadows(state, axis);
      painter.drawMesh(this.models.stand, STILL);
    }
    painter.drawMesh(this.models.body, createPose(state.orientation));
    if (this.top.layers.handle) this.drawHandle(axis);
  }

  /**
   * The rotor's, as from a lamp above it: an ellipse along the line of nodes; and the stand's.
   * @param {State} state @param {Vector} axis
   */
  drawShadows(state, axis) {
    const { painter, models, top } = this;
    const radius = findRadius(top.course.top);
    const { phi } = state.angles;
    const turned = /** @type {[number, number, number, number]} */ ([
      Math.cos(phi / 2),
      0,
      0,
      Math.sin(phi / 2),
    ]);
    const sizes = /** @type {Vector} */ ([radius + SOFT, radius * Math.abs(axis[2]) + SOFT, 1]);
    const height = CENTER * Math.sign(top.course.top.Mgl);
    const below = /** @type {Vector} */ ([height * axis[0], height * axis[1], GROUND]);
    painter.drawShadow(models.disc, createPose(turned, sizes, below));
    painter.drawShadow(models.disc, createPose([1, 0, 0, 0], [FOOT, FOOT, 1], [0, 0, GROUND]));
  }

  /** @param {State} state */
  drawVectors(state) {
    const { layers, course } = this.top;
    for (const [name, vector] of Object.entries(findVectors(course, state))) {
      if (layers[name]) this.drawArrow(name, scale(vector, this.scales[name]), [0, 0, 0], name);
    }
    if (layers[FICTITIOUS]) this.drawTorques(state);
    if (layers[CHANGE]) this.drawChange(state);
    if (layers[WAY]) {
      const axis = state.toWorld([0, 0, 1]);
      this.drawArrow("ball", scale(findWay(state), PUSH), axis, "way");
    }
  }

  /** Gravity at the middle of the rotor, seen through it, and at the head of L what it adds in a moment. @param {State} state */
  drawChange(state) {
    const { top, span } = this;
    const { course, run, time } = top;
    const side = Math.sign(course.top.Mgl);
    const center = state.toWorld([0, 0, CENTER * side]);
    const head = scale(findVectors(course, state).L, this.scales.L);
    const change = scale(findChange(run, time, span), this.scales.L);
    const text = phrase("label.change", { time: writeNumber(span / NANO, "1g") });
    this.drawArrow("L", change, head, "change", text);
    if (!side) return;
    this.painter.beginOver();
    this.drawArrow("gravity", [0, 0, -WEIGHT], center, "weight", phrase("label.gravity"));
  }

  /** @param {State} state @param {State[]} states */
  drawLines(state, states) {
    const { painter, top } = this;
    const { layers } = top;
    const { free } = top.telling;
    if (layers.sphere) painter.drawLines(this.models.sphere, paint("sphere"), 1, STILL, 0.55);
    if (free !== this.circled)
      painter.loadLines(free.motion.turning_angles.flatMap(listParallel), this.models.circles);
    this.circled = free;
    if (layers["turning circles"])
      painter.drawLines(this.models.circles, paint("circles"), 2, STILL);
    const { phi } = state.angles;
    const turned = createPose([Math.cos(phi / 2), 0, 0, Math.sin(phi / 2)]);
    if (layers["line of nodes"]) painter.drawLines(this.models.nodes, paint("nodes"), 2, turned);
    if (!layers.trace) return;
    const trace = listPieces(states.map((each) => each.toWorld([0, 0, 1])));
    painter.loadLines(trace, this.models.trace);
    painter.drawLines(this.models.trace, paint("trace"), 3, STILL);
  }

  /**
   * @param {string} name @param {Vector} vector @param {Vector} origin
   * @param {string} label its name, none if it is empty @param {string} text of the label
   */
  drawArrow(name, vector, origin, label, text = label && phrase(`label.${label}`)) {
    const length = findSize(vector);
    if (!(length > SHORTEST)) return;
    const direction = normalize(vector);
    const rotation = turnTo(direction);
    const tip = add(origin, vector);
    const { shaft, head } = this.models.arrows[name];
    const size = Math.min(1, length / 0.15);
    const wide = size * this.painter.bold;
    this.painter.drawMesh(
      shaft,
      createPose(rotation, [wide, wide, Math.max(length - 0.1 * size, 0)], origin),
    );
    this.painter.drawMesh(head, createPose(rotation, [wide, wide, size], tip));
    const color = COLORS[/** @type {keyof typeof COLORS} */ (name)];
    if (label) this.labels.put(label, color, tip, origin, text);
  }

  /**
   * Arrows along the line of nodes, head to tail: the third ends below the pivot if theta'' is 0.
   * @param {State} state
   */
  drawTorques(state) {
    const { phi } = state.angles;
    const torques = findTorques(this.top.course.top, state);
    const sizes = Object.values(torques).map((each) => each / this.torqueScale);
    if (!sizes.every((each) => Math.abs(each) <= LONGEST)) return;
    let end = 0;
    Object.entries(DEPTHS).forEach(([name, depth], k) => {
      const begin = name === "sum" ? 0 : end;
      end = begin + sizes[k];
      const along = (/** @type {number} */ x) =>
        /** @type {Vector} */ ([x * Math.cos(phi), x * Math.sin(phi), -depth]);
      this.drawArrow(name, subtract(along(end), along(begin)), along(begin), name);
    });
  }

  /** @param {Vector} axis */
  drawHandle(axis) {
    this.painter.drawMesh(this.models.ball, createPose([1, 0, 0, 0], [BALL, BALL, BALL], axis));
    this.labels.keepFree(axis, BALL);
    const { end, isTilting } = this.grip;
    if (end && !isTilting) this.drawArrow("ball", subtract(end, axis), axis, "");
  }
}
