/**
 * Draws spheres between two keyframes, and their walls, with WebGL 2.
 *
 * It knows nothing of the page: hand it a scene, two keyframes, a moment between them and a
 * camera. Keyframes go to the GPU as they came; the vertex shader computes the exact motion.
 *
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./camera.js").Camera} Camera
 * @typedef {import("./protocol.js").ColorMode} ColorMode
 * @typedef {object} Options
 * @property {ColorMode} color
 * @property {boolean} wire
 * @property {"dark" | "light"} theme
 */
import { SPECIES, SPEED_SCALE, THEMES } from "./colors.js";
import { dot, length, scale, sub } from "./matrix.js";
import { Program } from "./program.js";
import { SHADERS } from "./shaders.js";
import { buildWalls } from "./walls.js";

const MODES = { own: 0, energy: 1, speed: 2, species: 3, collisions: 0 };
const POINTS_FROM = 2000; // spheres; fewer are drawn as quads, which have no largest size
const LARGEST_POINT = 48; // pixels; a quad around a larger sphere wastes fewer

export class Renderer {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", {
      alpha: false,
      antialias: true,
      powerPreference: "high-performance",
    });
    if (gl === null) throw new Error("this browser has no WebGL 2");
    this.canvas = canvas;
    this.gl = gl;
    // All programs are handed to the compiler before any is waited for.
    this.programs = Object.fromEntries(
      Object.entries(SHADERS).map(([name, sources]) => [name, new Program(gl, sources)]),
    );
    this.largestPoint = Math.min(
      LARGEST_POINT,
      gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1] - 2,
    );
    this.spheres = gl.createVertexArray();
    this.walls = buildWalls(EMPTY);
    this.traits = gl.createBuffer();
    this.scratch = gl.createBuffer();
    this.plain = gl.createVertexArray();
    /** @type {Scene | null} */ this.scene = null;
    /** @type {Keyframe | null} */ this.first = null;
    /** @type {Keyframe | null} */ this.second = null;
    /** @type {Map<Keyframe, WebGLBuffer>} */ this.uploaded = new Map();
    this.largestRadius = 1;
  }

  /** @param {Scene} scene */
  setScene(scene) {
    const { gl } = this;
    this.scene = scene;
    this.first = this.second = null;
    this.walls = buildWalls(scene.about);
    this.largestRadius = scene.radius.reduce((most, r) => Math.max(most, r), 0);
    const bytes = new ArrayBuffer(12 * scene.n);
    const floats = new Float32Array(bytes);
    const colors = new Uint8Array(bytes);
    for (let i = 0; i < scene.n; i++) {
      floats[3 * i] = scene.radius[i];
      floats[3 * i + 1] = Number.isFinite(scene.mass[i]) ? scene.mass[i] : 0;
      const packed = scene.color[i];
      colors.set([packed >> 16, packed >> 8, packed, scene.species[i] % SPECIES.length], 12 * i + 8);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.traits);
    gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.STATIC_DRAW);
  }

  /**
   * The keyframes to draw between; both of the scene that was set.
   * @param {Keyframe} first @param {Keyframe} second
   */
  setKeyframes(first, second) {
    if (first === this.first && second === this.second) return;
    this.first = first;
    this.second = second;
    const spare = [];
    for (const [keyframe, buffer] of this.uploaded) {
      if (keyframe === first || keyframe === second) continue;
      this.uploaded.delete(keyframe);
      spare.push(buffer);
    }
    const { gl } = this;
    for (const keyframe of new Set([first, second])) {
      if (this.uploaded.has(keyframe)) continue;
      const buffer = spare.pop() ?? gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, keyframe.spheres, gl.STREAM_DRAW);
      this.uploaded.set(keyframe, buffer);
    }
    for (const buffer of spare) gl.deleteBuffer(buffer);
  }

  /**
   * Draw the moment `t`, between the times of the keyframes.
   * @param {number} t @param {Camera} camera @param {Options} options
   */
  draw(t, camera, options) {
    const { gl, scene } = this;
    const theme = THEMES[options.theme];
    const ratio = this.canvas.height / camera.size.height;
    const common = {
      uView: camera.view,
      uProjection: camera.projection,
      uSize: [this.canvas.width, this.canvas.height],
      uLine: 1.25 * ratio,
    };
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.depthMask(true);
    gl.clearColor(theme.back[0], theme.back[1], theme.back[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.DEPTH_TEST);
    if (scene === null || this.first === null || this.second === null) return;
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.enable(gl.BLEND);
    this.#faces(common, camera, theme);
    this.#shells(common, theme, 1);
    gl.enable(gl.DEPTH_TEST);
    if (!options.wire) this.#spheres(t, camera, options, theme, common);
    this.#lines(common, camera, theme);
    if (options.wire) this.#spheres(t, camera, options, theme, common);
    this.#shells(common, theme, -1);
  }

  /** @typedef {{uView: Float32Array, uProjection: Float32Array, uSize: number[], uLine: number}} Common */

  /**
   * @param {number} t @param {Camera} camera @param {Options} options
   * @param {typeof THEMES.dark} theme @param {Common} common
   */
  #spheres(t, camera, options, theme, common) {
    const { gl } = this;
    const scene = /** @type {Scene} */ (this.scene);
    const [first, second] = /** @type {Keyframe[]} */ ([this.first, this.second]);
    const points = !options.wire && this.#small(camera, common.uSize[1]);
    const program =
      this.programs[options.wire ? "wireQuads" : points ? "solidPoints" : "solidQuads"];
    const { period, full_energy, full_speed } = scene.about;
    const { up } = camera;
    const view = common.uView;
    program.use();
    program.set({
      ...common,
      uS: Math.min(Math.max(t - first.t, 0), second.t - first.t),
      uH: second.t - first.t,
      uG: second.gravity,
      uPeriod: period,
      uPerPeriod: period.map((length_) => (length_ > 0 ? 1 / length_ : 0)),
      uMode: { int: MODES[options.color] },
      uFull: options.color === "speed" ? full_speed : full_energy,
      uScale: { list: SPEED_SCALE.flat() },
      uSpecies: { list: SPECIES.flat() },
      uUp: [0, 1, 2].map((k) => view[k] * up[0] + view[k + 4] * up[1] + view[k + 8] * up[2]),
      uSky: theme.sky,
      uGround: theme.ground,
      uTint: theme.tint,
      uFog: theme.back,
      uFogRange: [camera.distance, 1 / (2.5 * camera.reach)],
    });
    this.#bind(program, points ? 0 : 1);
    if (options.wire) {
      gl.enable(gl.BLEND);
      gl.depthMask(false);
    } else {
      // Smooth edges by coverage need no sorting, and work among spheres in one another.
      gl.disable(gl.BLEND);
      gl.depthMask(true);
      gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    }
    if (points) gl.drawArrays(gl.POINTS, 0, scene.n);
    else gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, scene.n);
    gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
  }

  /** Are there many spheres and all small in the picture? @param {Camera} camera @param {number} height */
  #small(camera, height) {
    const scene = /** @type {Scene} */ (this.scene);
    const nearest = camera.distance - camera.reach;
    if (scene.n < POINTS_FROM || nearest <= 2 * this.largestRadius) return false;
    return (this.largestRadius / nearest / camera.tangents.y) * height < this.largestPoint;
  }

  /** @param {Program} program @param {number} divisor */
  #bind(program, divisor) {
    const { gl } = this;
    const { n } = /** @type {Scene} */ (this.scene);
    gl.bindVertexArray(this.spheres);
    const attribute = (
      /** @type {string} */ name,
      /** @type {number} */ size,
      /** @type {number} */ type,
      /** @type {number} */ stride,
      /** @type {number} */ offset,
    ) => {
      const at = program.attribute(name);
      if (at < 0) return;
      gl.enableVertexAttribArray(at);
      if (name.startsWith("aC") && size === 1) gl.vertexAttribIPointer(at, 1, type, stride, offset);
      else gl.vertexAttribPointer(at, size, type, true, stride, offset);
      gl.vertexAttribDivisor(at, divisor);
    };
    for (const [suffix, keyframe] of /** @type {[string, Keyframe][]} */ ([
      ["0", this.first],
      ["1", this.second],
    ])) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.uploaded.get(keyframe) ?? null);
      attribute(`aX${suffix}`, 3, gl.FLOAT, 12, 0);
      attribute(`aV${suffix}`, 3, gl.FLOAT, 12, 12 * n);
      attribute(`aC${suffix}`, 1, gl.UNSIGNED_INT, 4, 24 * n);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.traits);
    attribute("aRadius", 1, gl.FLOAT, 12, 0);
    attribute("aMass", 1, gl.FLOAT, 12, 4);
    attribute("aColor", 4, gl.UNSIGNED_BYTE, 12, 8);
  }

  /** @param {Common} common @param {typeof THEMES.dark} theme @param {1 | -1} side */
  #shells(common, theme, side) {
    const { gl } = this;
    const program = this.programs.shell;
    for (const radius of this.walls.shells) {
      gl.bindVertexArray(this.plain);
      program.use();
      program.set({ ...common, uRadius: radius, uSide: side, uColor: [...theme.shell, 1] });
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 3);
    }
  }

  /** Flat walls that the eye looks at from inside. @param {Common} common @param {Camera} camera @param {typeof THEMES.dark} theme */
  #faces(common, camera, theme) {
    const { gl } = this;
    const program = this.programs.faces;
    for (const face of this.walls.faces) {
      const facing = dot(face.normal, sub(camera.eye, face.center));
      const endless = face.fade > 0;
      if (facing <= 0 && !endless) continue;
      const floor = dot(face.normal, camera.up) > 0.9;
      program.use();
      program.set({
        ...common,
        uColor: theme.line,
        uFill: endless ? 0.1 : floor ? 0.06 : 0.025,
        uGridLine: endless ? 0.24 : floor ? 0.1 : 0.05,
        uFade: face.fade,
      });
      this.#stream(program, face.corners.flatMap((corner, k) => [...corner, ...face.grid[k]]), 0, [
        ["aPlace", 3],
        ["aGrid", 2],
      ]);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
  }

  /** @param {Common} common @param {Camera} camera @param {typeof THEMES.dark} theme */
  #lines(common, camera, theme) {
    const { gl } = this;
    const { edges } = this.walls;
    if (edges.length === 0) return;
    const { eye } = camera;
    const values = edges.flatMap(({ from, to, outward, dash }) => {
      const line = sub(eye, scale([from[0] + to[0], from[1] + to[1], from[2] + to[2]], 0.5));
      const sight = scale(line, 1 / length(line));
      const front = Math.min(...outward.map((normal) => dot(normal, sight))) > 0;
      return [...from, ...to, front ? 0.3 : 0.6, dash];
    });
    const program = this.programs.lines;
    program.use();
    program.set({ ...common, uColor: theme.line });
    this.#stream(program, values, 1, [
      ["aFrom", 3],
      ["aTo", 3],
      ["aStyle", 2],
    ]);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, edges.length);
  }

  /**
   * Upload a few numbers for one draw call.
   * @param {Program} program @param {number[]} values @param {number} divisor
   * @param {[string, number][]} layout names and sizes of the attributes
   */
  #stream(program, values, divisor, layout) {
    const { gl } = this;
    const stride = 4 * layout.reduce((sum, [, size]) => sum + size, 0);
    gl.bindVertexArray(this.plain);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.scratch);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STREAM_DRAW);
    let offset = 0;
    for (const [name, size] of layout) {
      const at = program.attribute(name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, stride, offset);
      gl.vertexAttribDivisor(at, divisor);
      offset += 4 * size;
    }
  }
}

/** No walls yet. @type {import("./protocol.js").About} */
const EMPTY = {
  key: -1,
  origin: null,
  method: "exact",
  free_axes: 3,
  title: "",
  pace: 1,
  wire: false,
  color: "own",
  collide: true,
  camera: null,
  period: [0, 0, 0],
  gravity: [0, 0, 0],
  walls: [],
  low: [-1, -1, -1],
  high: [1, 1, 1],
  full_energy: 1,
  full_speed: 1,
  full_gravity: 1,
};
