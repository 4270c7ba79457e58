/**
 * The walls: planes with a fine grid and the shadows that fall on them, the edges of boxes, and
 * round walls as wires. What does not change with the eye is uploaded once per scene.
 *
 * @typedef {import("./renderer.js").Look} Look
 * @typedef {import("./walls.js").Walls} Walls
 */
import { LINE, LINE_VERTEX, RAY, WIRE } from "./glsl.js";
import { SHADOW } from "./light.js";
import { dot, sub } from "./matrix.js";
import { Programs } from "./program.js";

const FACE_VERTEX = `
layout(location = 0) in vec3 aPlace;
layout(location = 1) in vec2 aGrid;
layout(location = 2) in vec2 aShare;    // 0 to 1 along the sides
uniform mat4 uView, uProjection;
out vec2 vGrid, vShare;
out vec3 vPlace;

void main() {
  vGrid = aGrid;
  vShare = aShare;
  vPlace = (uView * vec4(aPlace, 1)).xyz;
  gl_Position = uProjection * vec4(vPlace, 1);
}
`;

/** A breath of colour, lightest in the middle, with a fine grid and what shadow falls on it. */
const FACE = `
${SHADOW}
in vec2 vGrid, vShare;      // in steps of the grid, 0 in the middle; along the sides
in vec3 vPlace;
uniform vec3 uSurface, uColor;
uniform float uFill, uGridLine, uFade;   // fade: radius in steps where an endless plane ends, or 0
uniform float uShade;       // how dark a full shadow is
out vec4 color;

void main() {
  vec2 slope = fwidth(vGrid);
  vec2 off = abs(fract(vGrid + 0.5) - 0.5) / max(slope, vec2(1e-6));
  vec2 line = clamp(1.0 - off, 0.0, 1.0) * (1.0 - smoothstep(0.2, 0.6, slope));
  float grid = uGridLine * max(line.x, line.y);
  vec2 middle = 2.0 * vShare - 1.0;
  float pool = 1.0 - 0.42 * min(1.0, 0.5 * dot(middle, middle));
  float shade = uShade * (1.0 - lampSeen(vPlace));
  float fill = uFill * pool;
  vec4 wall = vec4(mix(uSurface * fill, uColor, grid), mix(fill, 1.0, grid));
  if (uFade > 0.0) {
    float rim = clamp(1.0 - length(middle), 0.0, 1.0);
    rim *= rim * (3.0 - 2.0 * rim);
    wall *= rim;
    shade *= rim;
  }
  color = vec4(wall.rgb * (1.0 - shade), wall.a + shade * (1.0 - wall.a));
}
`;

/** The inside of a spherical wall as wires: one side per pass, so that spheres lie between. */
const SHELL_VERTEX = `
${RAY}
uniform mat4 uView;
uniform float uRadius;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 c = uView[3].xyz;
  float d = length(c), reach = uRadius / sqrt(max(1.0 - uRadius * uRadius / (d * d), 1e-4));
  gl_Position = vec4(corner, 0, 1);            // the whole picture, if the eye is inside or near
  if (d < 1.1 * uRadius || -c.z < 1.1 * reach) return;
  reach += 1.5 * pixelAt(d);
  vec3 across = normalize(cross(c, abs(c.y) < 0.9 * d ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  gl_Position = uProjection * vec4(c + reach * (corner.x * across + corner.y * cross(across, c / d)), 1);
  gl_Position.z = 0.0;
}
`;

const SHELL = `
${RAY}
${WIRE}
uniform mat4 uView;
uniform float uRadius, uSide, uLine;   // side: +1 the far half, -1 the near
uniform vec3 uColor;
out vec4 color;

void main() {
  vec3 ray = normalize(rayThrough(gl_FragCoord.xy));
  vec3 center = uView[3].xyz;
  float along = dot(center, ray);
  vec3 off = ray * along - center;
  float off2 = dot(off, off);
  float half_ = sqrt(max(uRadius * uRadius - off2, 0.0));
  float t = along + uSide * half_;
  vec3 n = (off + uSide * ray * half_) / max(uRadius, sqrt(off2));
  float line = wire(transpose(mat3(uView)) * n, 6, uLine);
  float inside = (uRadius - sqrt(off2)) / pixelAt(max(along, 1e-3 * uRadius));
  float coverage = along > 0.0 || off2 < uRadius * uRadius ? clamp(inside + 0.5, 0.0, 1.0) : 0.0;
  if (coverage <= 0.0 || t <= 0.0) discard;
  float edge = 1.0 - half_ / uRadius;
  float outline = along > 0.0 ? clamp(1.5 - abs(inside - 0.5), 0.0, 1.0) : 0.0;
  // Nearer lines are brighter, from the far end of the ball to the near one.
  float near = clamp(0.5 - 0.5 * (t - length(center)) / uRadius, 0.0, 1.0);
  float strength = mix(0.20, 0.62, near);
  float alpha = coverage * max(strength * max(line, 0.9 * outline), 0.07 * edge * edge);
  color = vec4(uColor * alpha, alpha);
}
`;

/** Edges: lines that are fainter where the box turns towards the eye. */
const EDGE_VERTEX = `
layout(location = 0) in vec3 aFrom;
layout(location = 1) in vec3 aTo;
layout(location = 2) in vec3 aNormal;    // outward, of the two sides that meet here
layout(location = 3) in vec3 aNormal2;
layout(location = 4) in float aDash;
uniform vec3 uEye;
uniform vec4 uColor;
${LINE_VERTEX}

void main() {
  vec3 sight = uEye - 0.5 * (aFrom + aTo);
  bool front = min(dot(aNormal, sight), dot(aNormal2, sight)) > 0.0;
  vColor = uColor * (front ? 0.34 : 0.66);
  vDash = aDash;
  line(aFrom, aTo, float(gl_VertexID >> 1), float(gl_VertexID & 1));
}
`;

export class Room {
  /** @param {WebGL2RenderingContext} gl @param {import("./shadows.js").Shadows} shadows */
  constructor(gl, shadows) {
    this.gl = gl;
    this.shadows = shadows;
    this.programs = new Programs(gl, {
      face: [FACE_VERTEX, FACE],
      shell: [SHELL_VERTEX, SHELL],
      edge: [EDGE_VERTEX, LINE],
    });
    this.faces = this.#array(7, [3, 2, 2], 0);
    this.edges = this.#array(13, [3, 3, 3, 3, 1], 1);
    this.empty = gl.createVertexArray();
    /** @type {Walls | null} */ this.walls = null;
  }

  /**
   * @param {number} stride numbers per vertex or instance @param {number[]} sizes of the attributes
   * @param {number} divisor
   */
  #array(stride, sizes, divisor) {
    const { gl } = this;
    const [array, buffer] = [gl.createVertexArray(), gl.createBuffer()];
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    let offset = 0;
    sizes.forEach((size, at) => {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 4 * stride, 4 * offset);
      gl.vertexAttribDivisor(at, divisor);
      offset += size;
    });
    return { array, buffer };
  }

  /** @param {Walls} walls */
  set(walls) {
    const { gl } = this;
    this.walls = walls;
    const corners = walls.faces.flatMap(({ corners, grid }) =>
      corners.flatMap((corner, k) => [...corner, ...grid[k], k & 1, k >> 1]),
    );
    const edges = walls.edges.flatMap(({ from, to, outward, dash }) => [
      ...[...from, ...to, ...outward[0], ...(outward[1] ?? outward[0]), dash],
    ]);
    gl.bindVertexArray(null);
    for (const [{ buffer }, values] of /** @type {const} */ ([
      [this.faces, corners],
      [this.edges, edges],
    ])) {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
    }
  }

  /** What lies behind all spheres. @param {Look} look */
  behind(look) {
    const { gl } = this;
    const { theme, camera, level, options } = look;
    const walls = /** @type {Walls} */ (this.walls);
    const program = this.programs.get("face", { SHADOWS: "uShadow" in look.shadow });
    walls.faces.forEach((face, k) => {
      const endless = face.fade > 0;
      if (dot(face.normal, sub(look.eye, face.center)) <= 0 && !endless) return;
      const floor = dot(face.normal, camera.up) > 0.9;
      program.use();
      program.set(look.common);
      program.set(look.shadow);
      program.set({
        uSurface: theme.surface,
        uColor: theme.line,
        uFill: endless || floor ? theme.floor : theme.wall,
        uGridLine: endless ? 0.2 : floor ? 0.12 : 0.06,
        uFade: face.fade,
        uShade: floor || endless ? theme.shade : 0.4 * theme.shade,
      });
      gl.bindVertexArray(this.faces.array);
      gl.drawArrays(gl.TRIANGLE_STRIP, 4 * k, 4);
      if (!options.wire) this.shadows.spots(look, face, floor || endless);
    });
    this.#shells(look, 1);
  }

  /** Edges of boxes and tubes, among the spheres. @param {Look} look */
  lines(look) {
    const { gl } = this;
    const { edges } = /** @type {Walls} */ (this.walls);
    if (edges.length === 0) return;
    const program = this.programs.get("edge");
    program.use();
    program.set(look.common);
    program.set({ uColor: [...look.theme.line, 1], uEye: look.eye, uWidth: look.common.uLine });
    gl.bindVertexArray(this.edges.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, edges.length);
  }

  /** What lies in front of all spheres. @param {Look} look */
  before(look) {
    this.gl.disable(this.gl.DEPTH_TEST);
    this.#shells(look, -1);
    this.gl.enable(this.gl.DEPTH_TEST);
  }

  /** @param {Look} look @param {1 | -1} side */
  #shells(look, side) {
    const { gl } = this;
    for (const radius of /** @type {Walls} */ (this.walls).shells) {
      const program = this.programs.get("shell");
      program.use();
      program.set(look.common);
      program.set({ uRadius: radius, uSide: side, uColor: look.theme.shell });
      gl.bindVertexArray(this.empty);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
  }
}
