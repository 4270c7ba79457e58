/**
 * What collisions do to spheres between two frames, as both sides of a reel foretell it;
 * `carom/view/impacts.py` explains it and does the same sums in the same order.
 *
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {{t: number, i: number, j: number}} Impact j < 0: wall −1 − j
 * @typedef {Float64Array} Numbers x of all, then y, then z
 */
const LATE = 1.1; // of the time between frames: an impact that seems due a little later has happened too
const ROUNDS = 32; // of impacts between two frames; later ones are not foretold
const STRIPS = 256; // where there is no period; strips that many further on are the same again
const PLANE = 0;
const AXES = [0, 1, 2];

export class Impacts {
  /** @param {Scene} scene */
  constructor({ about, radius, mass }) {
    this.period = about.period;
    this.walls = about.walls.filter(({ kind }) => kind === PLANE);
    this.collide = about.collide;
    this.restitution = about.restitution;
    this.radius = Float64Array.from(radius);
    this.inverse = Float64Array.from(mass, (each) => 1 / each);
  }

  /**
   * Let spheres fly, and collide as often as they have impulses: until the last impact of each.
   * @param {Numbers} x @param {Numbers} v @param {Numbers} fall
   * @param {Uint32Array} impulses
   * @param {number} step time until the frame
   * @param {Float64Array} rest time from the last impact until the frame
   */
  fly(x, v, fall, impulses, step, rest) {
    rest.fill(step);
    /** @type {number[]} */ const some = [];
    impulses.forEach((count, i) => count > 0 && some.push(i));
    if (!(step > 0) || some.length === 0) return;
    const flight = new Flight(some, x, v, fall, impulses);
    const radius = Float64Array.from(some, (i) => this.radius[i]);
    const inverse = Float64Array.from(some, (i) => this.inverse[i]);
    let pairs = this.collide ? this.#near(flight, radius, step) : [];
    for (let round = 0; round < ROUNDS; round++) {
      pairs = pairs.filter(([i, j]) => flight.left[i] > 0 && flight.left[j] > 0);
      const due = [...this.#meetings(flight, pairs, radius), ...this.#bounces(flight, radius)];
      const chosen = first(due.filter(({ t }) => t <= LATE * step));
      if (chosen.length === 0) break;
      for (const impact of chosen) this.#rebound(flight, inverse, impact);
    }
    flight.giveBack(some, x, v);
    some.forEach((i, at) => (rest[i] = step - flight.t[at]));
  }

  /** Pairs of spheres that may meet, some of them twice: sweeps along strips of the world. @param {Flight} flight @param {Float64Array} radius @param {number} step */
  #near({ m, x, v, fall }, radius, step) {
    const speed = radius.map((_, i) => size(v, i, m));
    const fast = speed.slice().sort()[Math.floor((9 * m) / 10)]; // a sphere may be struck, and then be faster
    const reach = radius.map((r, i) => r + step * (speed[i] + fast + size(fall, i, m) * step));
    const side = AXES.map((k) => spread(x.subarray(k * m, k * m + m)));
    const [along, across] = [...AXES].sort((a, b) => side[b] - side[a]);
    return strips(x.subarray(across * m, across * m + m), reach, this.period[across])
      .flatMap((some) => this.#sweep(some, x, reach, along));
  }

  /** @param {number[]} some @param {Numbers} x @param {Float64Array} reach @param {number} axis */
  #sweep(some, x, reach, axis) {
    const [m, count] = [reach.length, some.length];
    const begin = (/** @type {number} */ i) => x[axis * m + i] - reach[i];
    const order = Uint32Array.from(some).sort((a, b) => begin(a) - begin(b));
    const low = Float64Array.from(order, begin);
    const period = this.period.map((length) => length || Infinity);
    /** @type {[number, number][]} */ const found = [];
    for (let here = 0; here < count; here++) {
      const i = order[here];
      const high = x[axis * m + i] + reach[i];
      for (let at = here + 1; at < here + count; at++) {
        // Behind the last sphere come all once more, one period on.
        if (!((at < count ? low[at] : low[at - count] + period[axis]) < high)) break;
        const j = order[at < count ? at : at - count];
        const both = reach[i] + reach[j];
        let close = true;
        for (let k = 0; close && k < 3; k++) {
          const gap = Math.abs(x[k * m + i] - x[k * m + j]);
          close = gap < both || gap > period[k] - both;
        }
        if (close) found.push(i < j ? [i, j] : [j, i]);
      }
    }
    return found;
  }

  /** When, and who with whom: |d + w s| is the sum of the radii. @param {Flight} flight @param {[number, number][]} pairs @param {Float64Array} radius */
  #meetings(flight, pairs, radius) {
    /** @type {Impact[]} */ const found = [];
    for (const [i, j] of pairs) {
      const begin = Math.max(flight.t[i], flight.t[j]);
      const [d, w] = this.#between(flight, i, j, begin);
      const reach = radius[i] + radius[j];
      const [closing, apart, speed] = [dot(d, w), dot(d, d) - reach * reach, dot(w, w)];
      const root = closing * closing - speed * apart;
      if (!(closing < 0 && root >= 0)) continue;
      found.push({ t: begin + Math.max(apart, 0) / (Math.sqrt(root) - closing), i, j });
    }
    return found;
  }

  /** When spheres meet flat walls. @param {Flight} flight @param {Float64Array} radius */
  #bounces({ m, x, v, fall, t, left }, radius) {
    /** @type {Impact[]} */ const found = [];
    this.walls.forEach(({ normal, offset }, wall) => {
      for (let i = 0; i < m; i++) {
        if (left[i] === 0) continue;
        const gap = Math.max(along(normal, x, i, m) - offset - radius[i], 0);
        const [speed, pull] = [along(normal, v, i, m), along(normal, fall, i, m)];
        const square = speed * speed - 2 * pull * gap;
        if (!(square >= 0 && (speed < 0 || pull < 0))) continue;
        const root = Math.sqrt(square);
        found.push({ t: t[i] + (speed < 0 ? (2 * gap) / (root - speed) : (speed + root) / -pull), i, j: -1 - wall });
      }
    });
    return found;
  }

  /** Bring spheres to their impact, and give them their impulses. @param {Flight} flight @param {Float64Array} inverse @param {Impact} impact */
  #rebound(flight, inverse, { t, i, j }) {
    const { m, v } = flight;
    flight.move(i, t);
    if (j < 0) {
      const { normal, restitution } = this.walls[-1 - j];
      const kick = (1 + restitution) * along(normal, v, i, m);
      for (const k of AXES) v[k * m + i] -= normal[k] * kick;
      return;
    }
    flight.move(j, t);
    const [d, w] = this.#between(flight, i, j, t);
    const share = (inverse[i] + inverse[j]) * dot(d, d);
    const push = share > 0 ? ((1 + this.restitution) * dot(d, w)) / share : 0;
    for (const k of AXES) {
      v[k * m + i] -= d[k] * (push * inverse[i]);
      v[k * m + j] += d[k] * (push * inverse[j]);
    }
  }

  /** Distance and relative velocity at a time. @param {Flight} flight @param {number} i @param {number} j @param {number} t */
  #between(flight, i, j, t) {
    const [d, w] = [[0, 0, 0], [0, 0, 0]];
    for (const k of AXES) {
      d[k] = this.#nearest(flight.place(i, k, t) - flight.place(j, k, t), k);
      w[k] = flight.velocity(i, k, t) - flight.velocity(j, k, t);
    }
    return [d, w];
  }

  /** @param {number} d @param {number} k axis */
  #nearest(d, k) {
    const length = this.period[k];
    return length > 0 ? d - length * Math.floor(d / length + 0.5) : d;
  }
}

/** Spheres on their way, each at the time of its last impact. */
class Flight {
  /** @param {number[]} some which spheres @param {Numbers} x @param {Numbers} v @param {Numbers} fall @param {Uint32Array} impulses */
  constructor(some, x, v, fall, impulses) {
    this.m = some.length;
    this.x = taken(x, some);
    this.v = taken(v, some);
    this.fall = taken(fall, some);
    this.left = Uint32Array.from(some, (i) => impulses[i]);
    this.t = new Float64Array(this.m);
  }

  /** @param {number} i @param {number} k axis @param {number} t */
  place(i, k, t) {
    const [at, s] = [k * this.m + i, t - this.t[i]];
    return this.x[at] + this.v[at] * s + this.fall[at] * (0.5 * s * s);
  }

  /** @param {number} i @param {number} k axis @param {number} t */
  velocity(i, k, t) {
    const at = k * this.m + i;
    return this.v[at] + this.fall[at] * (t - this.t[i]);
  }

  /** Bring a sphere to its impact. @param {number} i @param {number} t */
  move(i, t) {
    for (const k of AXES) {
      const [x, v] = [this.place(i, k, t), this.velocity(i, k, t)];
      this.x[k * this.m + i] = x;
      this.v[k * this.m + i] = v;
    }
    this.t[i] = t;
    this.left[i]--;
  }

  /** @param {number[]} some @param {Numbers} x @param {Numbers} v */
  giveBack(some, x, v) {
    const n = x.length / 3;
    for (const k of AXES) {
      some.forEach((i, at) => {
        x[k * n + i] = this.x[k * this.m + at];
        v[k * n + i] = this.v[k * this.m + at];
      });
    }
  }
}

/** @param {Numbers} numbers of all @param {number[]} some */
function taken(numbers, some) {
  const [n, m] = [numbers.length / 3, some.length];
  const found = new Float64Array(3 * m);
  for (let at = 0; at < m; at++) {
    for (let k = 0; k < 3; k++) found[k * m + at] = numbers[k * n + some[at]];
  }
  return found;
}

/** Spheres by the strips of one axis that they may touch. @param {Float64Array} x @param {Float64Array} reach @param {number} length of the period, or 0 */
function strips(x, reach, length) {
  let width = 4 * reach.slice().sort()[Math.floor(reach.length / 2)];
  const count = length > 0 ? Math.max(1, Math.floor(length / width)) : STRIPS;
  if (length > 0) width = length / count;
  /** @type {number[][]} */ const found = Array.from({ length: count }, () => []);
  reach.forEach((r, i) => {
    const [first, last] = [Math.floor((x[i] - r) / width), Math.floor((x[i] + r) / width)];
    const span = Math.min(last - first + 1, count);
    for (let more = 0; more < span; more++) found[(((first + more) % count) + count) % count].push(i);
  });
  return found;
}

/** Of all that may happen, what is next for everybody concerned. @param {Impact[]} due */
function first(due) {
  due.sort((a, b) => a.t - b.t || a.i - b.i || a.j - b.j);
  const taken = new Set();
  return due.filter(({ i, j }) => {
    const free = !taken.has(i) && !taken.has(j);
    taken.add(i);
    if (j >= 0) taken.add(j);
    return free;
  });
}

/** @param {number[]} normal @param {Numbers} a @param {number} i @param {number} m */
const along = (normal, a, i, m) => normal[0] * a[i] + normal[1] * a[m + i] + normal[2] * a[2 * m + i];

/** @param {number[]} a @param {number[]} b */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** @param {Numbers} a @param {number} i @param {number} m */
const size = (a, i, m) => Math.sqrt(a[i] * a[i] + a[m + i] * a[m + i] + a[2 * m + i] * a[2 * m + i]);

/** @param {Float64Array} values */
const spread = (values) => values.reduce((a, b) => Math.max(a, b)) - values.reduce((a, b) => Math.min(a, b));
