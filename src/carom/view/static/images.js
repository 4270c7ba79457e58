/**
 * Spheres that reach over the border of a periodic box are seen on both sides. Which do is
 * looked up when a pair of keyframes comes, so that only those few are drawn again.
 *
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 */

const WORDS = 18; // per image: two keyframes of 7, radius, mass, colour, bits

export class Images {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.buffer = gl.createBuffer();
    this.count = 0;
    this.floats = new Float32Array(64 * WORDS);
    this.words = new Uint32Array(this.floats.buffer);
    /** @type {Map<number, WebGLVertexArrayObject>} */ this.arrays = new Map(); // by divisor
  }

  /**
   * Find the images that may be seen between two keyframes.
   * @param {Keyframe} first @param {Keyframe} second @param {Scene} scene
   * @param {Uint32Array} traits three words per sphere: radius, mass, colour
   */
  set(first, second, scene, traits) {
    const { period } = scene.about;
    this.count = 0;
    if (!period.some((length) => length > 0)) return;
    const h = second.t - first.t;
    for (let i = 0; i < scene.n; i++) {
      let near = 0;
      for (let k = 0; k < 3; k++) {
        if (!(period[k] > 0)) continue;
        const reach = 0.5 * period[k] - scene.radius[i];
        const j = 3 * i + k;
        const way = h * Math.max(Math.abs(first.velocity[j]), Math.abs(second.velocity[j]));
        const out = Math.max(Math.abs(first.position[j]), Math.abs(second.position[j])) + way;
        if (out > reach) near |= 1 << k;
      }
      // Every set of these borders has an image behind it.
      for (let bits = near; bits > 0; bits = (bits - 1) & near) {
        this.#add(first, second, traits, i, bits);
      }
    }
    const { gl } = this;
    gl.bindVertexArray(null);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, this.floats.subarray(0, WORDS * this.count), gl.STREAM_DRAW);
  }

  /**
   * @param {Keyframe} first @param {Keyframe} second @param {Uint32Array} traits
   * @param {number} i @param {number} bits axes whose border it is across
   */
  #add(first, second, traits, i, bits) {
    let at = WORDS * this.count++;
    if (at + WORDS > this.floats.length) {
      const larger = new Float32Array(2 * this.floats.length);
      larger.set(this.floats);
      this.floats = larger;
      this.words = new Uint32Array(larger.buffer);
    }
    const { floats, words } = this;
    for (const keyframe of [first, second]) {
      for (let k = 3 * i; k < 3 * i + 3; k++) {
        floats[at] = keyframe.position[k];
        floats[at + 3] = keyframe.velocity[k];
        at++;
      }
      words[at + 3] = keyframe.counts[i];
      at += 4;
    }
    for (let k = 0; k < 3; k++) words[at + k] = traits[3 * i + k];
    words[at + 3] = bits;
  }

  /** Make the attributes current. @param {0 | 1} divisor */
  bind(divisor) {
    const { gl } = this;
    let array = this.arrays.get(divisor);
    if (array !== undefined) {
      gl.bindVertexArray(array);
      return;
    }
    array = gl.createVertexArray();
    this.arrays.set(divisor, array);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    const stride = 4 * WORDS;
    for (const [at, word] of [[0, 0], [1, 3], [2, 7], [3, 10]]) {
      gl.vertexAttribPointer(at, 3, gl.FLOAT, false, stride, 4 * word);
    }
    gl.vertexAttribIPointer(4, 1, gl.UNSIGNED_INT, stride, 4 * 6);
    gl.vertexAttribIPointer(5, 1, gl.UNSIGNED_INT, stride, 4 * 13);
    gl.vertexAttribPointer(6, 1, gl.FLOAT, false, stride, 4 * 14);
    gl.vertexAttribPointer(7, 1, gl.FLOAT, false, stride, 4 * 15);
    gl.vertexAttribPointer(8, 4, gl.UNSIGNED_BYTE, true, stride, 4 * 16);
    gl.vertexAttribIPointer(9, 1, gl.UNSIGNED_INT, stride, 4 * 17);
    for (let at = 0; at < 10; at++) {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribDivisor(at, divisor);
    }
  }
}
