/**
 * The ball that is going to be added: put down where a pointer presses, thrown as far as it drags.
 *
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {{position: Vec3, velocity: Vec3, radius: number, mass: number, color: number}} Ball
 */
import { SPECIES } from "./colors.js";
import { length, scale, sub } from "./matrix.js";
import { buildWalls } from "./walls.js";

/** As 0xRRGGBB. @param {number[]} rgb parts from 0 to 1 */
export const pack = ([r, g, b]) =>
  (Math.round(255 * r) << 16) | (Math.round(255 * g) << 8) | Math.round(255 * b);

/** The value in the middle; NaN of none. @param {number[]} values */
export function median(values) {
  const sorted = Float64Array.from(values).sort();
  return sorted.length === 0 ? NaN : sorted[sorted.length >> 1];
}

/** Radius around its middle of everything that is drawn of a scene. @param {Scene["about"]} about */
export function reachOf(about) {
  const { center, points, margin } = buildWalls(about).bounds;
  return margin + Math.max(...points.map((point) => length(sub(point, center))), 1e-30);
}

/**
 * Simulated time whose way a velocity's arrow shows: high speeds reach two fifths of the scene.
 * @param {number} reach of the scene @param {Scene["about"]} about
 */
export const arrowTime = (reach, { full_speed }) => (0.4 * reach) / (full_speed || 1);

export class NewBall {
  constructor() {
    this.radius = 1;
    this.mass = 1;
    this.turn = 0; // place in the palette
    /** @type {{position: Vec3, velocity: Vec3} | null} */ this.ghost = null;
  }

  /** Like the free spheres of a scene. @param {Scene} scene */
  resemble(scene) {
    const free = [...scene.mass.keys()].filter((i) => Number.isFinite(scene.mass[i]));
    const radius = median(free.map((i) => scene.radius[i]));
    const mass = median(free.map((i) => scene.mass[i]));
    this.radius = radius > 0 ? Number(radius.toPrecision(4)) : 0.04 * reachOf(scene.about);
    this.mass = mass > 0 ? Number(mass.toPrecision(4)) : 1;
  }

  /** @returns {[number, number, number]} */
  get rgb() {
    return SPECIES[this.turn % SPECIES.length];
  }

  /** It hangs here, at rest. @param {Vec3} position */
  put(position) {
    this.ghost = { position, velocity: [0, 0, 0] };
  }

  /** Throw it so that its arrow ends here. @param {Vec3} tip @param {number} time of an arrow */
  aim(tip, time) {
    if (this.ghost === null) return;
    this.ghost.velocity = scale(sub(tip, this.ghost.position), 1 / time);
  }

  /** Let go: what is to be added. @returns {Ball | null} */
  release() {
    const { ghost, radius, mass } = this;
    if (ghost === null) return null;
    const ball = { ...ghost, radius, mass, color: pack(this.rgb) };
    this.ghost = null;
    this.turn++;
    return ball;
  }
}
