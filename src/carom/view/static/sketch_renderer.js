/** Draws a sheet of shapes with WebGL 2. It knows nothing of the page. */
import { Program } from "./program.js";
import { Order } from "./sketch_order.js";
import { SHAPE_WORDS } from "./sketch_protocol.js";
import { SKETCH_SHADERS } from "./sketch_shaders.js";

const BYTES = 4 * SHAPE_WORDS;
const VERTICES = { spheres: 14, faces: 14, lines: 4 };
/** Floats of the matrix by location, as the shaders declare them. */
const COLUMNS = [0, 1, 2, 3];

export class SketchRenderer {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", {
      alpha: false,
      antialias: true,
      powerPreference: "high-performance",
    });
    if (gl === null) throw new Error("this browser draws no WebGL 2; update it, or turn on its hardware acceleration");
    this.canvas = canvas;
    this.gl = gl;
    this.programs = {
      spheres: new Program(gl, SKETCH_SHADERS.spheres),
      faces: new Program(gl, SKETCH_SHADERS.faces),
      lines: new Program(gl, SKETCH_SHADERS.lines),
    };
    this.order = new Order();
    this.buffer = gl.createBuffer();
    this.layout = gl.createVertexArray();
    gl.bindVertexArray(this.layout);
    for (let location = 0; location < 8; location++) {
      gl.enableVertexAttribArray(location);
      gl.vertexAttribDivisor(location, 1);
    }
  }

  /**
   * @param {import("./sketch_protocol.js").Sheet} sheet
   * @param {{view: Float32Array, projection: Float32Array}} camera
   */
  draw(sheet, camera) {
    const { gl, order } = this;
    const { width, height } = this.canvas;
    const [red, green, blue] = sheet.background;
    gl.viewport(0, 0, width, height);
    gl.depthMask(true);
    gl.clearColor(red, green, blue, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const runs = order.arrange(sheet, camera.view);
    gl.bindVertexArray(this.layout);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(
      gl.ARRAY_BUFFER,
      order.numbers.subarray(0, SHAPE_WORDS * order.count),
      gl.STREAM_DRAW,
    );
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const common = {
      uView: camera.view,
      uProjection: camera.projection,
      uSize: [width, height],
      uPixels: height / sheet.height,
    };
    for (const { kind, solid, first, count } of runs) {
      const program = this.programs[kind];
      program.use();
      program.set({ ...common, uSolid: { int: Number(solid) } });
      gl.depthMask(solid);
      // Edges of what hides things: by samples, so that the order does not count.
      this.#enable(gl.SAMPLE_ALPHA_TO_COVERAGE, solid);
      this.#enable(gl.BLEND, !solid);
      this.#pointAt(first);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, VERTICES[kind], count);
    }
    gl.depthMask(true);
  }

  /** @param {number} what @param {boolean} on */
  #enable(what, on) {
    if (on) this.gl.enable(what);
    else this.gl.disable(what);
  }

  /** Let the attributes begin at an item. @param {number} first */
  #pointAt(first) {
    const { gl } = this;
    const start = BYTES * first;
    for (const column of COLUMNS) {
      gl.vertexAttribPointer(column, 3, gl.FLOAT, false, BYTES, start + 12 * column);
    }
    gl.vertexAttribPointer(4, 4, gl.UNSIGNED_BYTE, true, BYTES, start + 48);
    gl.vertexAttribPointer(5, 4, gl.UNSIGNED_BYTE, true, BYTES, start + 52);
    gl.vertexAttribPointer(6, 1, gl.FLOAT, false, BYTES, start + 56);
    gl.vertexAttribIPointer(7, 2, gl.UNSIGNED_SHORT, BYTES, start + 60);
  }
}
