/** Pieces of GLSL that several shaders share. */

/** Motion between two keyframes; `interpolation.js` explains it and is tested against this. */
export const MOTION = `
in vec3 aX0, aV0, aX1, aV1;
in uint aC0, aC1;
uniform float uS, uH;       // time since the first keyframe, time between both
uniform vec3 uG;
uniform vec3 uPeriod, uPerPeriod;   // 0 on axes that are not periodic

vec3 nearestImage(vec3 x, vec3 place) { return x + uPeriod * round((place - x) * uPerPeriod); }

vec3 wrap(vec3 x) { return x - uPeriod * floor(x * uPerPeriod + 0.5); }

vec3 motion(out float v2) {
  if (!(uH > 0.0)) { v2 = dot(aV1, aV1); return aX1; }
  uint hits = (aC1 - aC0) & 0x7fffffffu;
  float share = uS / uH;
  if (hits > 1u || ((aC0 ^ aC1) & 0x80000000u) != 0u) {
    vec3 x1 = nearestImage(aX1, aX0 + 0.5 * uH * (aV0 + aV1));
    v2 = mix(dot(aV0, aV0), dot(aV1, aV1), share);
    return wrap(mix(aX0, x1, share));
  }
  vec3 g = (aC0 & 0x80000000u) != 0u ? vec3(0) : uG;
  float left = uH - uS;
  vec3 forward = aX0 + aV0 * uS + (0.5 * uS * uS) * g;
  vec3 back = (0.5 * left * left) * g - aV1 * left;    // from x1
  vec3 ahead = aV0 + g * uS, behind = aV1 - g * left;
  vec3 w1 = aV1 - g * uH, fall = (0.5 * uH * uH) * g;
  if (hits == 0u) {
    vec3 x1 = nearestImage(aX1, aX0 + aV0 * uH + fall);
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
  if (uS < crossing) { v2 = dot(ahead, ahead); return wrap(forward); }
  v2 = dot(behind, behind);
  return wrap(x1 + back);
}
`;

/** Colour of a sphere; `colors.js` has the same for the legend. */
export const COLOR = `
in float aRadius, aMass;
in vec4 aColor;             // red, green, blue, species/255
uniform int uMode;          // 0 own, 1 energy, 2 speed, 3 species
uniform float uFull;        // energy or speed at the end of the scale
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
  if (uMode == 2) {
    float place = 4.0 * clamp(sqrt(v2) / uFull, 0.0, 1.0);
    int step = int(min(place, 3.0));
    return mix(uScale[step], uScale[step + 1], place - float(step));
  }
  if (uMode == 3) return uSpecies[int(aColor.a * 255.0 + 0.5) % 7];
  return aColor.rgb;
}
`;

/** The ray through a pixel, and where it meets a sphere; all in eye space. */
export const RAY = `
uniform mat4 uProjection;
uniform vec2 uSize;         // of the picture, in pixels

vec3 rayThrough(vec2 pixel) {
  vec2 ndc = 2.0 * pixel / uSize - 1.0;
  vec2 axis = vec2(uProjection[2][0], uProjection[2][1]);
  vec2 focal = vec2(uProjection[0][0], uProjection[1][1]);
  return vec3((ndc + axis) / focal, -1.0);
}

float depthOf(float z) {
  return 0.5 + 0.5 * (uProjection[2][2] * z + uProjection[3][2]) / -z;
}

// Size of a pixel as seen at a distance.
float pixelAt(float distance) { return 2.0 * distance / (uProjection[1][1] * uSize.y); }
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

// n: unit normal in the world, poles along z; \`every\` degrees. Two of three meridians end
// before the poles, where they would run together.
float wire(vec3 n, float every, float width) {
  float k = 180.0 / every;
  float round = length(n.xy);
  float angle = atan(n.y, n.x);
  float meridians = lines(sin(k * angle), width) * smoothstep(0.34, 0.42, round);
  float few = lines(sin(k / 3.0 * angle), width) * smoothstep(0.0, 0.12, round);
  float parallels = lines(sin(k * atan(n.z, max(round, 1e-6))), width);
  return max(max(meridians, few), parallels);
}
`;
