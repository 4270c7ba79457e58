/**
 * A compiled pair of shaders with its uniforms and attributes by name.
 * @typedef {number | number[] | Float32Array | {int: number} | {list: number[]}} Uniform
 * @typedef {Record<string, Uniform>} Uniforms
 */

/** Before every shader. */
export const HEAD = `#version 300 es
precision highp float;
precision highp int;
`;

/** Shaders by name, each compiled when it is first wanted, in the variants that are wanted. */
export class Programs {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {Record<string, [string, string]>} sources vertex and fragment, without HEAD
   */
  constructor(gl, sources) {
    this.gl = gl;
    this.sources = sources;
    /** @type {Map<string, Program>} */ this.made = new Map();
  }

  /** @param {string} name @param {Record<string, boolean>} defines what the shader may ask with #ifdef */
  get(name, defines = {}) {
    let head = HEAD;
    for (const define in defines) if (defines[define]) head += `#define ${define}\n`;
    const key = name + head;
    let program = this.made.get(key);
    if (program === undefined) {
      const [vertex, fragment] = this.sources[name];
      program = new Program(this.gl, [head + vertex, head + fragment]);
      this.made.set(key, program);
    }
    return program;
  }
}

export class Program {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {[string, string]} sources vertex and fragment
   */
  constructor(gl, [vertex, fragment]) {
    this.gl = gl;
    const program = gl.createProgram();
    for (const [kind, source] of /** @type {[number, string][]} */ ([
      [gl.VERTEX_SHADER, vertex],
      [gl.FRAGMENT_SHADER, fragment],
    ])) {
      const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    this.program = program;
    /** @type {Map<string, WebGLUniformLocation | null>} */
    this.locations = new Map();
  }

  /** Start using it; the first time, wait for the compiler and read its complaints. */
  use() {
    const { gl, program } = this;
    if (this.checked !== true) {
      if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
        const logs = (gl.getAttachedShaders(program) ?? []).map((s) => gl.getShaderInfoLog(s));
        throw new Error(`a shader does not compile: ${gl.getProgramInfoLog(program)} ${logs}`);
      }
      this.checked = true;
    }
    gl.useProgram(program);
  }

  /**
   * Set uniforms by name: numbers, vectors as arrays, 4 × 4 matrices as Float32Array(16),
   * whole numbers as {int: number}, lists of 3-vectors as {list: number[]}.
   * @param {Uniforms} values
   */
  set(values) {
    const { gl } = this;
    for (const name in values) {
      const value = values[name];
      if (!this.locations.has(name)) {
        this.locations.set(name, gl.getUniformLocation(this.program, name));
      }
      const location = this.locations.get(name) ?? null;
      if (location === null) continue; // the compiler drops what a shader does not use
      if (typeof value === "number") gl.uniform1f(location, value);
      else if (value instanceof Float32Array) gl.uniformMatrix4fv(location, false, value);
      else if (Array.isArray(value)) {
        if (value.length === 2) gl.uniform2fv(location, value);
        else if (value.length === 3) gl.uniform3fv(location, value);
        else gl.uniform4fv(location, value);
      } else if ("int" in value) gl.uniform1i(location, value.int);
      else gl.uniform3fv(location, value.list);
    }
  }
}
