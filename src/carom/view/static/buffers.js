/**
 * The spheres of one side of the picture on the GPU: two keyframes as they came, and what does
 * not move. The attributes have the same places in every program (`glsl.js`).
 *
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {"quads" | "points" | "arrows"} Kind how a sphere is drawn: which vertices it has
 */
import { SPECIES } from "./colors.js";
import { Images } from "./images.js";

const [X0, V0, X1, V1, C0, C1, RADIUS, MASS, COLOR] = [0, 1, 2, 3, 4, 5, 6, 7, 8];

/** Radius, mass and colour of each sphere, in a buffer of 12 bytes per sphere. */
export class Traits {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.buffer = gl.createBuffer();
    this.n = 0;
    this.version = 0; // counts changes
    this.words = new Uint32Array(0); // what the buffer holds
    this.largest = 1; // radius
    this.typical = 1; // the median radius
  }

  /** @param {Scene} scene */
  set(scene) {
    const { gl } = this;
    const bytes = new ArrayBuffer(12 * scene.n);
    const floats = new Float32Array(bytes);
    const colors = new Uint8Array(bytes);
    for (let i = 0; i < scene.n; i++) {
      floats[3 * i] = scene.radius[i];
      floats[3 * i + 1] = Number.isFinite(scene.mass[i]) ? scene.mass[i] : 0;
      const packed = scene.color[i];
      colors[12 * i + 8] = packed >> 16;
      colors[12 * i + 9] = packed >> 8;
      colors[12 * i + 10] = packed;
      colors[12 * i + 11] = scene.species[i] % SPECIES.length;
    }
    gl.bindVertexArray(null);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.STATIC_DRAW);
    this.words = new Uint32Array(bytes);
    const sorted = scene.radius.slice().sort();
    this.n = scene.n;
    this.largest = sorted.at(-1) ?? 1;
    this.typical = sorted[scene.n >> 1] ?? 1;
    this.version++;
  }
}

/** Two keyframes of one side, ready to be drawn between. */
export class Pair {
  /** @param {WebGL2RenderingContext} gl @param {Traits} traits */
  constructor(gl, traits) {
    this.gl = gl;
    this.traits = traits;
    /** @type {Keyframe | null} */ this.first = null;
    /** @type {Keyframe | null} */ this.second = null;
    this.version = 0; // counts pairs
    this.images = new Images(gl);
    /** @type {Map<Keyframe, WebGLBuffer>} */ this.uploaded = new Map();
    /** @type {Map<Kind, {array: WebGLVertexArrayObject, version: string}>} */
    this.arrays = new Map();
  }

  /** @param {Keyframe} first @param {Keyframe} second @param {Scene} scene */
  set(first, second, scene) {
    if (first === this.first && second === this.second) return;
    this.first = first;
    this.second = second;
    this.version++;
    const { gl } = this;
    const spare = [];
    for (const [keyframe, buffer] of this.uploaded) {
      if (keyframe === first || keyframe === second) continue;
      this.uploaded.delete(keyframe);
      spare.push(buffer);
    }
    gl.bindVertexArray(null);
    for (const keyframe of first === second ? [first] : [first, second]) {
      if (this.uploaded.has(keyframe)) continue;
      const buffer = spare.pop() ?? gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, keyframe.spheres, gl.STREAM_DRAW);
      this.uploaded.set(keyframe, buffer);
    }
    for (const buffer of spare) gl.deleteBuffer(buffer);
    this.images.set(first, second, scene, this.traits.words);
  }

  /**
   * Make the attributes current. Points take a sphere per vertex, the others one per instance.
   * @param {Kind} kind @param {(() => void) | null} more sets up further attributes, once
   */
  bind(kind, more = null) {
    const { gl, traits } = this;
    let entry = this.arrays.get(kind);
    if (entry === undefined) {
      entry = { array: gl.createVertexArray(), version: "" };
      this.arrays.set(kind, entry);
      gl.bindVertexArray(entry.array);
      more?.();
    }
    gl.bindVertexArray(entry.array);
    const version = `${this.version} ${traits.version}`;
    if (entry.version === version) return;
    entry.version = version;
    const [first, second] = /** @type {Keyframe[]} */ ([this.first, this.second]);
    const divisor = kind === "points" ? 0 : 1;
    this.#keyframe(first, X0, V0, C0);
    this.#keyframe(second, X1, V1, C1);
    gl.bindBuffer(gl.ARRAY_BUFFER, traits.buffer);
    gl.vertexAttribPointer(RADIUS, 1, gl.FLOAT, false, 12, 0);
    gl.vertexAttribPointer(MASS, 1, gl.FLOAT, false, 12, 4);
    gl.vertexAttribPointer(COLOR, 4, gl.UNSIGNED_BYTE, true, 12, 8);
    for (let at = X0; at <= COLOR; at++) {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribDivisor(at, divisor);
    }
  }

  /** @param {Keyframe} keyframe @param {number} x @param {number} v @param {number} count */
  #keyframe(keyframe, x, v, count) {
    const { gl } = this;
    const { n } = keyframe;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.uploaded.get(keyframe) ?? null);
    gl.vertexAttribPointer(x, 3, gl.FLOAT, false, 12, 0);
    gl.vertexAttribPointer(v, 3, gl.FLOAT, false, 12, 12 * n);
    gl.vertexAttribIPointer(count, 1, gl.UNSIGNED_INT, 4, 24 * n);
  }
}
