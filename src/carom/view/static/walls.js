/**
 * What is drawn of the walls, and what the camera must fit.
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {Pick<import("./protocol.js").About, "walls" | "period" | "low" | "high">} About
 *
 * @typedef {object} Face a flat wall
 * @property {Vec3} center
 * @property {Vec3} normal into the gas
 * @property {Vec3[]} corners four
 * @property {[number, number][]} grid place of each corner in steps of the grid
 * @property {Vec3} u unit vector along a side, from the first corner to the second
 * @property {Vec3} v and to the third
 * @property {[number, number]} sides lengths of both
 * @property {number} fade radius in steps where an endless plane ends, 0 for a wall with edges
 *
 * @typedef {object} Edge
 * @property {Vec3} from
 * @property {Vec3} to
 * @property {Vec3[]} outward normals, out of the gas, of the sides it joins: says if it is in front
 * @property {number} dash length of a dash with its gap, 0 for an unbroken line
 *
 * @typedef {object} Walls
 * @property {Face[]} faces
 * @property {Edge[]} edges
 * @property {number[]} shells radii of spherical walls
 * @property {{center: Vec3, points: Vec3[], margin: number}} bounds
 */
import { across, add, cross, dot, length, normalize, scale, sub } from "./matrix.js";

const PLANE = 0;
const SPHERE = 1;
const CYLINDER = 2;
const ROUND = 96; // corners of a drawn circle
const STAVES = 16; // lines along a cylinder

/** @param {About} about @returns {Walls} */
export function buildWalls(about) {
  const planes = about.walls.filter((wall) => wall.kind === PLANE);
  const shells = about.walls.filter((w) => w.kind === SPHERE).map((w) => w.offset);
  const tubes = about.walls.filter((w) => w.kind === CYLINDER).map((w) => w.offset);
  const sides = [0, 1, 2].map((axis) => boundsOf(about, planes, axis));
  const low = /** @type {Vec3} */ (sides.map((side) => side.low));
  const high = /** @type {Vec3} */ (sides.map((side) => side.high));
  const closed = sides.every((side) => side.closed);
  const slanted = planes.filter((plane) => axisOf(plane.normal) < 0);
  /** @type {Face[]} */ const faces = [];
  /** @type {Edge[]} */ const edges = [];
  const size = Math.max(...high.map((h, k) => h - low[k]));
  if (closed) box(sides, low, high, faces, edges);
  const endless = closed || tubes.length > 0 ? slanted : planes;
  for (const plane of endless) faces.push(endlessPlane(plane, low, high, size));
  for (const radius of tubes) tube(radius, low[2], high[2], edges);
  return { faces, edges, shells, bounds: boundsToFit(low, high, closed, shells, tubes) };
}

/** Radius around their middle of everything that is drawn. @param {Walls["bounds"]} bounds */
export const reachOf = ({ center, points, margin }) =>
  margin + Math.max(...points.map((point) => length(sub(point, center))), 1e-30);

/** @param {number[]} normal the axis it lies along, or -1 */
const axisOf = (normal) => normal.findIndex((part) => Math.abs(part) > 1 - 1e-9);

/**
 * Where a world ends along an axis: at walls, at the period, or where its spheres began.
 * @param {About} about @param {About["walls"]} planes @param {number} axis
 */
function boundsOf(about, planes, axis) {
  const period = about.period[axis];
  if (period > 0) return { low: -period / 2, high: period / 2, closed: true, wall: false };
  const along = planes.filter((plane) => axisOf(plane.normal) === axis);
  const lows = along.filter((p) => p.normal[axis] > 0).map((p) => p.offset);
  const highs = along.filter((p) => p.normal[axis] < 0).map((p) => -p.offset);
  return {
    low: Math.max(...(lows.length ? lows : [about.low[axis]])),
    high: Math.min(...(highs.length ? highs : [about.high[axis]])),
    closed: lows.length > 0 && highs.length > 0,
    wall: true,
  };
}

/**
 * @param {{wall: boolean}[]} sides @param {Vec3} low @param {Vec3} high
 * @param {Face[]} faces @param {Edge[]} edges
 */
function box(sides, low, high, faces, edges) {
  const corner = (/** @type {number} */ bits) =>
    /** @type {Vec3} */ ([0, 1, 2].map((k) => ((bits >> k) & 1 ? high[k] : low[k])));
  const unit = (/** @type {number} */ axis, /** @type {number} */ sign) =>
    /** @type {Vec3} */ ([0, 1, 2].map((k) => (k === axis ? sign : 0)));
  const size = Math.max(...high.map((h, k) => h - low[k]));
  for (let axis = 0; axis < 3; axis++) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    for (const side of [0, 1]) {
      const bits = [0, 1 << u, 1 << v, (1 << u) | (1 << v)];
      const corners = bits.map((b) => corner(b | (side << axis)));
      if (sides[axis].wall) {
        const center = scale(add(corners[0], corners[3]), 0.5);
        faces.push(face(center, unit(axis, side ? -1 : 1), corners, u, v, size / 10));
      }
    }
    for (const [a, b] of [[0, 0], [0, 1], [1, 0], [1, 1]]) {
      const base = (a << u) | (b << v);
      const solid = sides[u].wall || sides[v].wall;
      edges.push({
        from: corner(base),
        to: corner(base | (1 << axis)),
        outward: [unit(u, a ? 1 : -1), unit(v, b ? 1 : -1)],
        dash: solid ? 0 : size / 40,
      });
    }
  }
}

/**
 * @param {Vec3} center @param {Vec3} normal @param {Vec3[]} corners
 * @param {number} u @param {number} v axes of the grid @param {number} step
 * @returns {Face}
 */
function face(center, normal, corners, u, v, step) {
  const lines = (/** @type {number} */ axis) => {
    const side = Math.abs(corners[3][axis] - corners[0][axis]);
    return Math.max(1, Math.round(side / step)) / side; // whole squares up to the edges
  };
  const [perU, perV] = [lines(u), lines(v)];
  const grid = corners.map(
    (c) =>
      /** @type {[number, number]} */ ([
        (c[u] - corners[0][u]) * perU,
        (c[v] - corners[0][v]) * perV,
      ]),
  );
  return { center, normal, corners, grid, ...alongSides(corners), fade: 0 };
}

/** @param {Vec3[]} corners */
function alongSides(corners) {
  const [a, b] = [sub(corners[1], corners[0]), sub(corners[2], corners[0])];
  const sides = /** @type {[number, number]} */ ([length(a), length(b)]);
  return { u: normalize(a), v: normalize(b), sides };
}

/**
 * A disc of an endless plane, around the scene's shadow on it.
 * @param {About["walls"][number]} plane @param {Vec3} low @param {Vec3} high @param {number} size
 * @returns {Face}
 */
function endlessPlane(plane, low, high, size) {
  const normal = /** @type {Vec3} */ (plane.normal);
  const middle = scale(add(low, high), 0.5);
  const center = add(middle, scale(normal, plane.offset - dot(normal, middle)));
  const a = across(normal);
  const b = cross(normal, a);
  const signs = [[-1, -1], [1, -1], [-1, 1], [1, 1]];
  const reach = 1.6 * size;
  const corners = signs.map(([i, j]) => add(center, add(scale(a, i * reach), scale(b, j * reach))));
  const steps = 16;
  const grid = signs.map(([i, j]) => /** @type {[number, number]} */ ([i * steps, j * steps]));
  return { center, normal, corners, grid, ...alongSides(corners), fade: steps };
}

/** @param {number} radius @param {number} low @param {number} high @param {Edge[]} edges */
function tube(radius, low, high, edges) {
  const at = (/** @type {number} */ k, /** @type {number} */ z, /** @type {number} */ r) => {
    const angle = (2 * Math.PI * k) / ROUND;
    return /** @type {Vec3} */ ([r * Math.cos(angle), r * Math.sin(angle), z]);
  };
  for (let k = 0; k < ROUND; k++) {
    const outward = at(k, 0, 1);
    for (const [z, end] of [[low, -1], [high, 1]]) {
      const outwards = [outward, /** @type {Vec3} */ ([0, 0, end])];
      edges.push({ from: at(k, z, radius), to: at(k + 1, z, radius), outward: outwards, dash: 0 });
    }
    if (k % (ROUND / STAVES) === 0) {
      edges.push({ from: at(k, low, radius), to: at(k, high, radius), outward: [outward], dash: 0 });
    }
  }
}

/**
 * Balls of radius `margin` around points, which the camera must see.
 * @param {Vec3} low @param {Vec3} high @param {boolean} closed
 * @param {number[]} shells @param {number[]} tubes
 */
function boundsToFit(low, high, closed, shells, tubes) {
  const origin = /** @type {Vec3} */ ([0, 0, 0]);
  if (shells.length > 0) return { center: origin, points: [origin], margin: Math.min(...shells) };
  if (tubes.length > 0) {
    const r = Math.min(...tubes);
    low = [-r, -r, low[2]];
    high = [r, r, high[2]];
  }
  const center = scale(add(low, high), 0.5);
  const points = Array.from({ length: 8 }, (_, bits) =>
    /** @type {Vec3} */ ([0, 1, 2].map((k) => ((bits >> k) & 1 ? high[k] : low[k]))),
  );
  const size = Math.hypot(...high.map((h, k) => h - low[k]));
  // Open space: leave room for what flies out.
  return { center, points, margin: closed ? 0.005 * size : 0.08 * size };
}
