/**
 * From a sheet's shapes to what is drawn, in which order: first what hides things, then what is
 * seen through, each from far to near.
 *
 * @typedef {"spheres" | "faces" | "lines"} Kind
 * @typedef {{kind: Kind, solid: boolean, first: number, count: number}} Run items drawn at once
 */
import { BOX, FILL, KIND, LINE, SHAPE_WORDS, STROKE } from "./sketch_protocol.js";

/** Which side of a shape an item is: the low half of its last word. */
const WHOLE = 0;
const NEAR = 1;
const FAR = 2;

const KINDS = /** @type {Kind[]} */ (["spheres", "faces", "lines"]);
const [SPHERES, FACES, LINES] = [0, 1, 2];
const ITEM = 4; // bytes of bookkeeping: kind, solid, side, edge
const NO_EDGE = 255;

/** Above so many see-through items they are drawn kind by kind: fewer, larger runs. */
const MIXED = 4000;

export class Order {
  constructor() {
    this.count = 0;
    this.shape = new Uint32Array(0); // of each item
    this.traits = new Uint8Array(0);
    this.depth = new Float32Array(0); // larger is farther
    this.numbers = new Float32Array(0); // items in order, as the GPU takes them
    this.words = new Uint32Array(0);
  }

  /**
   * @param {import("./sketch_protocol.js").Sheet} sheet
   * @param {Float32Array} view from the sheet to the eye
   * @returns {Run[]}
   */
  arrange(sheet, view) {
    this.#reserve(sheet);
    this.count = 0;
    for (let i = 0; i < sheet.n; i++) this.#list(sheet, i, view);
    const seen = this.#seenThrough() > MIXED ? this.#byKind() : this.#byDepth();
    return this.#write(sheet, seen);
  }

  /** @param {import("./sketch_protocol.js").Sheet} sheet */
  #reserve({ n, words }) {
    let most = 0;
    for (let i = 0; i < n; i++) most += (words[SHAPE_WORDS * i + KIND] & 0xffff) === BOX ? 14 : 2;
    if (most <= this.shape.length) return;
    this.shape = new Uint32Array(most);
    this.traits = new Uint8Array(ITEM * most);
    this.depth = new Float32Array(most);
    this.numbers = new Float32Array(SHAPE_WORDS * most);
    this.words = new Uint32Array(this.numbers.buffer);
  }

  /** @param {import("./sketch_protocol.js").Sheet} sheet @param {number} i @param {Float32Array} view */
  #list({ numbers, words }, i, view) {
    const at = SHAPE_WORDS * i;
    const depthOf = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ z) =>
      -(view[2] * x + view[6] * y + view[10] * z + view[14]);
    const center = depthOf(numbers[at + 9], numbers[at + 10], numbers[at + 11]);
    // How far the shape's axes reach towards the eye.
    let reach = 0;
    for (let k = 0; k < 9; k += 3) {
      const [x, y, z] = [numbers[at + k], numbers[at + k + 1], numbers[at + k + 2]];
      reach += (view[2] * x + view[6] * y + view[10] * z) ** 2;
    }
    reach = Math.sqrt(reach);
    const kind = words[at + KIND] & 0xffff;
    const opacity = words[at + FILL] >>> 24;
    const solid = opacity === 255;
    const stroked = words[at + STROKE] >>> 24 > 0;
    if (kind === LINE) {
      const slope = view[2] * numbers[at] + view[6] * numbers[at + 1] + view[10] * numbers[at + 2];
      this.#add(i, LINES, false, WHOLE, NO_EDGE, center - 0.5 * slope);
      return;
    }
    const flat = kind === BOX ? FACES : SPHERES;
    if (kind === BOX) reach *= 0.5;
    if (solid) this.#add(i, flat, true, WHOLE, NO_EDGE, center);
    else if (opacity > 0 || kind !== BOX) {
      if (stroked || kind === BOX) this.#add(i, flat, false, FAR, NO_EDGE, center + reach);
      this.#add(i, flat, false, NEAR, NO_EDGE, center - reach);
    }
    if (kind !== BOX || !stroked) return;
    for (let edge = 0; edge < 12; edge++) {
      const { axis, corner } = EDGES[edge];
      let depth = center;
      for (let k = 0; k < 3; k++) {
        if (k === axis) continue;
        const [x, y, z] = numbers.subarray(at + 3 * k, at + 3 * k + 3);
        depth -= corner[k] * (view[2] * x + view[6] * y + view[10] * z);
      }
      this.#add(i, LINES, false, WHOLE, edge, depth);
    }
  }

  /**
   * @param {number} shape @param {number} kind @param {boolean} solid @param {number} side
   * @param {number} edge @param {number} depth
   */
  #add(shape, kind, solid, side, edge, depth) {
    const k = this.count++;
    this.shape[k] = shape;
    this.traits[ITEM * k] = kind;
    this.traits[ITEM * k + 1] = Number(solid);
    this.traits[ITEM * k + 2] = side;
    this.traits[ITEM * k + 3] = edge;
    this.depth[k] = depth;
  }

  #seenThrough() {
    let count = 0;
    for (let k = 0; k < this.count; k++) count += 1 - this.traits[ITEM * k + 1];
    return count;
  }

  #byDepth() {
    const { traits, depth } = this;
    return Uint32Array.from({ length: this.count }, (_, k) => k).sort(
      (a, b) => traits[ITEM * b + 1] - traits[ITEM * a + 1] || depth[b] - depth[a],
    );
  }

  #byKind() {
    const { traits, depth } = this;
    return Uint32Array.from({ length: this.count }, (_, k) => k).sort(
      (a, b) =>
        traits[ITEM * b + 1] - traits[ITEM * a + 1] ||
        traits[ITEM * a] - traits[ITEM * b] ||
        depth[b] - depth[a],
    );
  }

  /**
   * Write the items in order, and say which of them are drawn at once.
   * @param {import("./sketch_protocol.js").Sheet} sheet @param {Uint32Array} order
   */
  #write({ numbers, words }, order) {
    /** @type {Run[]} */
    const runs = [];
    let run = null;
    for (let place = 0; place < order.length; place++) {
      const k = order[place];
      const [kind, solid, side, edge] = this.traits.subarray(ITEM * k, ITEM * k + ITEM);
      const from = SHAPE_WORDS * this.shape[k];
      const to = SHAPE_WORDS * place;
      this.words.set(words.subarray(from, from + SHAPE_WORDS), to);
      if (edge !== NO_EDGE) writeEdge(this.numbers.subarray(to, to + 12), EDGES[edge]);
      this.words[to + KIND] = (words[from + KIND] & 0xffff0000) | side;
      if (run === null || run.kind !== KINDS[kind] || run.solid !== (solid === 1)) {
        run = { kind: KINDS[kind], solid: solid === 1, first: place, count: 0 };
        runs.push(run);
      }
      run.count++;
    }
    return runs;
  }
}

/** The twelve edges of a box: along which axis, and on which side of the others. */
const EDGES = [0, 1, 2].flatMap((axis) =>
  [0, 1, 2, 3].map((k) => {
    const corner = [0, 0, 0];
    corner[(axis + 1) % 3] = (k & 1) - 0.5;
    corner[(axis + 2) % 3] = (k >> 1) - 0.5;
    corner[axis] = -0.5;
    return { axis, corner };
  }),
);

/**
 * Turn a box's matrix into that of the line along one of its edges.
 * @param {Float32Array} m @param {{axis: number, corner: number[]}} edge
 */
function writeEdge(m, { axis, corner }) {
  for (let row = 0; row < 3; row++) {
    const step = m[3 * axis + row];
    m[9 + row] += corner[0] * m[row] + corner[1] * m[3 + row] + corner[2] * m[6 + row];
    m[row] = step;
    m[3 + row] = m[6 + row] = 0;
  }
}
