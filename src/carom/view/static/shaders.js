/** The shaders, each as a pair of vertex and fragment program. */
import { COLOR, MOTION, RAY, WIRE } from "./glsl.js";

const HEAD = `#version 300 es
precision highp float;
precision highp int;
`;

/**
 * Spheres as impostors: a quad (or point) that covers the outline, in which every pixel's ray is
 * traced. Points are cheaper and serve where spheres are small.
 */
const IMPOSTOR = `
${MOTION}
${COLOR}
${RAY}
uniform mat4 uView;
flat out vec3 vCenter;
flat out float vRadius;
flat out vec3 vColor;
#ifdef POINTS
flat out float vReach, vPixels;
#endif

void main() {
  float v2;
  vec3 c = (uView * vec4(motion(v2), 1)).xyz;
  vCenter = c;
  vRadius = aRadius;
  vColor = sphereColor(v2);
  float d2 = dot(c, c), r2 = aRadius * aRadius;
  gl_Position = vec4(2, 2, 2, 1);              // nowhere: behind the eye, or the eye is inside
  if (-c.z <= 0.02 * aRadius || d2 <= 1.02 * r2) return;
  float d = sqrt(d2);
#ifdef POINTS
  gl_Position = uProjection * vec4(c, 1);
  vPixels = 0.5 * aRadius * d / (c.z * c.z) * uProjection[1][1] * uSize.y;
  gl_PointSize = 2.0 * vPixels + 2.0;
  vReach = 1.0 + 1.0 / vPixels;
#else
  // The cone around the sphere cuts the plane through its centre, across the line of sight, in
  // a circle of radius r d/sqrt(d² - r²); one pixel more for the smooth edge.
  float reach = aRadius * d / sqrt(d2 - r2) + pixelAt(d);
  vec3 across = normalize(cross(c, abs(c.y) < 0.9 * d ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 p = c + reach * (corner.x * across + corner.y * cross(across, c / d));
  gl_Position = uProjection * vec4(p, 1);
#endif
}
`;

const HIT = `
${RAY}
flat in vec3 vCenter;
flat in float vRadius;
flat in vec3 vColor;
uniform vec3 uUp;           // the world's up, in eye space
out vec4 color;
`;

/** One soft lamp above the left shoulder, light from the sky, a little from the ground. */
const LIGHT = `
uniform vec3 uSky, uGround, uFog;
uniform vec2 uFogRange;

vec3 lit(vec3 base, vec3 n, vec3 toEye, float away) {
  const vec3 lamp = vec3(-0.42, 0.66, 0.62);
  float facing = clamp((dot(n, lamp) + 0.3) / 1.3, 0.0, 1.0);
  vec3 around = mix(uGround, uSky, 0.5 + 0.5 * dot(n, uUp));
  float shine = max(dot(n, normalize(lamp + toEye)), 0.0);
  float shine2 = shine * shine, shine8 = shine2 * shine2 * shine2 * shine2;
  float shine64 = shine8 * shine8; shine64 *= shine64; shine64 *= shine64;
  float rim = 1.0 - dot(n, toEye); rim *= rim * rim;
  // Squares and roots stand for the curve between colours and amounts of light.
  vec3 light = base * base * (around + facing * facing)
    + vec3(0.30 * shine64 + 0.035 * shine8) + uSky * (0.22 * rim);
  light = light / (1.0 + 0.12 * light);
  return mix(sqrt(light), uFog, 0.45 * clamp((away - uFogRange.x) * uFogRange.y, 0.0, 1.0));
}
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
  if (coverage <= 0.0) discard;
  float half_ = sqrt(max(vRadius * vRadius - off2, 0.0));
  vec3 n = (off - ray * half_) / vRadius;
  float z = ray.z * (along - half_);
  color = vec4(lit(vColor, n, -ray, -z), coverage);
  gl_FragDepth = depthOf(z);
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
  if (coverage <= 0.0) discard;
  vec3 n = vec3(across, sqrt(max(1.0 - off2, 0.0)));
  float z = vCenter.z + vRadius * n.z;
  color = vec4(lit(vColor, n, vec3(0, 0, 1), -z), coverage);
  gl_FragDepth = depthOf(z);
}
`;

const WIRED = `
${HIT}
${WIRE}
uniform mat4 uView;
uniform float uLine;
uniform vec3 uTint;         // added where the background is dark, so that lines shine

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
  float every = vRadius / pixelAt(along) > 24.0 ? 15.0 : 30.0;
  float front = wire(toWorld * (off - ray * half_) / size, every, uLine);
  float back = wire(toWorld * (off + ray * half_) / size, every, uLine);
  float outline = clamp(0.5 * uLine + 1.0 - abs(inside - 0.5 * uLine), 0.0, 1.0);
  float coverage = clamp(inside + 0.5, 0.0, 1.0);
  if (coverage <= 0.0) discard;
  float edge = 1.0 - half_ / vRadius;
  float fill = 0.05 + 0.16 * edge * edge;
  float line = max(max(0.92 * front, 0.30 * back), 0.75 * outline);
  float alpha = coverage * (fill + (1.0 - fill) * line);
  color = vec4((vColor + uTint * line) * alpha, alpha);
  gl_FragDepth = depthOf(vCenter.z);
}
`;

/** The inside of a spherical wall as wires: one side per pass, so that spheres lie between. */
const SHELL_VERTEX = `
void main() {
  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0, 1);
}
`;

const SHELL = `
${RAY}
${WIRE}
uniform mat4 uView;
uniform float uRadius, uSide, uLine;   // side: +1 the far half, -1 the near
uniform vec4 uColor;
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
  float line = wire(transpose(mat3(uView)) * n, 10.0, uLine);
  float inside = (uRadius - sqrt(off2)) / pixelAt(max(along, 1e-3 * uRadius));
  float coverage = along > 0.0 || off2 < uRadius * uRadius ? clamp(inside + 0.5, 0.0, 1.0) : 0.0;
  if (coverage <= 0.0 || t <= 0.0) discard;
  float edge = 1.0 - half_ / uRadius;
  float outline = along > 0.0 ? clamp(1.5 - abs(inside - 0.5), 0.0, 1.0) : 0.0;
  float strength = uSide > 0.0 ? 0.42 : 0.30;
  float alpha = coverage * uColor.a * max(strength * max(line, outline), 0.05 * edge);
  color = vec4(uColor.rgb * alpha, alpha);
  gl_FragDepth = depthOf(ray.z * t);
}
`;

/** Straight lines of even width, dashed if asked. */
const LINE_VERTEX = `
in vec3 aFrom, aTo;
in vec2 aStyle;             // strength, length of a dash
uniform mat4 uView, uProjection;
uniform vec2 uSize;
uniform float uLine;
out float vAcross, vAlong;
flat out vec2 vStyle;

void main() {
  vec4 a = uView * vec4(aFrom, 1), b = uView * vec4(aTo, 1);
  float near = -1e-3 * (abs(a.z) + abs(b.z) + 1e-9), length_ = distance(aFrom, aTo);
  vec2 ends = vec2(0, 1);
  // Cut at the eye's plane: what lies behind cannot be projected.
  if (a.z > near && b.z < near) { ends.x = (near - a.z) / (b.z - a.z); a = mix(a, b, ends.x); }
  else if (b.z > near && a.z < near) { ends.y = (near - a.z) / (b.z - a.z); b = mix(a, b, ends.y); }
  vec4 pa = uProjection * a, pb = uProjection * b;
  vec2 step = (pb.xy / pb.w - pa.xy / pa.w) * uSize;
  vec2 side = vec2(-step.y, step.x) / max(length(step), 1e-6);
  float end = float(gl_VertexID >> 1), sign = float(gl_VertexID & 1) * 2.0 - 1.0;
  vec4 p = end > 0.5 ? pb : pa;
  float reach = 0.5 * uLine + 1.0;
  p.xy += side * sign * reach * 2.0 / uSize * p.w;
  vAcross = sign * reach;
  vAlong = mix(ends.x, ends.y, end) * length_;
  vStyle = aStyle;
  gl_Position = p;
}
`;

const LINE = `
in float vAcross, vAlong;
flat in vec2 vStyle;
uniform float uLine;
uniform vec3 uColor;
out vec4 color;

void main() {
  float alpha = vStyle.x * clamp(0.5 * uLine + 0.5 - abs(vAcross), 0.0, 1.0);
  if (vStyle.y > 0.0) {
    float beat = abs(fract(vAlong / vStyle.y) - 0.5);
    alpha *= clamp((0.28 - beat) * vStyle.y / max(fwidth(vAlong), 1e-6) + 0.5, 0.0, 1.0);
  }
  if (alpha <= 0.0) discard;
  color = vec4(uColor * alpha, alpha);
}
`;

/** Flat walls: a breath of colour and a fine grid. */
const FACE_VERTEX = `
in vec3 aPlace;
in vec2 aGrid;
uniform mat4 uView, uProjection;
out vec2 vGrid;

void main() {
  vGrid = aGrid;
  gl_Position = uProjection * uView * vec4(aPlace, 1);
}
`;

const FACE = `
in vec2 vGrid;              // in steps of the grid, 0 in the middle
uniform vec3 uColor;
uniform float uFill, uGridLine, uFade;   // fade: radius in steps where an endless plane ends, or 0
out vec4 color;

void main() {
  vec2 slope = fwidth(vGrid);
  vec2 off = abs(fract(vGrid + 0.5) - 0.5) / max(slope, vec2(1e-6));
  vec2 line = clamp(1.0 - off, 0.0, 1.0) * (1.0 - smoothstep(0.2, 0.6, slope));
  float alpha = uFill + uGridLine * max(line.x, line.y);
  if (uFade > 0.0) {
    float rim = clamp(1.0 - length(vGrid) / uFade, 0.0, 1.0);
    alpha *= rim * rim * (3.0 - 2.0 * rim);
  }
  color = vec4(uColor * alpha, alpha);
}
`;

/** @type {Record<string, [string, string]>} */
export const SHADERS = {
  solidQuads: [HEAD + IMPOSTOR, HEAD + SOLID],
  solidPoints: [HEAD + "#define POINTS\n" + IMPOSTOR, HEAD + SOLID_POINT],
  wireQuads: [HEAD + IMPOSTOR, HEAD + WIRED],
  shell: [HEAD + SHELL_VERTEX, HEAD + SHELL],
  lines: [HEAD + LINE_VERTEX, HEAD + LINE],
  faces: [HEAD + FACE_VERTEX, HEAD + FACE],
};
