/**
 * The ball that is going to be added: put down where a pointer presses, thrown as far as it drags.
 *
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {{position: Vec3, velocity: Vec3, radius: number, mass: number, color: number}} Ball
 */
import { velocityTo } from "./arrows.js";
import { SPECIES } from "./colors.js";

/** As 0xRRGGBB. @param {number[]} rgb parts from 0 to 1 */
const pack = ([r, g, b]) =>
  (Math.round(255 * r) << 16) | (Math.round(255 * g) << 8) | Math.round(255 * b);

/** The value in the middle; NaN of none. @param {Iterable<number>} values */
export function median(values) {
  const sorted = Float64Array.from(values).sort();
  return sorted.length === 0 ? NaN : sorted[sorted.length >> 1];
}

export class NewBall {
  constructor() {
    this.radius = 1;
    this.mass = 1;
    this.turn = 0; // place in the palette
    /** @type {{position: Vec3, velocity: Vec3} | null} */ this.ghost = null;
  }

  /** Like the free spheres of a scene. @param {Scene} scene @param {number} reach of the scene */
  resemble(scene, reach) {
    const free = [...scene.mass.keys()].filter((i) => Number.isFinite(scene.mass[i]));
    const radius = median(free.map((i) => scene.radius[i]));
    const mass = median(free.map((i) => scene.mass[i]));
    this.radius = radius > 0 ? Number(radius.toPrecision(4)) : 0.04 * reach;
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
    this.ghost.velocity = velocityTo(this.ghost.position, this.radius, tip, time);
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
