/**
 * What the server and this page say to each other. `carom/view/protocol.py` explains it; the
 * numbers are in `wire.js`.
 *
 * @typedef {object} Scene
 * @property {number} number
 * @property {number} n
 * @property {About} about
 * @property {Float32Array} radius
 * @property {Float32Array} mass infinite where fixed
 * @property {Uint32Array} color 0xRRGGBB
 * @property {Uint32Array} species
 * @property {Uint8Array} bytes the message as it came
 *
 * @typedef {"own" | "energy" | "speed" | "species" | "collisions"} ColorMode
 *
 * @typedef {object} About
 * @property {number} key changes when another scene was loaded
 * @property {string} title
 * @property {{name: string, options: Record<string, number | string | boolean>} | null} origin
 *   where it stands in the library of scenes
 * @property {"exact" | "tick" | "reference"} method
 * @property {number} pace simulated time per second at speed 1
 * @property {boolean} wire
 * @property {ColorMode} color
 * @property {boolean} collide
 * @property {number} restitution
 * @property {{position: number[], target: number[]} | null} camera
 * @property {number[]} period
 * @property {number[]} gravity
 * @property {{kind: number, normal: number[], offset: number, restitution: number, name: string}[]} walls
 * @property {number} free_axes along how many axes momentum is conserved
 * @property {number[]} low
 * @property {number[]} high
 * @property {number} full_energy
 * @property {number} full_speed
 * @property {number} full_gravity where a slider of gravity may end
 *
 * @typedef {object} Keyframe
 * @property {number} scene
 * @property {number} n
 * @property {number} epoch
 * @property {boolean} playing
 * @property {boolean} failed
 * @property {boolean} twin of the ticks that run beside
 * @property {boolean} reversed time was turned round
 * @property {number} t
 * @property {number} clock
 * @property {[number, number, number]} gravity
 * @property {number} kinetic
 * @property {number} potential
 * @property {number} dissipated
 * @property {number} drift
 * @property {number} collisions
 * @property {number} wallCollisions
 * @property {number} speed
 * @property {number} reached
 * @property {[number, number, number]} momentum
 * @property {number} temperature
 * @property {number} missed
 * @property {number} overlap
 * @property {number} fullEnergy where the scales of colours end
 * @property {number} fullSpeed
 * @property {Uint8Array} spheres positions, velocities and counts, as they came
 * @property {Float32Array} position
 * @property {Float32Array} velocity
 * @property {Uint32Array} counts
 *
 * @typedef {object} Settings
 * @property {number} restitution
 * @property {number | null} wall_restitution null where no wall has one
 * @property {number | null} contact_time
 * @property {[number, number, number]} gravity
 * @property {boolean} comparing
 * @property {number | null} tick length of the ticks that run beside
 *
 * @typedef {object} Collision
 * @property {number} t
 * @property {number} i
 * @property {number} j the partner, or −1 − k for wall k
 * @property {[number, number, number]} impulse on i
 * @property {number} serial
 *
 * @typedef {object} SceneOption
 * @property {string} name
 * @property {"int" | "float" | "bool" | "str"} type
 * @property {number | string | boolean} default
 * @property {string} help
 * @property {number | null} low where its slider begins, null if it has none
 * @property {number | null} high
 * @property {boolean} log
 *
 * @typedef {object} Entry
 * @property {string} name
 * @property {string} title
 * @property {string} description
 * @property {SceneOption[]} options
 *
 * @typedef {object} Notes every text message by its one key
 * @property {Entry[]} catalogue
 * @property {"control" | "watch"} role
 * @property {string} failure
 * @property {Settings} settings
 * @property {Collision} event
 * @property {{pressure: (number | null)[], theory: number | null, duration: number}} walls
 *   null for a wall without end
 * @property {string} refused
 * @property {{python: string, toml: string, command: string}} source
 */
import {
  AT,
  FAILED,
  FASTEST,
  FRAME,
  FRAME_HEADER_BYTES,
  MAGIC,
  PLAYING,
  REVERSED,
  SCENE,
  SCENE_HEADER_BYTES,
  SLOWEST,
  SPHERE_BYTES,
  TWIN,
  VERSION,
} from "./wire.js";

/**
 * @param {ArrayBuffer} buffer
 * @returns {{kind: "frame", frame: Keyframe} | {kind: "scene", scene: Scene}}
 */
export function decode(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < SCENE_HEADER_BYTES || view.getUint32(AT.magic, true) !== MAGIC) {
    throw new Error("this is no message of carom");
  }
  const version = view.getUint16(AT.version, true);
  if (version !== VERSION) {
    throw new Error(`the server speaks version ${version}, this page ${VERSION}`);
  }
  const kind = view.getUint16(AT.kind, true);
  if (kind === FRAME) return { kind: "frame", frame: decodeFrame(buffer, view) };
  if (kind === SCENE) return { kind: "scene", scene: decodeScene(buffer, view) };
  throw new Error(`there is no message of kind ${kind}`);
}

/** @param {ArrayBuffer} buffer @param {DataView} view @returns {Keyframe} */
function decodeFrame(buffer, view) {
  const n = view.getUint32(AT.n, true);
  const start = FRAME_HEADER_BYTES;
  if (buffer.byteLength !== start + SPHERE_BYTES * n) {
    throw new Error(`a frame of ${n} spheres has ${buffer.byteLength} bytes`);
  }
  const flags = view.getUint32(AT.flags, true);
  const number = (/** @type {number} */ offset) => view.getFloat64(offset, true);
  return {
    n,
    epoch: view.getUint32(AT.epoch, true),
    scene: view.getUint32(AT.scene, true),
    playing: (flags & PLAYING) !== 0,
    failed: (flags & FAILED) !== 0,
    twin: (flags & TWIN) !== 0,
    reversed: (flags & REVERSED) !== 0,
    t: number(AT.t),
    clock: number(AT.clock),
    gravity: [number(AT.gravity_x), number(AT.gravity_y), number(AT.gravity_z)],
    kinetic: number(AT.kinetic),
    potential: number(AT.potential),
    dissipated: number(AT.dissipated),
    drift: number(AT.drift),
    collisions: number(AT.collisions),
    wallCollisions: number(AT.wall_collisions),
    speed: number(AT.speed),
    reached: number(AT.reached),
    momentum: [number(AT.momentum_x), number(AT.momentum_y), number(AT.momentum_z)],
    temperature: number(AT.temperature),
    missed: number(AT.missed),
    overlap: number(AT.overlap),
    fullEnergy: number(AT.full_energy),
    fullSpeed: number(AT.full_speed),
    spheres: new Uint8Array(buffer, start),
    position: new Float32Array(buffer, start, 3 * n),
    velocity: new Float32Array(buffer, start + 12 * n, 3 * n),
    counts: new Uint32Array(buffer, start + 24 * n, n),
  };
}

/** @param {ArrayBuffer} buffer @param {DataView} view @returns {Scene} */
function decodeScene(buffer, view) {
  const n = view.getUint32(AT.n, true);
  const size = view.getUint32(AT.flags, true);
  const start = SCENE_HEADER_BYTES + size;
  if (size % 4 !== 0 || buffer.byteLength !== start + 16 * n) {
    throw new Error(`a scene of ${n} spheres has ${buffer.byteLength} bytes`);
  }
  const text = new TextDecoder().decode(new Uint8Array(buffer, SCENE_HEADER_BYTES, size));
  return {
    number: view.getUint32(AT.scene, true),
    n,
    about: JSON.parse(text),
    radius: new Float32Array(buffer, start, n),
    mass: new Float32Array(buffer, start + 4 * n, n),
    color: new Uint32Array(buffer, start + 8 * n, n),
    species: new Uint32Array(buffer, start + 12 * n, n),
    bytes: new Uint8Array(buffer),
  };
}

/** @param {string} op @param {object} [values] */
const message = (op, values = {}) => JSON.stringify({ op, ...values });

/** @typedef {[number, number, number]} Vec3 */

/** The messages a page may send. */
export const say = {
  /** @param {string} token */
  hello: (token) => message("hello", { token, version: VERSION }),
  /** @param {number} count */
  credit: (count) => message("credit", { count }),
  play: () => message("play"),
  pause: () => message("pause"),
  restart: () => message("restart"),
  step: () => message("step"),
  back: () => message("back"),
  reverse: () => message("reverse"),
  /** @param {number} value */
  speed: (value) => message("speed", { value: Math.min(FASTEST, Math.max(SLOWEST, value)) }),
  /** @param {number} restitution */
  rule: (restitution) => message("rule", { restitution }),
  /** @param {number} restitution */
  walls: (restitution) => message("walls", { restitution }),
  /** @param {Vec3} value */
  gravity: (value) => message("gravity", { value }),
  /** @param {string} name @param {Record<string, number | string | boolean>} options */
  scene: (name, options) => message("scene", { name, options }),
  /** @param {{position: Vec3, velocity: Vec3, radius: number, mass: number, color: number}} ball */
  add: ({ position, velocity, radius, mass, color }) =>
    message("add", { position, velocity, radius, mass, color }),
  /** @param {number} index */
  remove: (index) => message("remove", { index }),
  /** @param {number} index @param {Vec3} velocity */
  push: (index, velocity) => message("push", { index, velocity }),
  /** @param {boolean} on */
  compare: (on) => message("compare", { on }),
  source: () => message("source"),
};
