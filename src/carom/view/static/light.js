/** Light and shade: the lamp, and the GLSL that all lit things share. */
import { across, cross, dot, normalize } from "./matrix.js";

/** @typedef {import("./matrix.js").Vec3} Vec3 */

/**
 * Where the lamp stands: above the left shoulder of who looks. Where there is a floor it stays in
 * the room as the eye goes about, so that shadows lie still; elsewhere it comes along.
 * @param {Vec3} up @param {Vec3} right @param {Vec3} back axes of the eye, or of the room
 * @returns {Vec3} unit vector towards the lamp
 */
export function lampFrom(up, right, back) {
  const flat = cross(up, right); // into the picture, level
  const sign = Math.sign(dot(flat, back)) || 1;
  const part = (/** @type {number} */ k) => 0.8 * up[k] - 0.3 * right[k] + 0.38 * sign * flat[k];
  return normalize([part(0), part(1), part(2)]);
}

/**
 * World to the shadow map: the lamp's view of everything, without perspective, as texture
 * coordinates and depth from 0 to 1. Column by column.
 * @param {Vec3} lamp @param {{points: Vec3[], margin: number}} bounds @param {number} more margin
 * @returns {{matrix: Float32Array, axes: [Vec3, Vec3], size: [number, number, number]}}
 */
export function lampMatrix(lamp, { points, margin }, more) {
  const a = across(lamp);
  const b = cross(lamp, a);
  const rows = [a, b, /** @type {Vec3} */ ([-lamp[0], -lamp[1], -lamp[2]])];
  const matrix = new Float32Array(16);
  const size = rows.map((row, k) => {
    const along = points.map((point) => dot(point, row));
    const low = Math.min(...along) - margin - more;
    const high = Math.max(...along) + margin + more;
    for (let j = 0; j < 3; j++) matrix[4 * j + k] = row[j] / (high - low);
    matrix[12 + k] = -low / (high - low);
    return high - low;
  });
  matrix[15] = 1;
  return { matrix, axes: [a, b], size: /** @type {[number, number, number]} */ (size) };
}

const TAPS = 18;

/** Places in a disc, evenly (H. Vogel's sunflower). */
const DISC = Array.from({ length: TAPS }, (_, k) => {
  const [r, angle] = [Math.sqrt((k + 0.5) / TAPS), 2.39996323 * k];
  return `vec2(${(r * Math.cos(angle)).toFixed(5)}, ${(r * Math.sin(angle)).toFixed(5)})`;
});

/**
 * How much of the lamp a place sees; 1 where there is no shadow map. The half-shadow is as wide
 * as what casts it is far away.
 */
export const SHADOW = `
#ifdef SHADOWS
uniform highp sampler2DShadow uShadow;
uniform highp sampler2D uDepth;     // the same map, unfiltered
uniform mat4 uToLamp;       // from eye space
uniform vec2 uSoft;         // radius of the half-shadow in the map, at least
uniform vec2 uWiden;        // and more per depth between caster and place
uniform float uShadowed;    // how dark shadows may be: less in a crowd, where all is in shadow

float lampSeen(vec3 p) {
  vec3 at = (uToLamp * vec4(p, 1)).xyz;
  if (any(lessThan(at, vec3(0))) || any(greaterThan(at, vec3(1)))) return 1.0;
  const vec2 disc[${TAPS}] = vec2[](${DISC.join(", ")});
  vec2 search = uSoft + 0.12 * uWiden;
  float casters = 0.0, between = 0.0;
  for (int k = 0; k < ${TAPS}; k += 2) {
    float gap = at.z - texture(uDepth, at.xy + search * disc[k]).r;
    if (gap > 0.0) { casters += 1.0; between += gap; }
  }
  if (casters == 0.0) return 1.0;
  // Turned from pixel to pixel (J. Jimenez's gradient noise), or the places would show as rings.
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  mat2 turned = mat2(cos(turn), sin(turn), -sin(turn), cos(turn));
  vec2 wide = uSoft + uWiden * min(between / casters, 0.3);
  float sum = 0.0;
  for (int k = 0; k < ${TAPS}; k++) sum += texture(uShadow, vec3(at.xy + wide * (turned * disc[k]), at.z));
  return mix(1.0, sum / ${TAPS}.0, uShadowed);
}
#else
float lampSeen(vec3 p) { return 1.0; }
#endif
`;

/** How much light is left in a crowd of spheres; 1 where there is none. */
const CROWD = `
#ifdef CROWD
uniform mediump sampler3D uCrowd;
uniform mat4 uToCrowd;      // from eye space
float lightLeft(vec3 p) { return texture(uCrowd, (uToCrowd * vec4(p, 1)).xyz).r; }
#else
float lightLeft(vec3 p) { return 1.0; }
#endif
`;

/**
 * One soft lamp, light from the sky, a little back from the ground, a dull shine. Squares and
 * roots stand for the curve between colours and amounts of light.
 */
export const LIGHT = `
${SHADOW}
${CROWD}
uniform vec3 uLamp, uUp;    // unit vectors towards the lamp and up, in eye space
uniform vec3 uKey, uSky, uGround, uFog;
uniform vec3 uFogRange;     // where fog begins, 1/length, how thick it becomes

vec3 fogged(vec3 color, float away) {
  float share = clamp((away - uFogRange.x) * uFogRange.y, 0.0, 1.0);
  return mix(color, uFog, uFogRange.z * share);
}

// p: place, n: normal, toEye: unit vectors in eye space; size: how far the thing shades itself.
vec3 lit(vec3 base, vec3 n, vec3 p, vec3 toEye, float size) {
  float facing = dot(n, uLamp);
  // Light creeps round the edge, where the thing's own shadow would be hard.
  float seen = mix(1.0, lampSeen(p + 0.12 * size * uLamp), smoothstep(-0.05, 0.2, facing));
  float round = clamp((facing + 0.35) / 1.35, 0.0, 1.0);
  float left = lightLeft(p + 0.8 * size * n);
  float key = round * round * seen * (0.25 + 0.75 * left);
  float high = 0.5 + 0.5 * dot(n, uUp);
  vec3 around = mix(uGround, uSky, high) * (0.6 + 0.4 * seen) * left;
  vec3 skin = base * base;
  vec3 light = skin * (around + key * uKey);
#ifdef PLAIN
  float shine = max(dot(n, normalize(uLamp + toEye)), 0.0);
  shine *= shine; shine *= shine; shine *= shine; shine *= shine;
  light += 0.14 * shine * left * uKey;
#else
  float shine = max(dot(n, normalize(uLamp + toEye)), 0.0);
  float shine2 = shine * shine, shine4 = shine2 * shine2, shine16 = shine4 * shine4;
  shine16 *= shine16;
  float shine64 = shine16 * shine16; shine64 *= shine64;
  float rim = 1.0 - max(dot(n, toEye), 0.0); rim *= rim * rim;
  light += (0.10 * shine16 + 0.16 * shine64) * seen * left * uKey
    + uSky * rim * high * seen * left * (0.10 + 0.25 * skin);
#endif
  light = light / (1.0 + 0.12 * light);
  return sqrt(light);
}
`;
