/**
 * Lit little arrows: a shaft and a head. One for each sphere along its velocity, computed where
 * the spheres' motion is, or single ones anywhere.
 *
 * @typedef {import("./renderer.js").Look} Look
 */
import { MOTION, RAY } from "./glsl.js";
import { LIGHT } from "./light.js";
import { add, length, scale, sub } from "./matrix.js";
import { Programs } from "./program.js";

const AROUND = 10; // corners of the shaft
const MESH = 9; // the attribute's place, behind those of the spheres
const LONG = 5; // median radii, at the end of the speed scale, which is twice the usual speed,
const FAR = 0.2; // or this part of the scene's reach, if that is more: then spheres are far apart
const START = 0.96; // radii from the centre: the arrow grows out of the surface
const HIDDEN = 0.25; // strength of the part of a single arrow that lies behind spheres
const THICKNESS = 0.13; // of the shaft, median radii; thinner on smaller spheres

/**
 * Simulated time whose way the arrow of a velocity shows: the same for all spheres of a scene.
 * @param {number} radius the median @param {number} reach of the scene
 * @param {{full_speed: number}} about
 */
export const arrowTime = (radius, reach, { full_speed }) =>
  Math.max(LONG * radius, FAR * reach) / (full_speed || 1);

/**
 * Where the arrow of a velocity begins and ends; both at the centre of a sphere at rest.
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @param {Vec3} x @param {number} radius @param {Vec3} v @param {number} time of an arrow
 */
export function arrowEnds(x, radius, v, time) {
  const speed = length(v);
  const from = speed > 0 ? add(x, scale(v, (START * radius) / speed)) : x;
  return { from, to: add(from, scale(v, time)) };
}

/**
 * The velocity whose arrow ends at a place; none inside the sphere.
 * @param {Vec3} x @param {number} radius @param {Vec3} to @param {number} time @returns {Vec3}
 */
export function velocityTo(x, radius, to, time) {
  const line = sub(to, x);
  const size = length(line);
  const beyond = size - START * radius;
  return beyond > 0 ? scale(line, beyond / (size * time)) : [0, 0, 0];
}

/**
 * mesh: direction round the shaft, then the ring: 0 tail, 1 end of the shaft, 2 the head's rim,
 * 3 the tip, 4 and 5 the head's back, outer and inner.
 */
const ARROW = `
${RAY}
layout(location = ${MESH}) in vec3 aMesh;
uniform mat4 uView;
out vec3 vPlace, vNormal;
flat out vec3 vColor;

void arrow(vec3 from, vec3 to, float width) {
  vec3 line = to - from;
  float size = length(line);
  gl_Position = vec4(2, 2, 2, 1);
  if (size <= 0.0) return;
  vec3 ahead = line / size;
  vec3 a = normalize(cross(ahead, abs(ahead.z) < 0.9 ? vec3(0, 0, 1) : vec3(1, 0, 0)));
  vec3 round = aMesh.x * a + aMesh.y * cross(ahead, a);
  float head = min(6.5 * width, 0.6 * size), rim = 0.4 * head;
  width = min(width, 0.5 * rim);
  int ring = int(aMesh.z);
  float along = ring == 0 ? 0.0 : ring == 3 ? size : size - head;
  float out_ = ring == 3 ? 0.0 : ring == 2 || ring == 4 ? rim : width;
  vec3 normal = ring < 2 ? round : ring < 4 ? normalize(round + 0.4 * ahead) : -ahead;
  vec4 p = uView * vec4(from + along * ahead + out_ * round, 1);
  vPlace = p.xyz;
  vNormal = mat3(uView) * normal;
  gl_Position = uProjection * p;
  gl_Position.z = depthAt(length(p.xyz)) * gl_Position.w;
}
`;

const SWARM_VERTEX = `
${MOTION}
${ARROW}
layout(location = 6) in float aRadius;
uniform float uTime, uThick;
uniform vec3 uColor;

void main() {
  vec3 v;
  float v2;
  vec3 x = motion(v, v2);
  float speed = length(v);
  vColor = uColor;
  vec3 ahead = speed > 0.0 ? v / speed : vec3(0);
  vec3 from = x + ${START} * aRadius * ahead;
  arrow(from, from + uTime * v, min(uThick, 0.2 * aRadius));
}
`;

const ONE_VERTEX = `
${ARROW}
uniform vec3 uFrom, uTo, uColor;
uniform float uThick;

void main() {
  vColor = uColor;
  arrow(uFrom, uTo, uThick);
}
`;

const FRAGMENT = `
${RAY}
${LIGHT}
in vec3 vPlace, vNormal;
flat in vec3 vColor;
uniform float uStrength;
out vec4 color;

void main() {
  float away = length(vPlace);
  vec3 toEye = -vPlace / away, n = normalize(vNormal);
  color = vec4(fogged(lit(vColor, n, vPlace, toEye, 0.0), away), 1) * uStrength;
}
`;

/** @returns {{vertices: Float32Array, indices: Uint16Array}} */
function arrowMesh(around = AROUND) {
  const vertices = [];
  const indices = [];
  for (let k = 0; k < around; k++) {
    const angle = (2 * Math.PI * k) / around;
    for (let ring = 0; ring < 6; ring++) vertices.push(Math.cos(angle), Math.sin(angle), ring);
    const next = (k + 1) % around;
    for (const [a, b] of [[0, 1], [5, 4], [2, 3]]) {
      indices.push(6 * k + a, 6 * next + a, 6 * k + b);
      if (b !== 3) indices.push(6 * k + b, 6 * next + a, 6 * next + b);
    }
  }
  return { vertices: new Float32Array(vertices), indices: new Uint16Array(indices) };
}

export class Arrows {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.programs = new Programs(gl, {
      swarm: [SWARM_VERTEX, FRAGMENT],
      one: [ONE_VERTEX, FRAGMENT],
    });
    const { vertices, indices } = arrowMesh();
    this.count = indices.length;
    this.array = gl.createVertexArray();
    this.vertices = gl.createBuffer();
    this.indices = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.vertices);
    gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    this.#mesh();
  }

  #mesh() {
    const { gl } = this;
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.vertices);
    gl.enableVertexAttribArray(MESH);
    gl.vertexAttribPointer(MESH, 3, gl.FLOAT, false, 12, 0);
  }

  /** The velocity of every sphere. @param {Look} look */
  velocities(look) {
    const { gl, count } = this;
    const { pair, theme } = look;
    const { n, typical } = pair.traits;
    const program = this.programs.get("swarm", { SHADOWS: "uShadow" in look.shadow });
    program.use();
    program.set(look.common);
    program.set(look.motion);
    program.set(look.shadow);
    const uTime = look.options.arrows;
    program.set({ uTime, uThick: THICKNESS * typical, uColor: theme.arrow, uStrength: 1 });
    pair.bind("arrows", () => this.#mesh());
    gl.drawElementsInstanced(gl.TRIANGLES, count, gl.UNSIGNED_SHORT, 0, n);
  }

  /**
   * Single arrows.
   * @param {Look} look @param {import("./renderer.js").ArrowMark[]} list
   */
  draw(look, list) {
    const { gl, count } = this;
    gl.depthFunc(gl.LEQUAL);
    for (const { side, from, to, color, strength } of list) {
      if (side !== look.side) continue;
      const program = this.programs.get("one", { SHADOWS: "uShadow" in look.shadow });
      program.use();
      program.set(look.common);
      program.set(look.shadow);
      // As thick as those of the spheres, yet never hair-thin on the screen.
      const pixel = (2 * look.camera.tangents.y * look.camera.distance) / look.camera.size.height;
      const thick = Math.max(1.25 * THICKNESS * look.pair.traits.typical, 1.6 * pixel);
      program.set({ uFrom: from, uTo: to, uColor: color, uThick: thick, uStrength: strength });
      gl.bindVertexArray(this.array);
      // What spheres hide of it shines through them.
      gl.depthFunc(gl.GREATER);
      gl.depthMask(false);
      program.set({ uStrength: HIDDEN * strength });
      gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_SHORT, 0);
      gl.depthFunc(gl.LEQUAL);
      gl.depthMask(true);
      program.set({ uStrength: strength });
      // Seen through, but not through itself: first its depth alone, then what is nearest.
      if (strength < 1) {
        gl.colorMask(false, false, false, false);
        gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_SHORT, 0);
        gl.colorMask(true, true, true, true);
      }
      gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_SHORT, 0);
    }
  }
}
