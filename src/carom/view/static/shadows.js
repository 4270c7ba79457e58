/**
 * Shadows of spheres: a map of what the lamp sees, and soft dark spots where a sphere comes near
 * a flat wall, which need no map.
 *
 * @typedef {import("./renderer.js").Look} Look
 */
import { MOTION, RAY } from "./glsl.js";
import { lampMatrix } from "./light.js";
import { add, direction } from "./matrix.js";
import { Programs } from "./program.js";
import { product } from "./stack.js";

const NEAR_WALL = "3.5"; // radii from the wall at which a spot has faded away
const LAMP = 0.075; // the lamp's radius over its distance: how fast half-shadows widen
const SOFTEST = 0.18; // radii: a half-shadow's least radius
const FLOOR_ONLY_FROM = 3000; // spheres, from which only the floor gets spots

/**
 * A sphere casts the shadow of the disc through its centre: for others it is the same, and
 * towards itself the disc is hidden by the sphere's own dark side.
 */
const CASTER = `
${MOTION}
layout(location = 6) in float aRadius;
uniform mat4 uLampView;     // world to the map, all from 0 to 1
uniform vec3 uAcross, uAlong;
uniform vec2 uScale;        // pixels of the map per unit of length
out vec2 vDisc;

void main() {
  vec3 v;
  float v2;
  vec3 x = motion(v, v2);
#ifdef POINTS
  vec2 pixels = aRadius * uScale;
  gl_PointSize = 2.0 * max(pixels.x, pixels.y);
  vDisc = vec2(0.5 * gl_PointSize) / pixels;   // half the point's size in radii
#else
  vDisc = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  x += aRadius * (vDisc.x * uAcross + vDisc.y * uAlong);
#endif
  gl_Position = vec4(2.0 * (uLampView * vec4(x, 1)).xyz - 1.0, 1);
}
`;

const CAST = `
in vec2 vDisc;
void main() {
#ifdef POINTS
  vec2 off = (gl_PointCoord * 2.0 - 1.0) * vDisc;
#else
  vec2 off = vDisc;
#endif
  if (dot(off, off) > 1.0) discard;
}
`;

/** How much of the sky a ball hides from a place on a wall: r² h/(ρ² + h²)^(3/2). */
const SPOT_VERTEX = `
${MOTION}
${RAY}
layout(location = 6) in float aRadius;
uniform mat4 uView;
uniform vec3 uNormal, uCorner;   // of the wall, in the world
flat out vec3 vFoot;        // under the ball, in eye space
flat out float vHigh;       // the ball's height in radii
flat out float vRadius;

void main() {
  vec3 v;
  float v2;
  vec3 x = motion(v, v2);
  gl_Position = vec4(2, 2, 2, 1);
  float high = dot(x - uCorner, uNormal) / aRadius;
  if (high > ${NEAR_WALL} || high < 0.0) return;
  vec3 foot = (uView * vec4(x - uNormal * high * aRadius, 1)).xyz;
  vFoot = foot;
  vHigh = max(high, 1.0);
  vRadius = aRadius;
  float reach = (0.8 + vHigh) * aRadius;
  if (-foot.z <= 1.1 * reach) return;
  gl_Position = uProjection * vec4(foot, 1);
  gl_PointSize = 1.1 * reach * uProjection[1][1] * uPort.w / (-foot.z - 0.3 * reach);
}
`;

const SPOT = `
${RAY}
flat in vec3 vFoot;
flat in float vHigh, vRadius;
uniform vec3 uN, uU, uV, uC;     // the wall's normal, sides and corner, in eye space
uniform vec2 uSide;         // lengths of its sides
uniform float uDark;
uniform bool uRound;        // the wall is a disc
out vec4 color;

void main() {
  vec3 ray = rayThrough(gl_FragCoord.xy);
  vec3 p = ray * (dot(uC, uN) / dot(ray, uN));
  vec3 off = (p - vFoot) / vRadius;
  float off2 = dot(off, off), reach = 0.8 + vHigh;
  vec2 place = vec2(dot(p - uC, uU), dot(p - uC, uV)) / uSide;
  if (off2 > reach * reach || any(greaterThan(abs(place - 0.5), vec2(0.5)))) discard;
  float d2 = off2 + vHigh * vHigh;
  float hidden = vHigh / (d2 * sqrt(d2));
  float rim = 1.0 - off2 / (reach * reach);
  float fade = clamp((${NEAR_WALL} - vHigh) / (${NEAR_WALL} - 1.0), 0.0, 1.0);
  float alpha = uDark * hidden * rim * fade;
  if (uRound) alpha *= clamp(2.0 - 2.0 * length(2.0 * place - 1.0), 0.0, 1.0);
  color = vec4(0, 0, 0, alpha);
}
`;

export class Shadows {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.programs = new Programs(gl, { cast: [CASTER, CAST], spot: [SPOT_VERTEX, SPOT] });
    this.map = gl.createTexture();
    this.unfiltered = gl.createSampler();
    gl.samplerParameteri(this.unfiltered, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.samplerParameteri(this.unfiltered, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.samplerParameteri(this.unfiltered, gl.TEXTURE_COMPARE_MODE, gl.NONE);
    this.frame = gl.createFramebuffer();
    this.size = 0;
    this.largestPoint = gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1];
  }

  /** @param {number} size pixels along a side of the map */
  #resize(size) {
    if (size === this.size) return;
    const { gl } = this;
    this.size = size;
    gl.bindTexture(gl.TEXTURE_2D, this.map);
    gl.texImage2D(
      gl.TEXTURE_2D, 0, gl.DEPTH_COMPONENT24, size, size, 0, gl.DEPTH_COMPONENT, gl.UNSIGNED_INT, null,
    ); // prettier-ignore
    for (const [name, value] of [
      [gl.TEXTURE_MIN_FILTER, gl.LINEAR],
      [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE],
      [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
      [gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE],
      [gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL],
    ]) gl.texParameteri(gl.TEXTURE_2D, name, value); // prettier-ignore
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.map, 0);
    gl.drawBuffers([gl.NONE]);
    gl.readBuffer(gl.NONE);
  }

  /**
   * Draw the map; the uniforms with which to look it up.
   * @param {Look} look @param {import("./walls.js").Walls} walls
   * @returns {import("./program.js").Uniforms}
   */
  cast(look, walls) {
    const { gl } = this;
    const { pair, level, lamp, eyeToWorld } = look;
    this.#resize(level.shadow);
    const { largest, typical } = pair.traits;
    const { matrix, axes, size } = lampMatrix(lamp, walls.bounds, largest);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    gl.viewport(0, 0, this.size, this.size);
    gl.disable(gl.SCISSOR_TEST);
    gl.depthMask(true);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    const perLength = [this.size / size[0], this.size / size[1]];
    const points = 2 * largest * Math.max(...perLength) < this.largestPoint;
    const program = this.programs.get("cast", { POINTS: points });
    program.use();
    program.set(look.motion);
    program.set({ uLampView: matrix, uAcross: axes[0], uAlong: axes[1], uScale: perLength });
    pair.bind(points ? "points" : "quads");
    if (points) gl.drawArrays(gl.POINTS, 0, pair.traits.n);
    else gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, pair.traits.n);
    for (const unit of [0, 1]) {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, this.map);
      gl.bindSampler(unit, unit === 0 ? null : this.unfiltered);
    }
    gl.activeTexture(gl.TEXTURE0);
    // As wide as a part of a usual sphere, but never finer than the map.
    const soft = [0, 1].map((k) => Math.max((SOFTEST * typical) / size[k], 1.5 / this.size));
    return {
      uShadow: { int: 0 },
      uDepth: { int: 1 },
      uToLamp: product(matrix, eyeToWorld),
      uSoft: soft,
      uShadowed: 1 / (1 + 0.5 * look.crowded),
      uWiden: [0, 1].map((k) => (LAMP * size[2]) / size[k]),
    };
  }

  /**
   * Dark spots under spheres close to a wall.
   * @param {Look} look @param {import("./walls.js").Face} face @param {boolean} floor
   */
  spots(look, face, floor) {
    const { gl } = this;
    const { pair, theme, level } = look;
    if (!floor && (level.shadow === 0 || pair.traits.n > FLOOR_ONLY_FROM)) return;
    const program = this.programs.get("spot");
    const view = look.common.uView;
    program.use();
    program.set(look.common);
    program.set(look.motion);
    program.set({
      uNormal: face.normal,
      uCorner: face.corners[0],
      uN: direction(view, face.normal),
      uU: direction(view, face.u),
      uV: direction(view, face.v),
      uC: add(direction(view, face.corners[0]), [view[12], view[13], view[14]]),
      uSide: face.sides,
      uDark: theme.contact / (1 + 0.3 * look.crowded),
      uRound: { int: face.fade > 0 ? 1 : 0 },
    });
    pair.bind("points");
    gl.drawArrays(gl.POINTS, 0, pair.traits.n);
  }
}
