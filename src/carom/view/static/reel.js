/**
 * A stretch of motion in few bytes, as replay files hold it; `carom/view/reel.py` explains it and
 * does the same sums in the same order.
 *
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {{scene: Scene, keyframes: Keyframe[], speed: number}} Reel
 */
import { Impacts } from "./impacts.js";
import { decode } from "./protocol.js";
import { REEL_COLUMNS, REEL_FORMAT, STILL } from "./wire.js";

const STEPS = 2 ** 16; // quanta of length across everything that is shown
const FINE = 64; // quanta of length in the smallest radius, at least
const SLOW = 32; // quanta of velocity by which a sphere moves one quantum of length per frame
const LARGEST = 2 ** 30; // of any number written

/** Where every sphere is by what was written so far: x of all, then y, then z. */
class Guide {
  /** @param {Scene} scene @param {number[]} quanta of length and velocity */
  constructor(scene, [length, speed]) {
    const { n, about } = scene;
    this.n = n;
    this.length = length;
    this.speed = speed;
    this.period = about.period;
    this.impacts = new Impacts(scene);
    this.x = new Float64Array(3 * n);
    this.v = new Float64Array(3 * n);
    this.fall = new Float64Array(3 * n);
    this.rest = new Float64Array(n); // time from a sphere's last impact until the frame
    /** @type {Uint32Array} */ this.counts = new Uint32Array(n);
  }

  /**
   * Go on to the next frame. `missed…` says what the prediction misses, in quanta.
   * @param {number} step @param {number[]} gravity @param {Uint32Array} counts
   * @param {(at: number, predicted: number) => number} missedSpeed
   * @param {(at: number, predicted: number) => number} missedPlace
   */
  advance(step, gravity, counts, missedSpeed, missedPlace) {
    const { n, x, v, fall, rest, length, speed, period } = this;
    for (let at = 0; at < 3 * n; at++) fall[at] = counts[at % n] & STILL ? 0 : gravity[Math.floor(at / n)];
    const impulses = counts.map((count, i) => (count - this.counts[i]) & (STILL - 1));
    this.impacts.fly(x, v, fall, impulses, step, rest);
    this.counts = counts;
    for (let k = 0; k < 3; k++) {
      const side = period[k];
      for (let i = 0; i < n; i++) {
        const at = k * n + i;
        const before = v[at];
        const ahead = before + fall[at] * rest[i];
        v[at] = ahead + speed * missedSpeed(at, ahead);
        let place = x[at] + (before + v[at]) * (0.5 * rest[i]);
        if (side > 0) place = place - side * Math.floor(place / side + 0.5);
        x[at] = place + length * missedPlace(at, place);
      }
    }
  }
}

/** A number of a keyframe by its column's name. @type {Record<string, (frame: Keyframe) => number>} */
const READ = {
  t: ({ t }) => t,
  gravity_x: ({ gravity }) => gravity[0],
  gravity_y: ({ gravity }) => gravity[1],
  gravity_z: ({ gravity }) => gravity[2],
  kinetic: ({ kinetic }) => kinetic,
  potential: ({ potential }) => potential,
  dissipated: ({ dissipated }) => dissipated,
  drift: ({ drift }) => drift,
  collisions: ({ collisions }) => collisions,
  wall_collisions: ({ wallCollisions }) => wallCollisions,
  momentum_x: ({ momentum }) => momentum[0],
  momentum_y: ({ momentum }) => momentum[1],
  momentum_z: ({ momentum }) => momentum[2],
  temperature: ({ temperature }) => temperature,
  full_energy: ({ fullEnergy }) => fullEnergy,
  full_speed: ({ fullSpeed }) => fullSpeed,
};

/**
 * Pack keyframes of one scene, in order of time, as a zlib stream.
 * @param {Reel} reel
 */
export async function encodeReel({ scene, keyframes, speed }) {
  const { n } = scene;
  const frames = keyframes.length;
  const quanta = quantaOf(scene, keyframes);
  const guide = new Guide(scene, quanta);
  const changes = changesOf(n, keyframes);
  const [speeds, places] = [new Misses(n, changes), new Misses(n, changes)];
  keyframes.forEach((frame, f) => {
    const { t, gravity, counts, position, velocity } = frame;
    const note = (/** @type {Misses} */ into, /** @type {Float32Array} */ truth, /** @type {number} */ quantum) =>
      (/** @type {number} */ at, /** @type {number} */ predicted) => {
        const miss = Math.floor((truth[3 * (at % n) + Math.floor(at / n)] - predicted) / quantum + 0.5);
        if (!(Math.abs(miss) <= LARGEST)) throw new Error("spheres fly too far or too fast for a replay");
        into.numbers[into.next(f, at)] = miss >= 0 ? 2 * miss : -2 * miss - 1;
        return miss;
      };
    const step = f > 0 ? t - keyframes[f - 1].t : 0;
    guide.advance(step, gravity, counts, note(speeds, velocity, quanta[1]), note(places, position, quanta[0]));
  });
  const columns = REEL_COLUMNS.flatMap((name) => keyframes.map(READ[name]));
  const header = { format: REEL_FORMAT, n, frames, quanta, columns: REEL_COLUMNS, speed, scene: scene.bytes.length };
  const text = new TextEncoder().encode(JSON.stringify(header));
  const parts = [
    new Uint8Array(new Uint32Array([text.length]).buffer),
    text,
    scene.bytes,
    planes(new Float64Array(columns)),
    planes(changes),
    planes(speeds.numbers),
    planes(places.numbers),
  ];
  return through(new CompressionStream("deflate"), /** @type {BlobPart[]} */ (parts));
}

/** Unpack what `encodeReel` has packed. @param {Uint8Array} data @returns {Promise<Reel>} */
export async function decodeReel(data) {
  const body = await through(new DecompressionStream("deflate"), [/** @type {BlobPart} */ (data)]);
  const size = new DataView(body.buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(body.subarray(4, 4 + size)));
  if (header.format !== REEL_FORMAT) throw new Error(`this file has format ${header.format}, this page ${REEL_FORMAT}`);
  const { n, frames, quanta, columns, speed } = header;
  let start = 4 + size + header.scene;
  const message = decode(body.slice(4 + size, start).buffer);
  if (message.kind !== "scene") throw new Error("the scene is missing");
  const { scene } = message;
  const take = (/** @type {number} */ count, /** @type {number} */ width) =>
    unplaned(body.subarray(start, (start += count * width)), width);
  const table = new Float64Array(take(columns.length * frames, 8));
  const changes = new Uint32Array(take(frames * n, 4));
  const [speeds, places] = [0, 0].map(() => new Misses(n, changes, new Uint32Array(take(3 * frames * n, 4))));
  const guide = new Guide(scene, quanta);
  /** @type {Keyframe[]} */ const keyframes = [];
  for (let f = 0; f < frames; f++) {
    const numbers = Object.fromEntries(columns.map((/** @type {string} */ name, /** @type {number} */ c) => [name, table[c * frames + f]]));
    const frame = emptyKeyframe(scene, numbers);
    const last = keyframes[f - 1];
    for (let i = 0; i < n; i++) frame.counts[i] = changes[f * n + i] + (last?.counts[i] ?? 0);
    const step = last === undefined ? 0 : frame.t - last.t;
    guide.advance(step, frame.gravity, frame.counts, (at) => speeds.read(f, at), (at) => places.read(f, at));
    for (let k = 0; k < 3; k++) {
      for (let i = 0; i < n; i++) {
        frame.position[3 * i + k] = guide.x[k * n + i];
        frame.velocity[3 * i + k] = guide.v[k * n + i];
      }
    }
    frame.clock = (frame.t - (keyframes[0] ?? frame).t) / scene.about.pace;
    keyframes.push(frame);
  }
  return { scene, keyframes, speed };
}

/** How each sphere's count has changed since the frame before. @param {number} n @param {Keyframe[]} keyframes */
function changesOf(n, keyframes) {
  const changes = new Uint32Array(n * keyframes.length);
  keyframes.forEach(({ counts }, f) => {
    for (let i = 0; i < n; i++) changes[f * n + i] = counts[i] - (f > 0 ? keyframes[f - 1].counts[i] : 0);
  });
  return changes;
}

/** What predictions miss, folded: first where counts have changed, then where they have not. */
class Misses {
  /** @param {number} n @param {Uint32Array} changes @param {Uint32Array} [numbers] */
  constructor(n, changes, numbers = new Uint32Array(3 * changes.length)) {
    this.n = n;
    this.changes = changes;
    this.numbers = numbers;
    this.hit = 0;
    this.free = 3 * changes.reduce((hits, change) => hits + (change === 0 ? 0 : 1), 0);
  }

  /** Where the next number stands. @param {number} f frame @param {number} at */
  next(f, at) {
    return this.changes[f * this.n + (at % this.n)] === 0 ? this.free++ : this.hit++;
  }

  /** @param {number} f frame @param {number} at */
  read(f, at) {
    const value = this.numbers[this.next(f, at)];
    return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
  }
}

/** @param {Scene} scene @param {Record<string, number>} numbers @returns {Keyframe} */
function emptyKeyframe({ n, number }, numbers) {
  const buffer = new ArrayBuffer(28 * n);
  return {
    scene: number,
    n,
    epoch: 0,
    playing: false,
    failed: false,
    twin: false,
    reversed: false,
    t: numbers.t,
    clock: 0,
    gravity: [numbers.gravity_x, numbers.gravity_y, numbers.gravity_z],
    kinetic: numbers.kinetic,
    potential: numbers.potential,
    dissipated: numbers.dissipated,
    drift: numbers.drift,
    collisions: numbers.collisions,
    wallCollisions: numbers.wall_collisions,
    speed: 1,
    reached: 1,
    momentum: [numbers.momentum_x, numbers.momentum_y, numbers.momentum_z],
    temperature: numbers.temperature,
    missed: 0,
    overlap: 0,
    fullEnergy: numbers.full_energy,
    fullSpeed: numbers.full_speed,
    spheres: new Uint8Array(buffer),
    position: new Float32Array(buffer, 0, 3 * n),
    velocity: new Float32Array(buffer, 12 * n, 3 * n),
    counts: new Uint32Array(buffer, 24 * n, n),
  };
}

/** Quanta of length and of velocity. @param {Scene} scene @param {Keyframe[]} keyframes */
function quantaOf({ radius }, keyframes) {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  let fastest = 0;
  for (const { position, velocity } of keyframes) {
    for (let at = 0; at < position.length; at++) {
      low[at % 3] = Math.min(low[at % 3], position[at]);
      high[at % 3] = Math.max(high[at % 3], position[at]);
      fastest = Math.max(fastest, Math.abs(velocity[at]));
    }
  }
  const smallest = radius.reduce((least, each) => Math.min(least, each), Infinity);
  if (!Number.isFinite(smallest)) return [1, 1];
  const across = Math.max(...high.map((end, k) => end - low[k]), 2 * smallest);
  const reach = Math.max(...high.map(Math.abs), ...low.map(Math.abs), 1e-300);
  const length = Math.max(Math.min(across / STEPS, smallest / FINE), reach / LARGEST);
  const steps = keyframes.slice(1).map(({ t }, f) => t - keyframes[f].t).sort((a, b) => a - b);
  const usual = steps[Math.floor(steps.length / 2)] ?? 0;
  const slow = usual > 0 ? length / (SLOW * usual) : 0;
  return [length, Math.max(slow, (2 * fastest) / LARGEST) || 1];
}

/** The lowest bytes of all numbers, then the next. @param {Uint32Array | Float64Array} numbers */
function planes(numbers) {
  const bytes = new Uint8Array(numbers.buffer);
  const [count, width] = [numbers.length, numbers.BYTES_PER_ELEMENT];
  const rows = new Uint8Array(bytes.length);
  for (let b = 0; b < width; b++) {
    for (let i = 0; i < count; i++) rows[b * count + i] = bytes[i * width + b];
  }
  return rows;
}

/** @param {Uint8Array} rows @param {number} width bytes of a number */
function unplaned(rows, width) {
  const count = rows.length / width;
  const bytes = new Uint8Array(rows.length);
  for (let b = 0; b < width; b++) {
    for (let i = 0; i < count; i++) bytes[i * width + b] = rows[b * count + i];
  }
  return bytes.buffer;
}

/** @param {CompressionStream | DecompressionStream} stream @param {BlobPart[]} parts */
async function through(stream, parts) {
  const out = new Blob(parts).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(out).arrayBuffer());
}
