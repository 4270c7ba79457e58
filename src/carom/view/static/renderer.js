/**
 * Draws a picture: spheres between two keyframes, their walls, and what people added, with
 * WebGL 2. It knows nothing of the page. Keyframes go to the GPU as they came; the vertex
 * shaders compute the exact motion.
 *
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./camera.js").Camera} Camera
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {import("./protocol.js").ColorMode} ColorMode
 * @typedef {import("./program.js").Uniforms} Uniforms
 *
 * @typedef {object} Options
 * @property {ColorMode} color
 * @property {number} full energy, speed or count at the end of the colour scale
 * @property {boolean} wire
 * @property {"dark" | "light"} theme
 * @property {number} arrows on all spheres, as long as the way in this simulated time; 0 for none
 *
 * @typedef {{x: number, y: number, width: number, height: number}} Viewport pixels of the page,
 *   y down from the top of the canvas
 * @typedef {{first: Keyframe, second: Keyframe, t: number, viewport: Viewport}} Side
 * @typedef {{side: number, x: Vec3, radius: number, color: Vec3, strength: number}} Mark
 * @typedef {{side: number, from: Vec3, to: Vec3, color: Vec3, strength: number}} ArrowMark
 * @typedef {{side: number, points: Float32Array, color: Vec3}} Trail oldest first, NaN: a gap
 * @typedef {{side: number, x: Vec3, radius: number, color: Vec3}} Ghost
 *
 * @typedef {object} Picture
 * @property {Side[]} sides one, or two of the same size for the split screen
 * @property {Camera} camera
 * @property {Options} options
 * @property {Mark[]} marks
 * @property {ArrowMark[]} arrows
 * @property {Trail[]} trails
 * @property {Ghost | null} ghost
 *
 * @typedef {object} Look one side of a picture, as the drawing modules need it
 * @property {number} side
 * @property {Camera} camera
 * @property {Vec3} eye
 * @property {Vec3} lamp unit vector towards it, in the world
 * @property {Float32Array} eyeToWorld
 * @property {Options} options
 * @property {import("./protocol.js").About} about
 * @property {typeof import("./colors.js").THEMES.dark} theme
 * @property {import("./quality.js").Level} level
 * @property {number} ratio pixels of the picture per pixel of the page
 * @property {import("./buffers.js").Pair} pair
 * @property {Common} common uniforms of every program
 * @property {Uniforms} motion uniforms of the moment
 * @property {Uniforms} shadow uniforms of the shadow map and of the crowd
 * @property {number} crowded how many spheres a ray meets on its way
 *
 * @typedef {Uniforms & {uView: Float32Array, uPort: number[], uLine: number}} Common
 */
import { Arrows } from "./arrows.js";
import { Pair, Traits } from "./buffers.js";
import { THEMES } from "./colors.js";
import { CrowdLight } from "./crowdlight.js";
import { Frame } from "./frame.js";
import { lampFrom } from "./light.js";
import { direction } from "./matrix.js";
import { Overlay } from "./overlay.js";
import { Governor, LEVELS, finest, isSoftware } from "./quality.js";
import { Room } from "./room.js";
import { Shadows } from "./shadows.js";
import { Spheres } from "./spheres.js";
import { buildWalls } from "./walls.js";

/** @type {Uniforms} */
const NO_SHADOWS = {};
const DENSE = 5; // spheres on a ray's way, from which single shadows are lost among the others

export class Renderer {
  /** @param {HTMLCanvasElement} canvas its pixels are the renderer's to choose, its size the page's */
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", {
      alpha: false,
      antialias: false,
      powerPreference: "high-performance",
    });
    if (gl === null) throw new Error("this browser draws no WebGL 2; update it, or turn on its hardware acceleration");
    this.canvas = canvas;
    this.gl = gl;
    const names = gl.getExtension("WEBGL_debug_renderer_info");
    const name = names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : "";
    const software = isSoftware(String(name));
    this.governor = new Governor(software);
    this.traits = new Traits(gl);
    this.pairs = [new Pair(gl, this.traits), new Pair(gl, this.traits)];
    this.crowds = [new CrowdLight(gl), new CrowdLight(gl)];
    this.frame = new Frame(gl);
    this.shadows = new Shadows(gl);
    this.room = new Room(gl, this.shadows);
    this.spheres = new Spheres(gl, software);
    this.arrows = new Arrows(gl);
    this.overlay = new Overlay(gl);
    this.walls = buildWalls(EMPTY);
    /** @type {Scene | null} */ this.scene = null;
    /** @type {Picture | null} */ this.picture = null; // the last one drawn
  }

  /** The level of quality now, an index into LEVELS. */
  get quality() {
    return this.governor.level;
  }

  /** @param {Scene} scene */
  setScene(scene) {
    if (scene.n !== this.scene?.n) this.governor.start(scene.n);
    this.scene = scene;
    this.picture = null;
    this.walls = buildWalls(scene.about);
    this.room.set(this.walls);
    this.traits.set(scene);
    const { points, margin } = this.walls.bounds;
    const ends = (/** @type {(...values: number[]) => number} */ end, /** @type {number} */ more) =>
      [0, 1, 2].map((k) => end(...points.map((point) => point[k])) + more);
    for (const crowd of this.crowds) {
      crowd.start(scene, ends(Math.min, -margin), ends(Math.max, margin), this.traits.typical);
    }
  }

  /** Draw a picture of the scene that was set. @param {Picture} picture */
  draw(picture) {
    const started = performance.now();
    this.#draw(picture, this.governor.level, devicePixelRatio);
    requestAnimationFrame(() => this.governor.took(performance.now() - started));
  }

  /** The picture as it is, in the best quality, as a PNG file. @returns {Promise<Blob>} */
  toBlob() {
    const { picture } = this;
    if (picture === null) return Promise.reject(new Error("there is no picture yet; draw one first"));
    this.#draw(picture, LEVELS.length - 1, Math.max(2, devicePixelRatio), true);
    return new Promise((done, failed) => {
      this.canvas.toBlob(
        (blob) => (blob === null ? failed(new Error("the browser made no PNG file")) : done(blob)),
        "image/png",
      );
      this.#draw(picture, this.governor.level, devicePixelRatio);
    });
  }

  /**
   * @param {Picture} picture @param {number} quality index into LEVELS
   * @param {number} screen its pixels per pixel of the page
   * @param {boolean} [file] is it to be saved?
   */
  #draw(picture, quality, screen, file = false) {
    const { gl, canvas, frame } = this;
    this.picture = picture;
    const level = LEVELS[quality];
    const ratio = Math.min(screen, finest(quality, this.traits.n));
    // The canvas may be larger than its viewports; a file holds nothing but them.
    const { clientWidth, clientHeight } = file ? { clientWidth: 0, clientHeight: 0 } : canvas;
    let [width, height] = [clientWidth, clientHeight].map((n) => Math.max(1, Math.round(n * ratio)));
    for (const { viewport: v } of picture.sides) {
      width = Math.max(width, Math.round((v.x + v.width) * ratio));
      height = Math.max(height, Math.round((v.y + v.height) * ratio));
    }
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    const theme = THEMES[picture.options.theme];
    frame.begin(level.samples);
    gl.disable(gl.SCISSOR_TEST);
    gl.depthMask(true);
    gl.clearColor(theme.back[0], theme.back[1], theme.back[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    picture.sides.forEach((_, k) => this.#side(picture, k, level, ratio));
    frame.end();
  }

  /**
   * @param {Picture} picture @param {number} side
   * @param {import("./quality.js").Level} level @param {number} ratio
   */
  #side(picture, side, level, ratio) {
    const { gl, room, arrows, overlay } = this;
    const look = this.#look(picture, side, level, ratio);
    const { options } = picture;
    if (level.shadow > 0 && !options.wire) this.#shade(look, picture.sides[side].second);
    const [x, y, width, height] = look.common.uPort;
    gl.viewport(x, y, width, height);
    gl.scissor(x, y, width, height);
    gl.enable(gl.SCISSOR_TEST);
    gl.depthMask(false);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    room.behind(look);
    gl.enable(gl.DEPTH_TEST);
    if (!options.wire) this.spheres.draw(look);
    gl.depthMask(true);
    if (options.arrows > 0) arrows.velocities(look);
    arrows.draw(look, picture.arrows);
    gl.depthMask(false);
    room.lines(look);
    if (options.wire) this.spheres.draw(look);
    overlay.trails(look, picture.trails);
    overlay.ghost(look, picture.ghost);
    room.before(look);
    overlay.marks(look, picture.marks);
  }

  /** What takes light away, besides a thing's own shape. @param {Look} look @param {Keyframe} keyframe */
  #shade(look, keyframe) {
    const crowd = this.crowds[look.side];
    const scene = /** @type {Scene} */ (this.scene);
    look.shadow = crowd.uniforms(keyframe, scene, look.camera.up, look.eyeToWorld);
    if (look.crowded > DENSE) return;
    Object.assign(look.shadow, this.shadows.cast(look, this.walls));
    this.frame.bind();
  }

  /**
   * @param {Picture} picture @param {number} side
   * @param {import("./quality.js").Level} level @param {number} ratio
   * @returns {Look}
   */
  #look({ sides, camera, options }, side, level, ratio) {
    const { first, second, t, viewport } = sides[side];
    const scene = /** @type {Scene} */ (this.scene);
    const { about } = scene;
    const pair = this.pairs[side];
    pair.set(first, second, scene);
    const { axes, eye } = camera;
    const { right, up, back } = axes;
    const room = this.walls.faces.length > 0;
    const lamp = room ? lampFrom(camera.up, ...fixedAxes(camera)) : lampFrom(camera.up, right, back);
    return {
      side,
      camera,
      eye,
      lamp,
      // prettier-ignore
      eyeToWorld: new Float32Array([...right, 0, ...up, 0, ...back, 0, ...eye, 1]),
      options,
      about,
      theme: THEMES[options.theme],
      level,
      ratio,
      pair,
      common: this.#common(camera, viewport, ratio, lamp, THEMES[options.theme]),
      motion: {
        uS: Math.min(Math.max(t - first.t, 0), second.t - first.t),
        uH: second.t - first.t,
        uG: second.gravity,
        uPeriod: about.period,
        uPerPeriod: about.period.map((length) => (length > 0 ? 1 / length : 0)),
      },
      shadow: NO_SHADOWS,
      crowded: this.crowds[side].cover,
    };
  }

  /**
   * @param {Camera} camera @param {Viewport} viewport @param {number} ratio @param {Vec3} lamp
   * @param {Look["theme"]} theme
   * @returns {Common}
   */
  #common(camera, viewport, ratio, lamp, theme) {
    const { view } = camera;
    const port = [viewport.x, 0, viewport.width, viewport.height].map((v) => Math.round(v * ratio));
    port[1] = this.canvas.height - Math.round((viewport.y + viewport.height) * ratio);
    return {
      uView: view,
      uProjection: camera.projection,
      uPort: port,
      uLine: 1.25 * ratio,
      uLamp: direction(view, lamp),
      uUp: direction(view, camera.up),
      uKey: theme.key,
      uSky: theme.sky,
      uGround: theme.ground,
      uTint: theme.tint,
      uFog: theme.back,
      uFogRange: [camera.distance - 0.4 * camera.reach, 1 / (2.6 * camera.reach), theme.fog],
    };
  }
}

/** Right and back of an eye that looks at the room as the page first does. @param {Camera} camera @returns {[Vec3, Vec3]} */
function fixedAxes(camera) {
  const [forward, side] = camera.compass;
  const [cos, sin] = [Math.cos(-0.42), Math.sin(-0.42)];
  const turned = (/** @type {number} */ a, /** @type {number} */ b) =>
    /** @type {Vec3} */ ([0, 1, 2].map((k) => a * side[k] + b * forward[k]));
  return [turned(cos, sin), turned(sin, -cos)];
}

/** No walls yet. */
const EMPTY = { period: [0, 0, 0], walls: [], low: [-1, -1, -1], high: [1, 1, 1] };
