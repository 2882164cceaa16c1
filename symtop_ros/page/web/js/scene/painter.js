// WebGL 2 for the scene: lit meshes, and lines as ribbons of equal width on the screen.

import { phrase } from "../words/wording.js";

/** @import { Color } from "./colors.js" */
/** @import { Mesh } from "./meshes.js" */
/**
 * Corners of triangles on the graphics card, and how many numbers one has.
 * @typedef {{array: WebGLVertexArrayObject, buffer: WebGLBuffer, width: number, count: number}} Model
 */

const MESH_VERTEX = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 color;
uniform mat4 view, pose;
out vec3 at, facing, paint;
void main() {
  vec4 place = pose * vec4(position, 1.0);
  at = place.xyz;
  facing = mat3(pose) * normal;
  paint = color;
  gl_Position = view * place;
}`;
// A lamp behind the eye's right shoulder, light from the sky, and a gloss.
const MESH_FRAGMENT = `#version 300 es
precision highp float;
in vec3 at, facing, paint;
uniform vec3 eye;
uniform float opacity, flatness;
out vec4 result;
void main() {
  vec3 to_eye = normalize(eye - at), n = normalize(facing);
  if (dot(n, to_eye) < 0.0) n = -n;
  vec3 lamp = normalize(vec3(0.55, -0.35, 1.1));
  float lit = 0.42 + 0.16 * n.z + 0.48 * max(dot(n, lamp), 0.0);
  float gloss = 0.22 * pow(max(dot(n, normalize(lamp + to_eye)), 0.0), 40.0);
  vec3 shaded = paint * lit + gloss;
  result = vec4(mix(shaded, paint, flatness) * opacity, opacity);
}`;
// The two ends of a piece, and which corner of its ribbon this is.
const LINE_VERTEX = `#version 300 es
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec2 corner;
uniform mat4 view, pose;
uniform vec2 screen;
uniform highp float width;
out float side;
void main() {
  vec4 a = view * pose * vec4(from, 1.0), b = view * pose * vec4(to, 1.0);
  vec2 along = (b.xy / b.w - a.xy / a.w) * screen;
  vec2 across = length(along) > 1e-6 ? normalize(vec2(-along.y, along.x)) : vec2(0.0, 1.0);
  vec4 end = corner.x > 0.5 ? b : a;
  side = corner.y * (width + 0.5);
  end.xy += across * side / screen * end.w;
  gl_Position = end;
}`;
// An edge fades over one px, with or without the smoothing of a graphics card.
const LINE_FRAGMENT = `#version 300 es
precision highp float;
in float side;
uniform vec4 color;
uniform highp float width;
out vec4 result;
void main() {
  float opacity = color.a * clamp(width + 0.5 - abs(side), 0.0, 1.0);
  result = vec4(color.rgb * opacity, opacity);
}`;
// A soft shadow: darkest in the middle of its disc, whose own x and y stand in place of a colour.
const SHADOW_FRAGMENT = `#version 300 es
precision highp float;
in vec3 at, facing, paint;
out vec4 result;
void main() {
  float dark = 1.0 - smoothstep(0.0, 1.0, length(paint.xy));
  result = vec4(0.0, 0.0, 0.0, 0.24 * dark);
}`;
const CORNERS = [0, 0, 1, 1, 0, 1].map((end, k) => [end, [-1, 1, -1, -1, 1, 1][k]]);
const SMOOTH = { antialias: true, failIfMajorPerformanceCaveat: true };
const PIECE = 6; // numbers of its two ends
const BOLD = 1.8; // thickness of lines and arrows for a projector

/** The browser draws no scene: its message says why. */
export class NoPicture extends Error {}

export class Painter {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    const options = { alpha: true, preserveDrawingBuffer: true };
    // A graphics card smooths edges for nothing; software would need four times as long for it.
    const gl =
      canvas.getContext("webgl2", { ...options, ...SMOOTH }) ??
      canvas.getContext("webgl2", { ...options, antialias: false });
    if (!gl) throw new NoPicture(phrase("page.no_webgl"));
    this.gl = gl;
    this.canvas = canvas;
    /** @type {Map<WebGLProgram, {[name: string]: WebGLUniformLocation | null}>} */
    this.places = new Map();
    this.programs = this.prepare();
    this.bold = 1;
  }

  /** Give the graphics card its programs: at first, and after it has lost everything. */
  prepare() {
    const { gl } = this;
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    return {
      meshes: this.link(MESH_VERTEX, MESH_FRAGMENT),
      lines: this.link(LINE_VERTEX, LINE_FRAGMENT),
      shadows: this.link(MESH_VERTEX, SHADOW_FRAGMENT),
    };
  }

  /** @param {string} vertex @param {string} fragment */
  link(vertex, fragment) {
    const { gl } = this;
    const program = /** @type {WebGLProgram} */ (gl.createProgram());
    for (const [kind, text] of /** @type {[number, string][]} */ ([
      [gl.VERTEX_SHADER, vertex],
      [gl.FRAGMENT_SHADER, fragment],
    ])) {
      const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      throw new NoPicture(`${phrase("page.no_webgl")} (${gl.getProgramInfoLog(program)})`);
    }
    return program;
  }

  /** A model that has no corners yet. @param {number[]} sizes of the numbers of a corner @returns {Model} */
  create(sizes) {
    const { gl } = this;
    const array = /** @type {WebGLVertexArrayObject} */ (gl.createVertexArray());
    const buffer = /** @type {WebGLBuffer} */ (gl.createBuffer());
    const width = sizes.reduce((sum, each) => sum + each);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    sizes.reduce((begin, size, place) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 4 * width, 4 * begin);
      return begin + size;
    }, 0);
    gl.bindVertexArray(null);
    return { array, buffer, width, count: 0 };
  }

  /** Give a model other corners. @param {Model} model @param {Float32Array} numbers */
  fill(model, numbers) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, model.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.DYNAMIC_DRAW);
    model.count = numbers.length / model.width;
  }

  /** @param {Mesh} mesh @param {Model} model that it becomes */
  loadMesh(mesh, model = this.create([3, 3, 3])) {
    this.fill(model, mesh);
    return model;
  }

  /**
   * Pieces of lines become ribbons, two triangles each. Every corner has the numbers of its piece:
   * software takes long for many instances.
   * @param {number[]} pieces each from one point to the next: six numbers a piece
   * @param {Model} model that they become
   */
  loadLines(pieces, model = this.create([3, 3, 2])) {
    const numbers = new Float32Array((pieces.length / PIECE) * CORNERS.length * model.width);
    for (let begin = 0, end = 0; begin < pieces.length; begin += PIECE) {
      for (const corner of CORNERS) {
        for (let k = 0; k < PIECE; k += 1) numbers[end + k] = pieces[begin + k];
        numbers.set(corner, end + PIECE);
        end += model.width;
      }
    }
    this.fill(model, numbers);
    return model;
  }

  /**
   * Begin a picture.
   * @param {number[]} view matrix of the camera
   * @param {number[]} eye
   * @param {{width: number, height: number}} size of the canvas in px
   */
  begin(view, eye, size) {
    const { gl, canvas } = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [size.width, size.height].map((n) =>
      Math.max(1, Math.round(n * ratio)),
    );
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.bold = document.documentElement.dataset.size ? BOLD : 1;
    this.ratio = ratio * this.bold;
    this.view = view;
    this.eye = eye;
  }

  /**
   * The place of a uniform; to ask the graphics card takes long.
   * @param {WebGLProgram} program @param {string} name
   */
  locate(program, name) {
    const known = this.places.get(program) ?? {};
    this.places.set(program, known);
    known[name] ??= this.gl.getUniformLocation(program, name);
    return known[name];
  }

  /** @param {WebGLProgram} program @param {number[]} pose */
  use(program, pose) {
    const { gl } = this;
    gl.useProgram(program);
    gl.uniformMatrix4fv(this.locate(program, "view"), false, /** @type {number[]} */ (this.view));
    gl.uniformMatrix4fv(this.locate(program, "pose"), false, pose);
    return (/** @type {string} */ name) => this.locate(program, name);
  }

  /** What lets others through keeps no depth. @param {Model} model @param {boolean} isOpaque */
  drawTriangles({ array, count }, isOpaque) {
    const { gl } = this;
    gl.depthMask(isOpaque);
    gl.bindVertexArray(array);
    gl.drawArrays(gl.TRIANGLES, 0, count);
    gl.depthMask(true);
  }

  /**
   * @param {Model} model
   * @param {number[]} pose
   * @param {number} opacity
   * @param {number} flatness 1 for the plain colour
   */
  drawMesh(model, pose, opacity = 1, flatness = 0) {
    const { gl } = this;
    const find = this.use(this.programs.meshes, pose);
    gl.uniform3fv(find("eye"), /** @type {number[]} */ (this.eye));
    gl.uniform1f(find("opacity"), opacity);
    gl.uniform1f(find("flatness"), flatness);
    this.drawTriangles(model, opacity === 1);
  }

  /** What is drawn from now on covers what was drawn before, also what is nearer. */
  beginOver() {
    this.gl.clear(this.gl.DEPTH_BUFFER_BIT);
  }

  /** @param {Model} disc @param {number[]} pose */
  drawShadow(disc, pose) {
    this.use(this.programs.shadows, pose);
    this.drawTriangles(disc, false);
  }

  /**
   * @param {Model} ribbons
   * @param {Color} color
   * @param {number} width in px
   * @param {number[]} pose
   * @param {number} opacity
   */
  drawLines(ribbons, color, width, pose, opacity = 1) {
    const { gl, canvas } = this;
    const find = this.use(this.programs.lines, pose);
    gl.uniform2f(find("screen"), canvas.width / 2, canvas.height / 2);
    gl.uniform1f(find("width"), (width * (this.ratio ?? 1)) / 2);
    gl.uniform4f(find("color"), ...color, opacity);
    this.drawTriangles(ribbons, opacity === 1);
  }
}
