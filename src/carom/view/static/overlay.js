/**
 * What people add to the picture: rings around spheres, trails, and a sphere that is not there
 * yet.
 *
 * @typedef {import("./renderer.js").Look} Look
 * @typedef {import("./renderer.js").Mark} Mark
 * @typedef {import("./renderer.js").Trail} Trail
 * @typedef {import("./renderer.js").Ghost} Ghost
 */
import { RAY } from "./glsl.js";
import { LIGHT } from "./light.js";
import { Programs } from "./program.js";

/** A quad around one sphere, wider than its outline by some pixels. */
const AROUND_VERTEX = `
${RAY}
uniform mat4 uView;
uniform vec3 uPlace;
uniform float uRadius, uMore;   // more: pixels
flat out vec3 vCenter;

void main() {
  vec3 c = (uView * vec4(uPlace, 1)).xyz;
  vCenter = c;
  float d2 = dot(c, c), r2 = uRadius * uRadius;
  gl_Position = vec4(2, 2, 2, 1);
  if (c.z >= -0.02 * uRadius || d2 <= 1.02 * r2) return;
  float d = sqrt(d2);
  float reach = uRadius * d / sqrt(d2 - r2) + uMore * pixelAt(d);
  vec3 across = normalize(cross(c, abs(c.y) < 0.9 * d ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 p = c + reach * (corner.x * across + corner.y * cross(across, c / d));
  gl_Position = uProjection * vec4(p, 1);
  gl_Position.z = depthAt(sqrt(d2 - r2)) * gl_Position.w;
}
`;

/** A ring just outside the outline and a glow that fades outwards. */
const MARK = `
${RAY}
flat in vec3 vCenter;
uniform float uRadius, uMore, uStrength, uWidth;
uniform vec3 uColor;
out vec4 color;

void main() {
  vec3 ray = normalize(rayThrough(gl_FragCoord.xy));
  float along = dot(vCenter, ray);
  float beyond = (length(ray * along - vCenter) - uRadius) / pixelAt(along);
  float ring = clamp(0.5 * uWidth + 0.5 - abs(beyond - 1.6 * uWidth), 0.0, 1.0);
  float fade = clamp(1.0 - beyond / uMore, 0.0, 1.0);
  float glow = beyond > 0.0 ? 0.42 * fade * fade : 0.10 * clamp(beyond + 1.0, 0.0, 1.0);
  float alpha = uStrength * max(ring, glow);
  if (alpha <= 0.0) discard;
  color = vec4(uColor * alpha, alpha);
}
`;

/** Translucent, with a clear outline. */
const GHOST = `
${RAY}
${LIGHT}
flat in vec3 vCenter;
uniform float uRadius, uWidth;
uniform vec3 uColor;
out vec4 color;

void main() {
  vec3 ray = normalize(rayThrough(gl_FragCoord.xy));
  float along = dot(vCenter, ray);
  vec3 off = ray * along - vCenter;
  float off1 = length(off);
  float inside = (uRadius - off1) / pixelAt(along);
  float coverage = clamp(inside + 0.5, 0.0, 1.0);
  if (coverage <= 0.0) discard;
  float half_ = sqrt(max(uRadius * uRadius - off1 * off1, 0.0));
  vec3 n = (off - ray * half_) / uRadius;
  float edge = 1.0 - half_ / uRadius;
  float outline = clamp(uWidth + 0.5 - inside, 0.0, 1.0);
  float alpha = coverage * max(0.34 + 0.4 * edge * edge, 0.9 * outline);
  color = vec4(lit(uColor, n, ray * (along - half_), -ray, uRadius) * alpha, alpha);
}
`;

/** Polylines of even width, mitred, fading towards the past. */
const TRAIL_VERTEX = `
${RAY}
layout(location = 0) in vec4 aBefore;    // place, and age from 1 (new) to 0; negative: a gap
layout(location = 1) in vec4 aFrom;
layout(location = 2) in vec4 aTo;
layout(location = 3) in vec4 aAfter;
uniform mat4 uView;
uniform float uWidth;
out float vAcross, vAge;
out vec3 vPlace;

vec2 onScreen(vec3 place) {
  vec4 p = uProjection * uView * vec4(place, 1);
  return p.xy / p.w * uPort.zw;
}

void main() {
  gl_Position = vec4(2, 2, 2, 1);
  if (aFrom.w < 0.0 || aTo.w < 0.0) return;
  bool end = gl_VertexID > 1;
  float sign = float(gl_VertexID & 1) * 2.0 - 1.0;
  vec4 p = uView * vec4(end ? aTo.xyz : aFrom.xyz, 1);
  if ((uView * vec4(aFrom.xyz, 1)).z > 0.0 || (uView * vec4(aTo.xyz, 1)).z > 0.0) return;
  vec2 a = onScreen(aFrom.xyz), b = onScreen(aTo.xyz);
  vec2 ahead = b - a;
  ahead /= max(length(ahead), 1e-6);
  vec4 beyond = end ? aAfter : aBefore;
  vec2 side = vec2(-ahead.y, ahead.x);
  if (beyond.w >= 0.0) {
    vec2 next = end ? onScreen(beyond.xyz) - b : a - onScreen(beyond.xyz);
    float size = length(next);
    if (size > 1e-3) {
      next /= size;
      vec2 middle = vec2(-next.y, next.x) + side;
      float turn = dot(middle, side);
      if (turn > 0.5) side = middle / turn;    // a sharp bend gets a plain end instead
    }
  }
  float reach = 0.5 * uWidth + 1.0;
  vAcross = sign * reach;
  vAge = end ? aTo.w : aFrom.w;
  vPlace = p.xyz;
  gl_Position = uProjection * p;
  gl_Position.xy += side * sign * reach * 2.0 / uPort.zw * gl_Position.w;
}
`;

const TRAIL = `
${RAY}
in float vAcross, vAge;
in vec3 vPlace;
uniform float uWidth;
uniform vec3 uColor;
out vec4 color;

void main() {
  float alpha = clamp(0.5 * uWidth + 0.5 - abs(vAcross), 0.0, 1.0);
  alpha *= vAge * (0.35 + 0.65 * vAge) * 0.95;
  if (alpha <= 0.0) discard;
  color = vec4(uColor * alpha, alpha);
  gl_FragDepth = 0.5 + 0.5 * depthAt(length(vPlace));
}
`;

const HALO = 11; // pixels of the page
const TRAIL_WIDTH = 2.2;

export class Overlay {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.programs = new Programs(gl, {
      mark: [AROUND_VERTEX, MARK],
      ghost: [AROUND_VERTEX, GHOST],
      trail: [TRAIL_VERTEX, TRAIL],
    });
    this.empty = gl.createVertexArray();
    this.lines = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    this.numbers = new Float32Array(4 * 256);
    gl.bindVertexArray(this.lines);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    for (let at = 0; at < 4; at++) {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, 4, gl.FLOAT, false, 16, 16 * at);
      gl.vertexAttribDivisor(at, 1);
    }
  }

  /** @param {Look} look @param {Mark[]} list */
  marks(look, list) {
    const { gl } = this;
    for (const { side, x, radius, color, strength } of list) {
      if (side !== look.side) continue;
      const program = this.programs.get("mark");
      const uMore = HALO * look.ratio;
      program.use();
      program.set(look.common);
      program.set({ uPlace: x, uRadius: radius, uColor: color, uMore, uWidth: 1.5 * look.ratio });
      gl.bindVertexArray(this.empty);
      // Faint where something stands before it, so that it is never lost.
      for (const [test, share] of /** @type {[boolean, number][]} */ ([[false, 0.3], [true, 1]])) {
        if (test) gl.enable(gl.DEPTH_TEST);
        else gl.disable(gl.DEPTH_TEST);
        program.set({ uStrength: strength * share });
        gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
      }
    }
  }

  /** @param {Look} look @param {Ghost | null} ghost */
  ghost(look, ghost) {
    if (ghost === null || ghost.side !== look.side) return;
    const { gl } = this;
    const program = this.programs.get("ghost", { SHADOWS: "uShadow" in look.shadow });
    const { x, radius, color } = ghost;
    program.use();
    program.set(look.common);
    program.set(look.shadow);
    program.set({ uPlace: x, uRadius: radius, uColor: color, uMore: 1.5, uWidth: 1.2 * look.ratio });
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  /** @param {Look} look @param {Trail[]} list */
  trails(look, list) {
    const { gl } = this;
    for (const { side, points, color } of list) {
      const count = points.length / 3;
      if (side !== look.side || count < 2) continue;
      this.#fill(points, count);
      gl.bindVertexArray(this.lines);
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
      gl.bufferData(gl.ARRAY_BUFFER, this.numbers.subarray(0, 4 * (count + 2)), gl.STREAM_DRAW);
      const program = this.programs.get("trail");
      program.use();
      program.set(look.common);
      program.set({ uColor: color, uWidth: TRAIL_WIDTH * look.ratio });
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count - 1);
    }
  }

  /**
   * Points with their ages, and a gap at both ends.
   * @param {Float32Array} points @param {number} count
   */
  #fill(points, count) {
    const size = 4 * (count + 2);
    if (this.numbers.length < size) this.numbers = new Float32Array(2 * size);
    const { numbers } = this;
    numbers.fill(-1, 0, 4);
    for (let k = 0; k < count; k++) {
      const [from, to] = [3 * k, 4 * (k + 1)];
      const gap = Number.isNaN(points[from]);
      for (let j = 0; j < 3; j++) numbers[to + j] = gap ? 0 : points[from + j];
      numbers[to + 3] = gap ? -1 : k / (count - 1);
    }
    numbers.fill(-1, size - 4, size);
  }
}
