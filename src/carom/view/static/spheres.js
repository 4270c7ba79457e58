/**
 * Spheres as impostors: a quad or a point that covers the outline, in which every pixel's ray is
 * traced. Points are cheaper and serve where spheres are many and small.
 *
 * What it costs, in additions and multiplications (and look-ups), counted in the source:
 *
 *     per sphere   motion 70, with a collision 140; colour 15; projection 60; a quad takes it 4 times
 *     per pixel    small spheres 65, others 90: outline, normal, lamp, sky, fog
 *                  levels 2 and 3: + 25 shine and rim
 *                  in a crowd: + 12 (1 look-up)
 *                  with a shadow map: + 40 (9), where something casts a shadow + 110 (27)
 *
 * 10 000 spheres of a dense fluid at 1280 × 720 are 2.5 million pixels: 0.26 billion operations
 * and 2.5 million look-ups per picture, 16 billion per second at 60 pictures. A small built-in
 * graphics unit does 400 billion.
 *
 * @typedef {import("./renderer.js").Look} Look
 * @typedef {import("./buffers.js").Pair} Pair
 */
import { SCALES, SPECIES } from "./colors.js";
import { COLOR, MOTION, RAY, WIRE } from "./glsl.js";
import { LIGHT } from "./light.js";
import { Programs } from "./program.js";

const MODES = { own: 0, energy: 1, speed: 2, species: 3, collisions: 4 };
const POINTS_FROM = 2000; // spheres; fewer are drawn as quads, which have no largest size
const LARGEST_POINT = 96; // pixels
const FAR = 14; // pixels of radius, below which all rays to a sphere count as parallel
const FEW = 60; // spheres whose outlines are always smooth
const IMAGE = 9; // the attribute's place

const VERTEX = `
${MOTION}
${COLOR}
${RAY}
uniform mat4 uView;
layout(location = 9) in uint aImage;   // bits: axes across whose border it is; 0: the sphere
flat out vec3 vCenter;
flat out float vRadius;
flat out vec3 vColor;
#ifdef FAR
flat out float vReach, vPixels;
#endif

// Shift to the image beyond the borders, if the sphere reaches over them.
bool astride(inout vec3 x) {
  for (int k = 0; k < 3; k++) {
    if ((aImage >> k & 1u) == 0u) continue;
    if (abs(x[k]) + aRadius <= 0.5 * uPeriod[k]) return false;
    x[k] -= sign(x[k]) * uPeriod[k];
  }
  return true;
}

void main() {
  vec3 v;
  float v2;
  vec3 x = motion(v, v2);
  gl_Position = vec4(2, 2, 2, 1);              // nowhere: behind the eye, or the eye is inside
  if (!astride(x)) return;
  vec3 c = (uView * vec4(x, 1)).xyz;
  vCenter = c;
  vRadius = aRadius;
  vColor = sphereColor(v2);
  float d2 = dot(c, c), r2 = aRadius * aRadius;
  if (-c.z <= 0.02 * aRadius || d2 <= 1.02 * r2) return;
  float d = sqrt(d2);
#ifdef POINTS
  gl_Position = uProjection * vec4(c, 1);
  float focal = 0.5 * uProjection[1][1] * uPort.w, cos_ = -c.z / d;
#ifdef FAR
  vPixels = focal * aRadius / (d * cos_ * cos_);
  gl_PointSize = 2.0 * vPixels + 2.0;
  vReach = 1.0 + 1.0 / vPixels;
#else
  // Off the axis the outline is an ellipse: a lies between the centre and its farthest point.
  float sinA = aRadius / d, sin_ = sqrt(max(1.0 - cos_ * cos_, 0.0));
  float beyond = cos_ * sqrt(1.0 - sinA * sinA) - sin_ * sinA;
  gl_PointSize = 2.0 * focal * sinA / (cos_ * max(beyond, 0.2)) + 2.0;
#endif
#else
  // The cone around the sphere cuts the plane through its centre, across the line of sight, in
  // a circle of radius r d/sqrt(d² - r²); one pixel more for the smooth edge.
  float reach = aRadius * d / sqrt(d2 - r2) + 1.5 * pixelAt(d);
  vec3 across = normalize(cross(c, abs(c.y) < 0.9 * d ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 p = c + reach * (corner.x * across + corner.y * cross(across, c / d));
  gl_Position = uProjection * vec4(p, 1);
#endif
  gl_Position.z = depthAt(sqrt(d2 - r2)) * gl_Position.w;
}
`;

/**
 * Without samples edges are drawn in a pass of their own: first all whole pixels, in any order,
 * then those partly covered, mixed with what is behind.
 */
const COVER = `
uniform vec2 uCover;        // which pixels are drawn: least and most coverage

bool left(float coverage) { return coverage < uCover.x || coverage > uCover.y; }
`;

const HIT = `
${RAY}
${COVER}
flat in vec3 vCenter;
flat in float vRadius;
flat in vec3 vColor;
out vec4 color;
`;

const SOLID = `
${HIT}
${LIGHT}
void main() {
  vec3 ray = normalize(rayThrough(gl_FragCoord.xy));
  float along = dot(vCenter, ray);
  vec3 off = ray * along - vCenter;            // from the centre to the ray, across the ray
  float off2 = dot(off, off);
  float inside = (vRadius - sqrt(off2)) / pixelAt(along);
  float coverage = clamp(inside + 0.5, 0.0, 1.0);
  if (left(coverage)) discard;
  float half_ = sqrt(max(vRadius * vRadius - off2, 0.0));
  vec3 n = (off - ray * half_) / vRadius;
  float away = along - half_;
  color = vec4(fogged(lit(vColor, n, ray * away, -ray, vRadius), away), coverage);
#ifndef FLAT
  gl_FragDepth = 0.5 + 0.5 * depthAt(away);
#endif
}
`;

/** Small spheres: the same seen from far away, where all rays are parallel. */
const SOLID_POINT = `
${HIT}
${LIGHT}
flat in float vReach;       // half the point's size over the sphere's radius
flat in float vPixels;      // radius in pixels

void main() {
  vec2 across = (gl_PointCoord * 2.0 - 1.0) * vec2(vReach, -vReach);
  float off2 = dot(across, across);
  float coverage = clamp((1.0 - sqrt(off2)) * vPixels + 0.5, 0.0, 1.0);
  if (left(coverage)) discard;
  vec3 n = vec3(across, sqrt(max(1.0 - off2, 0.0)));
  float away = -vCenter.z - vRadius * n.z;
  color = vec4(fogged(lit(vColor, n, vCenter + vRadius * n, vec3(0, 0, 1), vRadius), away), coverage);
#ifndef FLAT
  gl_FragDepth = 0.5 + 0.5 * depthAt(length(vCenter + vRadius * n));
#endif
}
`;

/** The paper's look: latitude and longitude lines, those in front brighter than those behind. */
const WIRED = `
${HIT}
${WIRE}
uniform mat4 uView;
uniform float uLine;
uniform vec3 uTint;         // added where the background is dark, so that lines shine
uniform vec3 uFog, uFogRange;

void main() {
  vec3 ray = normalize(rayThrough(gl_FragCoord.xy));
  float along = dot(vCenter, ray);
  vec3 off = ray * along - vCenter;
  float off1 = sqrt(dot(off, off));
  float inside = (vRadius - off1) / pixelAt(along);
  // Outside, the normal of the outline goes on, so that derivatives exist at the edge.
  float half_ = sqrt(max(vRadius * vRadius - off1 * off1, 0.0));
  float size = max(off1, vRadius);
  mat3 toWorld = transpose(mat3(uView));
  int third = vRadius / pixelAt(along) > 24.0 ? 4 : 2;   // a line every 15 or 30 degrees
  float front = wire(toWorld * (off - ray * half_) / size, third, uLine);
  float back = wire(toWorld * (off + ray * half_) / size, third, 0.8 * uLine);
  float outline = clamp(0.5 * uLine + 1.0 - abs(inside - 0.5 * uLine), 0.0, 1.0);
  float coverage = clamp(inside + 0.5, 0.0, 1.0);
  if (coverage <= 0.0) discard;
  float turned = half_ / vRadius;              // 1 in the middle, 0 at the outline
  float edge = 1.0 - turned;
  float fill = 0.06 + 0.20 * edge * edge;
  float line = max(max((0.62 + 0.38 * turned) * front, (0.22 - 0.1 * turned) * back), 0.8 * outline);
  float fog = uFogRange.z * clamp((along - uFogRange.x) * uFogRange.y, 0.0, 1.0);
  float alpha = coverage * (fill + (1.0 - fill) * line);
  vec3 glow = mix(vColor + uTint * line, uFog, 0.8 * fog);
  color = vec4(glow, alpha);
}
`;

/** @type {Record<string, [string, string]>} */
const SHADERS = { solid: [VERTEX, SOLID], far: [VERTEX, SOLID_POINT], wire: [VERTEX, WIRED] };

export class Spheres {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {boolean} software such painters are slow with instances: points whenever they fit
   */
  constructor(gl, software) {
    this.gl = gl;
    this.software = software;
    this.programs = new Programs(gl, SHADERS);
    // Half of what the graphics unit can: a radius, with room for the ellipse off the axis.
    this.largestPoint = Math.min(LARGEST_POINT, gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1] / 3);
    this.scales = { speed: { list: SCALES.speed.flat() }, collisions: { list: SCALES.collisions.flat() } };
    this.species = { list: SPECIES.flat() };
  }

  /** @param {Look} look @returns {import("./program.js").Uniforms} */
  #colors({ options }) {
    return {
      uMode: { int: MODES[options.color] },
      uFull: options.full,
      uScale: this.scales[options.color === "collisions" ? "collisions" : "speed"],
      uSpecies: this.species,
    };
  }

  /** @param {Look} look */
  draw(look) {
    const { gl } = this;
    const { pair, options } = look;
    const size = this.#largest(look);
    const points = size < this.largestPoint && (this.software || pair.traits.n >= POINTS_FROM);
    const program = this.#begin(look, points, points && size < FAR * look.ratio);
    const { images } = pair;
    const draw = () => {
      pair.bind(points ? "points" : "quads");
      gl.vertexAttribI4ui(IMAGE, 0, 0, 0, 0);
      this.#pass(points, pair.traits.n);
      if (images.count === 0) return;
      images.bind(points ? 0 : 1);
      this.#pass(points, images.count);
    };
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE);
    if (options.wire) draw();
    else this.#solid(look, program, draw);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
  }

  /**
   * The program for this picture, with its uniforms.
   * @param {Look} look @param {boolean} points @param {boolean} far small ones
   */
  #begin(look, points, far) {
    const { options, level, about } = look;
    // Spheres that may overlap need the depth of every pixel; so do things stuck into large ones.
    const flat = about.collide && (far || level.samples === 0);
    const program = this.programs.get(options.wire ? "wire" : far ? "far" : "solid", {
      POINTS: points,
      FAR: far && !options.wire,
      FLAT: flat,
      SHADOWS: "uShadow" in look.shadow,
      CROWD: "uCrowd" in look.shadow,
      PLAIN: level.samples === 0 && level.shadow === 0,
    });
    program.use();
    program.set(look.common);
    program.set(look.motion);
    program.set(look.shadow);
    program.set(this.#colors(look));
    program.set({ uCover: ANY });
    return program;
  }

  /** @param {Look} look @param {import("./program.js").Program} program @param {() => void} draw */
  #solid({ level, pair }, program, draw) {
    const { gl } = this;
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    if (level.samples > 0) {
      // Smooth edges by coverage need no sorting, and work among spheres in one another.
      gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
      draw();
      gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
      return;
    }
    const edges = level.edges || pair.traits.n <= FEW;
    program.set({ uCover: edges ? WHOLE : HALF });
    draw();
    if (!edges) return;
    gl.depthMask(false);
    gl.enable(gl.BLEND);
    gl.depthFunc(gl.LESS); // a sphere's own whole pixels are left out early
    program.set({ uCover: EDGES });
    draw();
    gl.depthFunc(gl.LEQUAL);
  }

  /** @param {boolean} points @param {number} n */
  #pass(points, n) {
    const { gl } = this;
    if (points) gl.drawArrays(gl.POINTS, 0, n);
    else gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, n);
  }

  /** Radius of the largest sphere in pixels, were it the nearest. @param {Look} look */
  #largest({ camera, pair, common }) {
    const { largest } = pair.traits;
    const nearest = camera.distance - camera.reach;
    if (nearest <= 2 * largest) return Infinity;
    return (0.5 * largest * common.uPort[3]) / nearest / camera.tangents.y;
  }
}

const NO = { int: 0 };
const YES = { int: 1 };
// Ranges of coverage: everything, whole pixels alone, pixels mostly covered, edges alone.
const ANY = [1e-3, 2];
const WHOLE = [1, 2];
const HALF = [0.5, 2];
const EDGES = [1e-3, 0.999];
