/**
 * Where pictures are drawn: straight into the canvas, or into a buffer with several samples per
 * pixel that is then averaged into it. So samples can be had or not without a new context.
 */

export class Frame {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.most = gl.getParameter(gl.MAX_SAMPLES);
    this.buffer = gl.createFramebuffer();
    this.color = gl.createRenderbuffer();
    this.depth = gl.createRenderbuffer();
    this.made = ""; // which size and samples the buffers have
    /** Formats the canvas may have; the first that can be copied to it is kept. */
    this.formats = [gl.RGB8, gl.RGBA8];
    this.sampled = false; // is the picture being drawn in the buffer?
  }

  /** How many samples a pixel can have. @param {number} wanted */
  samples(wanted) {
    return this.formats.length > 0 ? Math.min(wanted, this.most) : 0;
  }

  /** Draw from now on into this picture. @param {number} samples per pixel, 0 or several */
  begin(samples) {
    const { gl } = this;
    this.sampled = this.samples(samples) > 1;
    if (this.sampled) this.#make(this.samples(samples));
    this.bind();
  }

  /** Come back to the picture, after drawing elsewhere. */
  bind() {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.sampled ? this.buffer : null);
  }

  /** Put the picture on the canvas. */
  end() {
    if (!this.sampled) return;
    const { gl } = this;
    const { width, height } = gl.canvas;
    gl.disable(gl.SCISSOR_TEST);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.buffer);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.invalidateFramebuffer(gl.READ_FRAMEBUFFER, [gl.COLOR_ATTACHMENT0, gl.DEPTH_ATTACHMENT]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** @param {number} samples */
  #make(samples) {
    const { gl } = this;
    const { width, height } = gl.canvas;
    const key = `${width} ${height} ${samples}`;
    if (key === this.made) return;
    this.made = key;
    while (this.formats.length > 0) {
      this.#allocate(samples, width, height);
      if (this.formats.length === 1 || this.#works()) return;
      this.formats.shift();
    }
  }

  /** @param {number} samples @param {number} width @param {number} height */
  #allocate(samples, width, height) {
    const { gl } = this;
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.color);
    gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, this.formats[0], width, height);
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.depth);
    gl.renderbufferStorageMultisample(
      gl.RENDERBUFFER, samples, gl.DEPTH_COMPONENT24, width, height,
    ); // prettier-ignore
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffer);
    const { FRAMEBUFFER, RENDERBUFFER } = gl;
    gl.framebufferRenderbuffer(FRAMEBUFFER, gl.COLOR_ATTACHMENT0, RENDERBUFFER, this.color);
    gl.framebufferRenderbuffer(FRAMEBUFFER, gl.DEPTH_ATTACHMENT, RENDERBUFFER, this.depth);
  }

  /** Browsers differ in the canvas's own format, and samples need the same: try once. */
  #works() {
    const { gl } = this;
    while (gl.getError() !== gl.NO_ERROR);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.buffer);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, 1, 1, 0, 0, 1, 1, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    return gl.getError() === gl.NO_ERROR;
  }
}
