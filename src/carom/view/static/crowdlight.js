/**
 * The light left among the spheres, as a texture that shaders look up.
 *
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 */
import { Crowd, cover } from "./crowd.js";
import { product } from "./stack.js";

const CROWDED = 0.5; // spheres on a ray's way, from which a crowd is looked for

export class CrowdLight {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.texture = gl.createTexture();
    /** @type {Crowd | null} */ this.crowd = null;
    /** @type {Keyframe | null} */ this.filled = null;
    this.cover = 0;
  }

  /** @param {Scene} scene @param {number[]} low @param {number[]} high @param {number} typical radius */
  start(scene, low, high, typical) {
    const size = [0, 1, 2].map((k) => high[k] - low[k]);
    this.cover = cover(scene.radius, size);
    this.crowd = this.cover > CROWDED ? new Crowd(low, high, typical) : null;
    this.filled = null;
  }

  /**
   * Uniforms to look it up, or nothing.
   * @param {Keyframe} keyframe @param {Scene} scene @param {number[]} up @param {Float32Array} eyeToWorld
   * @returns {import("./program.js").Uniforms}
   */
  uniforms(keyframe, scene, up, eyeToWorld) {
    const { gl, crowd } = this;
    if (crowd === null) return {};
    gl.activeTexture(gl.TEXTURE2);
    gl.bindTexture(gl.TEXTURE_3D, this.texture);
    if (this.filled !== keyframe) {
      this.filled = keyframe;
      const axis = up.reduce((best, part, k) => (Math.abs(part) > Math.abs(up[best]) ? k : best), 0);
      crowd.fill(keyframe.position, scene.radius, axis, Math.sign(up[axis]));
      const [x, y, z] = crowd.cells;
      gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
      gl.texImage3D(gl.TEXTURE_3D, 0, gl.R8, x, y, z, 0, gl.RED, gl.UNSIGNED_BYTE, crowd.bytes);
      gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
      for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) {
        gl.texParameteri(gl.TEXTURE_3D, wrap, gl.CLAMP_TO_EDGE);
      }
    }
    gl.activeTexture(gl.TEXTURE0);
    const [a, b, c] = crowd.size;
    const [x, y, z] = crowd.low;
    // prettier-ignore
    const toCells = [1 / a, 0, 0, 0, 0, 1 / b, 0, 0, 0, 0, 1 / c, 0, -x / a, -y / b, -z / c, 1];
    return { uCrowd: { int: 2 }, uToCrowd: product(toCells, eyeToWorld) };
  }
}
