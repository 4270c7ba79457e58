/** Pieces of GLSL that several shaders share. */

/** Motion between two keyframes; `interpolation.js` explains it and is tested against this. */
export const MOTION = `
layout(location = 0) in vec3 aX0;
layout(location = 1) in vec3 aV0;
layout(location = 2) in vec3 aX1;
layout(location = 3) in vec3 aV1;
layout(location = 4) in uint aC0;   // impulses so far in 31 bits; the top bit: no gravity
layout(location = 5) in uint aC1;
const uint STILL = 0x80000000u;
uniform float uS, uH;       // time since the first keyframe, time between both
uniform vec3 uG;
uniform vec3 uPeriod, uPerPeriod;   // 0 on axes that are not periodic

vec3 nearestImage(vec3 x, vec3 place) { return x + uPeriod * round((place - x) * uPerPeriod); }

vec3 wrap(vec3 x) { return x - uPeriod * floor(x * uPerPeriod + 0.5); }

vec3 motion(out vec3 v, out float v2) {
  v = aV1;
  v2 = dot(aV1, aV1);
  if (!(uH > 0.0)) return aX1;
  uint hits = (aC1 - aC0) & 0x7fffffffu;
  float share = uS / uH;
  if (hits > 1u || ((aC0 ^ aC1) & STILL) != 0u) {
    vec3 x1 = nearestImage(aX1, aX0 + 0.5 * uH * (aV0 + aV1));
    v = mix(aV0, aV1, share);
    v2 = mix(dot(aV0, aV0), v2, share);
    return wrap(mix(aX0, x1, share));
  }
  vec3 g = (aC0 & STILL) != 0u ? vec3(0) : uG;
  float left = uH - uS;
  vec3 forward = aX0 + aV0 * uS + (0.5 * uS * uS) * g;
  vec3 back = (0.5 * left * left) * g - aV1 * left;    // from x1
  vec3 ahead = aV0 + g * uS, behind = aV1 - g * left;
  vec3 w1 = aV1 - g * uH, fall = (0.5 * uH * uH) * g;
  if (hits == 0u) {
    vec3 x1 = nearestImage(aX1, aX0 + aV0 * uH + fall);
    v = mix(ahead, behind, share);
    v2 = mix(dot(ahead, ahead), dot(behind, behind), share);
    return wrap(mix(forward, x1 + back, share));
  }
  vec3 kick = aV0 - w1, x1 = aX1;
  float strength = dot(kick, kick), crossing = 0.5 * uH;
  for (int round = 0; round < 2; round++) {
    x1 = nearestImage(aX1, aX0 + aV0 * crossing + w1 * (uH - crossing) + fall);
    vec3 d = x1 - fall - aX0 - w1 * uH;
    if (strength > 0.0) crossing = clamp(dot(d, kick) / strength, 0.0, uH);
  }
  bool before = uS < crossing;
  v = before ? ahead : behind;
  v2 = dot(v, v);
  return wrap(before ? forward : x1 + back);
}
`;

/** Colour of a sphere; `colors.js` has the same for the legend. */
export const COLOR = `
layout(location = 6) in float aRadius;
layout(location = 7) in float aMass;
layout(location = 8) in vec4 aColor;    // red, green, blue, species/255
uniform int uMode;          // 0 own, 1 energy, 2 speed, 3 species, 4 collisions
uniform float uFull;        // energy, speed or count at the end of the scale
uniform vec3 uScale[5];
uniform vec3 uSpecies[7];

// The paper's HSB colour: hue and brightness are the sphere's own, saturation is its energy.
vec3 saturated(vec3 own, float saturation) {
  float most = max(own.r, max(own.g, own.b)), least = min(own.r, min(own.g, own.b));
  vec3 hue = most > least ? (own - least) / (most - least) : vec3(1, 0, 0);
  return most * mix(vec3(1), hue, saturation);
}

vec3 sphereColor(float v2) {
  if (uMode == 1) return saturated(aColor.rgb, clamp(0.5 * aMass * v2 / uFull, 0.0, 1.0));
  if (uMode == 2 || uMode == 4) {
    float much = uMode == 2 ? sqrt(v2) : float(aC1 & 0x7fffffffu);
    float place = 4.0 * clamp(much / uFull, 0.0, 1.0);
    int step = int(min(place, 3.0));
    return mix(uScale[step], uScale[step + 1], place - float(step));
  }
  if (uMode == 3) return uSpecies[int(aColor.a * 255.0 + 0.5) % 7];
  return aColor.rgb;
}
`;

/**
 * The ray through a pixel, and depths; all in eye space. Depth is kept as distance from the eye
 * and not along the axis: then one number per sphere, √(d² − r²), puts spheres that do not
 * overlap in the right order everywhere (the power distance), and the depth test can come
 * before the fragment shader.
 */
export const RAY = `
uniform mat4 uProjection;
uniform vec4 uPort;         // of the picture in the buffer, in pixels: left, bottom, width, height

vec3 rayThrough(vec2 pixel) {
  vec2 ndc = 2.0 * (pixel - uPort.xy) / uPort.zw - 1.0;
  vec2 axis = vec2(uProjection[2][0], uProjection[2][1]);
  vec2 focal = vec2(uProjection[0][0], uProjection[1][1]);
  return vec3((ndc + axis) / focal, -1.0);
}

// -1 to 1, as in gl_Position.z / gl_Position.w, from the distance.
float depthAt(float away) {
  return clamp((uProjection[2][2] * -away + uProjection[3][2]) / away, -1.0, 1.0);
}

// Size of a pixel as seen at a distance.
float pixelAt(float away) { return 2.0 * away / (uProjection[1][1] * uPort.w); }
`;

/** Latitude and longitude lines on a sphere, all equally thin and smooth. */
export const WIRE = `
// How much of a pixel is covered by lines where f = 0, \`width\` pixels wide. Where they are too
// close to be told apart the average takes over.
float lines(float f, float width) {
  float slope = length(vec2(dFdx(f), dFdy(f)));
  float line = clamp(0.5 * width + 0.5 - abs(f) / max(slope, 1e-6), 0.0, 1.0);
  float average = min(1.0, slope * width / 3.14159265);
  return mix(line, average, smoothstep(0.6, 1.4, slope));
}

// z = (cos a, sin a) to the power n: (cos na, sin na), without a sine.
vec2 turned(vec2 z, int n) {
  vec2 result = vec2(1, 0);
  for (; n > 0; n >>= 1) {
    if ((n & 1) == 1) result = vec2(result.x * z.x - result.y * z.y, result.x * z.y + result.y * z.x);
    z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y);
  }
  return result;
}

// n: unit normal in the world, poles along z; 3 \`third\` lines to a half circle. Two of three
// meridians end before the poles, where they would run together.
float wire(vec3 n, int third, float width) {
  float round = length(n.xy);
  vec2 few = turned(n.xy / max(round, 1e-6), third);
  float meridians = lines(turned(few, 3).y, width) * smoothstep(0.34, 0.42, round);
  float all = lines(few.y, width) * smoothstep(0.0, 0.12, round);
  float parallels = lines(turned(vec2(round, n.z), 3 * third).y, width);
  return max(max(meridians, all), parallels);
}
`;

/**
 * Lines of even width between two places, smooth at their sides, dashed if asked; for shaders
 * with an instance per line and four vertices.
 */
export const LINE_VERTEX = `
${RAY}
uniform mat4 uView;
uniform float uWidth;       // pixels
out float vAcross, vAlong;
out vec3 vPlace;
flat out float vDash;       // length of a dash with its gap, 0 for an unbroken line
out vec4 vColor;            // multiplied by its alpha

// end: 0 at \`from\`, 1 at \`to\`; side: 0 or 1.
void line(vec3 from, vec3 to, float end, float side) {
  vec4 a = uView * vec4(from, 1), b = uView * vec4(to, 1);
  float near = -1e-3 * (abs(a.z) + abs(b.z) + 1e-9);
  vec2 ends = vec2(0, 1);
  // Cut at the eye's plane: what lies behind cannot be projected.
  if (a.z > near && b.z < near) { ends.x = (near - a.z) / (b.z - a.z); a = mix(a, b, ends.x); }
  else if (b.z > near && a.z < near) { ends.y = (near - a.z) / (b.z - a.z); b = mix(a, b, ends.y); }
  vec4 pa = uProjection * a, pb = uProjection * b;
  vec2 step = (pb.xy / pb.w - pa.xy / pa.w) * uPort.zw;
  vec2 across = vec2(-step.y, step.x) / max(length(step), 1e-6);
  vec4 p = end > 0.5 ? pb : pa;
  float sign = 2.0 * side - 1.0, reach = 0.5 * uWidth + 1.0;
  p.xy += across * sign * reach * 2.0 / uPort.zw * p.w;
  vAcross = sign * reach;
  vAlong = mix(ends.x, ends.y, end) * distance(from, to);
  vPlace = end > 0.5 ? b.xyz : a.xyz;
  gl_Position = p;
}
`;

/** The pixels of such lines. */
export const LINE = `
${RAY}
in float vAcross, vAlong;
flat in float vDash;
in vec4 vColor;
in vec3 vPlace;
uniform float uWidth;
out vec4 color;

void main() {
  float alpha = clamp(0.5 * uWidth + 0.5 - abs(vAcross), 0.0, 1.0);
  if (vDash > 0.0) {
    float beat = abs(fract(vAlong / vDash) - 0.5);
    alpha *= clamp((0.28 - beat) * vDash / max(fwidth(vAlong), 1e-6) + 0.5, 0.0, 1.0);
  }
  if (alpha <= 0.0) discard;
  color = vColor * alpha;
  gl_FragDepth = 0.5 + 0.5 * depthAt(length(vPlace));
}
`;
