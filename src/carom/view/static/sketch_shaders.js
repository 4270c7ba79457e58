/** Shaders of a sketch's shapes, each as a pair of vertex and fragment program. */
const HEAD = `#version 300 es
precision highp float;
precision highp int;
// Pixels: thinner lines are drawn as wide as this, and fainter.
const float THINNEST = 1.1, FAINTEST = 0.55;
`;

/** What every item brings, see `sketch_order.js`. */
const SHAPE = `
layout(location = 0) in vec3 aX;
layout(location = 1) in vec3 aY;
layout(location = 2) in vec3 aZ;
layout(location = 3) in vec3 aOrigin;
layout(location = 4) in vec4 aFill;
layout(location = 5) in vec4 aStroke;
layout(location = 6) in float aWeight;
layout(location = 7) in uvec2 aSide;    // 0 whole, 1 near half, 2 far half; meridians
uniform mat4 uView;
uniform float uPixels;                  // of the picture per pixel of the sheet

// Corners of a cube as one strip of 14, ±1.
vec3 cube(int i) {
  int bit = 1 << i;
  return vec3((0x287a & bit) != 0, (0x02af & bit) != 0, (0x31e3 & bit) != 0) * 2.0 - 1.0;
}
`;

/**
 * Lines of latitude and longitude that stay crisp at any width: the distance to the next line, in
 * pixels, comes from the angle itself. Its slope is taken from sine and cosine together, which
 * do not jump where the angle does.
 */
const GRID = `
// How much of a pixel lines cover that lie where k · angle is a multiple of π.
float lines(float angle, float k, float width) {
  float s = sin(k * angle), c = cos(k * angle);
  float slope = length(vec2(c * dFdx(s) - s * dFdx(c), c * dFdy(s) - s * dFdy(c)));
  float away = abs(asin(clamp(s, -1.0, 1.0))) / max(slope, 1e-6);
  // Where lines are too close to be told apart the average takes over.
  float average = min(1.0, slope * width / 3.14159265);
  return mix(clamp(0.5 * width + 0.5 - away, 0.0, 1.0), average, smoothstep(0.6, 1.4, slope));
}

// n: unit normal of the sphere, poles along y. Two of three meridians end before the poles,
// where they would run together.
float grid(vec3 n, float meridians, float width) {
  float k = 0.5 * meridians;
  float round = length(n.xz), angle = atan(n.z, n.x);
  float many = lines(angle, k, width) * smoothstep(0.34, 0.42, round);
  float few = lines(angle, k / 3.0, width) * smoothstep(0.0, 0.12, round);
  float parallels = lines(atan(n.y, max(round, 1e-6)), k, width);
  return max(max(many, few), parallels);
}
`;

/** One soft lamp above the left shoulder and a little light from everywhere. */
const LIGHT = `
vec3 lit(vec3 base, vec3 n, vec3 toEye) {
  const vec3 lamp = vec3(-0.42, 0.66, 0.62);
  float facing = clamp((dot(n, lamp) + 0.35) / 1.35, 0.0, 1.0);
  float shine = pow(max(dot(n, normalize(lamp + toEye)), 0.0), 48.0);
  float rim = pow(1.0 - clamp(dot(n, toEye), 0.0, 1.0), 3.0);
  // Squares and roots stand for the curve between colours and amounts of light.
  vec3 light = base * base * (0.36 + 0.06 * n.y + 0.62 * facing * facing);
  return sqrt(light + vec3(0.10 * shine + 0.03 * rim * (0.3 + base)));
}
`;

/**
 * Spheres under any matrix, so ellipsoids too: a box around each, and in every pixel the ray is
 * carried back to where the sphere is round.
 */
const SPHERE_VERTEX = `
${SHAPE}
uniform mat4 uProjection;
uniform vec2 uSize;
flat out mat3 vInverse;
flat out vec3 vEye;
flat out float vTurned;
flat out vec4 vFill, vStroke;
flat out float vLine;
flat out uvec2 vSide;

void main() {
  mat3 axes = mat3(uView) * mat3(aX, aY, aZ);
  vec3 center = (uView * vec4(aOrigin, 1)).xyz;
  vInverse = inverse(axes);
  vEye = -(vInverse * center);
  vTurned = determinant(axes);
  vFill = aFill;
  vStroke = aStroke;
  vLine = aWeight * uPixels;
  vSide = aSide;
  // Two pixels more all round for the smooth edge.
  float thin = min(length(aX), min(length(aY), length(aZ)));
  float pixel = 2.0 * length(center) / (uProjection[1][1] * uSize.y);
  float pad = 1.0 + min(2.0 * pixel / thin, 3.0);
  gl_Position = uProjection * vec4(axes * (pad * cube(gl_VertexID)) + center, 1);
}
`;

const SPHERE = `
uniform mat4 uProjection;
uniform vec2 uSize;         // of the picture, in pixels
${GRID}
${LIGHT}
flat in mat3 vInverse;
flat in vec3 vEye;
flat in float vTurned;
flat in vec4 vFill, vStroke;
flat in float vLine;
flat in uvec2 vSide;
uniform bool uSolid;
out vec4 color;

void main() {
  // The far faces of the box cover the same pixels, also where the eye is inside.
  if (gl_FrontFacing == (vTurned > 0.0)) discard;
  // The ray through the pixel: its length counts distance from the eye's plane.
  vec2 tangent = (2.0 * gl_FragCoord.xy / uSize - 1.0) / vec2(uProjection[0][0], uProjection[1][1]);
  vec3 ray = vec3(tangent, -1);
  vec3 along = vInverse * ray;
  float long2 = dot(along, along);
  float nearest = -dot(vEye, along) / long2;
  vec3 off = vEye + nearest * along;             // where the ray passes the centre
  float off1 = length(off);
  float half_ = sqrt(max(1.0 - off1 * off1, 0.0) / long2);
  // Outside, the normal of the outline goes on, so that derivatives exist at the edge.
  float size = max(off1, 1.0);
  bool far = vSide.x == 2u;
  float t = far ? nearest + half_ : nearest - half_;
  vec3 n = (vEye + t * along) / size;
  float slope = length(vec2(dFdx(off1), dFdy(off1)));
  float inside = (1.0 - off1) / max(slope, 1e-7);
  float thin = clamp(vLine / THINNEST, FAINTEST, 1.0);
  float width = max(vLine, THINNEST);
  float mesh = 0.0;
  if (vStroke.a > 0.0) mesh = thin * grid(n, float(vSide.y), width);
  float coverage = clamp(inside + 0.5, 0.0, 1.0);
  if (coverage <= 0.0 || t <= 0.0) discard;
  vec3 normal = normalize(n * vInverse);
  float strength = far ? 0.42 : 0.95;
  // A see-through sphere has a breath of its stroke at the rim, so that it looks round.
  float rim = 1.0 - sqrt(max(1.0 - off1 * off1, 0.0));
  float breath = far || vFill.a > 0.0 ? 0.0 : 0.03 + 0.14 * rim * rim;
  float outline = far ? 0.0 : thin * clamp(0.5 * width + 1.0 - abs(inside - 0.5 * width), 0.0, 1.0);
  float line = vStroke.a * max(max(breath, strength * mesh), 0.7 * outline);
  vec3 surface = lit(vFill.rgb, normal, -normalize(ray));
  float fill = far ? 0.0 : vFill.a;
  float alpha = coverage * (line + fill * (1.0 - line));
  if (alpha <= 0.0) discard;
  color = vec4(coverage * (vStroke.rgb * line + surface * fill * (1.0 - line)), alpha);
  // What hides things is not blended: its coverage goes to the samples of the pixel.
  if (uSolid) color.rgb /= alpha;
  gl_FragDepth = 0.5 + 0.5 * (uProjection[3][2] - uProjection[2][2] * t) / t;
}
`;

const FACE_VERTEX = `
${SHAPE}
uniform mat4 uProjection;
flat out vec4 vFill;
flat out float vTurned;
flat out uint vSide;
out vec3 vPlace;

void main() {
  mat3 axes = mat3(uView) * mat3(aX, aY, aZ);
  vPlace = axes * (0.5 * cube(gl_VertexID)) + (uView * vec4(aOrigin, 1)).xyz;
  vFill = aFill;
  vTurned = determinant(axes);
  vSide = aSide.x;
  gl_Position = uProjection * vec4(vPlace, 1);
}
`;

const FACE = `
${LIGHT}
flat in vec4 vFill;
flat in float vTurned;
flat in uint vSide;
in vec3 vPlace;
out vec4 color;

void main() {
  vec3 n = normalize(cross(dFdx(vPlace), dFdy(vPlace)));
  bool front = gl_FrontFacing == (vTurned > 0.0);
  if (vSide != 0u && front != (vSide == 1u)) discard;
  vec3 toEye = -normalize(vPlace);
  color = vec4(lit(vFill.rgb, dot(n, toEye) < 0.0 ? -n : n, toEye) * vFill.a, vFill.a);
}
`;

/** Lines of even width with round ends, so that a line of no length is a dot. */
const LINE_VERTEX = `
${SHAPE}
uniform mat4 uProjection;
uniform vec2 uSize;
flat out vec2 vFrom, vTo;   // pixels
flat out vec4 vStroke;
flat out float vLine;

void main() {
  vStroke = aStroke;
  vLine = aWeight * uPixels;
  vec4 a = uView * vec4(aOrigin, 1), b = uView * vec4(aOrigin + aX, 1);
  // Closer by one and a half times its width, so that the edges of a box lie on its faces.
  float closer = 1.0 - min(1.5 * (vLine + 1.0) * 2.0 / (uProjection[1][1] * uSize.y), 0.02);
  a.xyz *= closer;
  b.xyz *= closer;
  float near = uProjection[3][2] / (uProjection[2][2] - 1.0);    // > 0
  gl_Position = vec4(2, 2, 2, 1);
  if (a.z > -near && b.z > -near) return;
  // Cut in front of the eye: what lies behind cannot be projected.
  if (a.z > -near) a = mix(a, b, (-near - a.z) / (b.z - a.z));
  if (b.z > -near) b = mix(b, a, (-near - b.z) / (a.z - b.z));
  vec4 pa = uProjection * a, pb = uProjection * b;
  vFrom = (0.5 + 0.5 * pa.xy / pa.w) * uSize;
  vTo = (0.5 + 0.5 * pb.xy / pb.w) * uSize;
  vec2 step = vTo - vFrom;
  vec2 ahead = length(step) > 1e-3 ? normalize(step) : vec2(1, 0);
  bool end = (gl_VertexID & 2) != 0;
  float sign = float(gl_VertexID & 1) * 2.0 - 1.0;
  float reach = 0.5 * max(vLine, THINNEST) + 1.0;
  vec4 p = end ? pb : pa;
  vec2 aside = reach * (vec2(-ahead.y, ahead.x) * sign + ahead * (end ? 1.0 : -1.0));
  p.xy += aside * 2.0 / uSize * p.w;
  gl_Position = p;
}
`;

const LINE = `
flat in vec2 vFrom, vTo;
flat in vec4 vStroke;
flat in float vLine;
out vec4 color;

void main() {
  vec2 step = vTo - vFrom, off = gl_FragCoord.xy - vFrom;
  float along = clamp(dot(off, step) / max(dot(step, step), 1e-6), 0.0, 1.0);
  float away = length(off - along * step);
  float alpha = vStroke.a * clamp(vLine / THINNEST, FAINTEST, 1.0)
    * clamp(0.5 * max(vLine, THINNEST) + 0.5 - away, 0.0, 1.0);
  if (alpha <= 0.0) discard;
  color = vec4(vStroke.rgb * alpha, alpha);
}
`;

/** @type {Record<import("./sketch_order.js").Kind, [string, string]>} */
export const SKETCH_SHADERS = {
  spheres: [HEAD + SPHERE_VERTEX, HEAD + SPHERE],
  faces: [HEAD + FACE_VERTEX, HEAD + FACE],
  lines: [HEAD + LINE_VERTEX, HEAD + LINE],
};
