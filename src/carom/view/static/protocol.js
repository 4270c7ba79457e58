/**
 * What the server and this page say to each other. `carom/view/protocol.py` holds the tables.
 *
 * @typedef {object} Scene
 * @property {number} number
 * @property {number} n
 * @property {About} about
 * @property {Float32Array} radius
 * @property {Float32Array} mass infinite where fixed
 * @property {Uint32Array} color 0xRRGGBB
 * @property {Uint32Array} species
 *
 * @typedef {object} About
 * @property {string} title
 * @property {number} pace simulated time per second at speed 1
 * @property {boolean} wire
 * @property {"energy" | "own" | "speed" | "species"} color
 * @property {boolean} collide
 * @property {{position: number[], target: number[]} | null} camera
 * @property {number[]} period
 * @property {number[]} gravity
 * @property {{kind: number, normal: number[], offset: number}[]} walls
 * @property {number[]} low
 * @property {number[]} high
 * @property {number} full_energy
 * @property {number} full_speed
 *
 * @typedef {object} Keyframe
 * @property {number} scene
 * @property {number} n
 * @property {number} epoch
 * @property {boolean} playing
 * @property {boolean} failed
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
 * @property {Uint8Array} spheres positions, velocities and counts, as they came
 * @property {Float32Array} position
 * @property {Float32Array} velocity
 * @property {Uint8Array} counts
 */

export const VERSION = 1;
export const FRAME = 1;
export const SCENE = 2;
export const STILL = 0x80;
export const HEADER_BYTES = 128;
export const SCENE_HEADER_BYTES = 24;
export const SLOWEST = 1e-3;
export const FASTEST = 100;
export const MAX_CREDITS = 4;
export const WRONG_TOKEN = 4001;

const MAGIC = 0x4f524143; // "CARO", little-endian
const PLAYING = 1;
const FAILED = 2;

/**
 * @param {ArrayBuffer} buffer
 * @returns {{kind: "frame", frame: Keyframe} | {kind: "scene", scene: Scene}}
 */
export function decode(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < SCENE_HEADER_BYTES || view.getUint32(0, true) !== MAGIC) {
    throw new Error("this is no message of carom");
  }
  const version = view.getUint16(4, true);
  if (version !== VERSION) {
    throw new Error(`the server speaks version ${version}, this page ${VERSION}`);
  }
  const kind = view.getUint16(6, true);
  if (kind === FRAME) return { kind: "frame", frame: decodeFrame(buffer, view) };
  if (kind === SCENE) return { kind: "scene", scene: decodeScene(buffer, view) };
  throw new Error(`there is no message of kind ${kind}`);
}

/** @param {ArrayBuffer} buffer @param {DataView} view @returns {Keyframe} */
function decodeFrame(buffer, view) {
  const n = view.getUint32(8, true);
  if (buffer.byteLength !== HEADER_BYTES + 25 * n) {
    throw new Error(`a frame of ${n} spheres has ${buffer.byteLength} bytes`);
  }
  const flags = view.getUint32(16, true);
  const number = (/** @type {number} */ offset) => view.getFloat64(offset, true);
  return {
    n,
    epoch: view.getUint32(12, true),
    playing: (flags & PLAYING) !== 0,
    failed: (flags & FAILED) !== 0,
    scene: view.getUint32(20, true),
    t: number(24),
    clock: number(32),
    gravity: [number(40), number(48), number(56)],
    kinetic: number(64),
    potential: number(72),
    dissipated: number(80),
    drift: number(88),
    collisions: number(96),
    wallCollisions: number(104),
    speed: number(112),
    reached: number(120),
    spheres: new Uint8Array(buffer, HEADER_BYTES),
    position: new Float32Array(buffer, HEADER_BYTES, 3 * n),
    velocity: new Float32Array(buffer, HEADER_BYTES + 12 * n, 3 * n),
    counts: new Uint8Array(buffer, HEADER_BYTES + 24 * n, n),
  };
}

/** @param {ArrayBuffer} buffer @param {DataView} view @returns {Scene} */
function decodeScene(buffer, view) {
  const n = view.getUint32(8, true);
  const size = view.getUint32(16, true);
  const start = SCENE_HEADER_BYTES + size;
  if (size % 4 !== 0 || buffer.byteLength !== start + 16 * n) {
    throw new Error(`a scene of ${n} spheres has ${buffer.byteLength} bytes`);
  }
  const text = new TextDecoder().decode(new Uint8Array(buffer, SCENE_HEADER_BYTES, size));
  return {
    number: view.getUint32(20, true),
    n,
    about: JSON.parse(text),
    radius: new Float32Array(buffer, start, n),
    mass: new Float32Array(buffer, start + 4 * n, n),
    color: new Uint32Array(buffer, start + 8 * n, n),
    species: new Uint32Array(buffer, start + 12 * n, n),
  };
}

/** The messages a page may send. */
export const say = {
  /** @param {string} token */
  hello: (token) => JSON.stringify({ op: "hello", token, version: VERSION }),
  /** @param {number} count */
  credit: (count) => JSON.stringify({ op: "credit", count }),
  play: () => JSON.stringify({ op: "play" }),
  pause: () => JSON.stringify({ op: "pause" }),
  restart: () => JSON.stringify({ op: "restart" }),
  /** @param {number} value */
  speed: (value) =>
    JSON.stringify({ op: "speed", value: Math.min(FASTEST, Math.max(SLOWEST, value)) }),
};
