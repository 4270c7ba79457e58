// Runs the motion of `glsl.js` on the graphics unit and that of `interpolation.js` here, over the
// same random keyframes; the worst differences. Evaluated in the page.
(async () => {
  const { MOTION } = await import("/glsl.js");
  const { motion } = await import("/interpolation.js");
  const STILL = 0x80000000;
  const N = 1000;
  const gl = document.createElement("canvas").getContext("webgl2");
  const program = gl.createProgram();
  const sources = [
    [gl.VERTEX_SHADER, `#version 300 es\nprecision highp float;\n${MOTION}
      out vec3 oX; out vec3 oV; out float oV2;
      void main() { oX = motion(oV, oV2); gl_Position = vec4(0, 0, 0, 1); }`],
    [gl.FRAGMENT_SHADER, "#version 300 es\nprecision highp float; out vec4 c; void main() { c = vec4(1); }"],
  ];
  for (const [kind, source] of sources) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.transformFeedbackVaryings(program, ["oX", "oV", "oV2"], gl.INTERLEAVED_ATTRIBS);
  gl.linkProgram(program);
  gl.useProgram(program);
  let seed = 7;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647 - 0.5;
  const vector = (size) => [Math.fround(size * random()), Math.fround(size * random()), Math.fround(size * random())];
  const worst = { cases: 0, place: 0, velocity: 0, energy: 0 };
  for (const [period, g] of [
    [[0, 0, 0], [0, 0, 0]],
    [[0, 0, 0], [0, -1, -9.75]],
    [[10, 8, 12], [0, 0, 0]],
    [[10, 10, 0], [0, 0, -2]],
  ]) {
    const [h, s] = [0.5, 0.1875];
    const [x0, v0, x1, v1, c0, c1] = [[], [], [], [], [], []];
    const cases = [];
    for (let i = 0; i < N; i++) {
      const hits = i % 4; // 3: two hits, but of a resting sphere that woke
      const v = vector(4);
      const w = hits === 0 ? v.map((part, k) => part + g[k] * h) : vector(4);
      const x = vector(8);
      const when = h * (random() + 0.5);
      const free = (from, speed, t) => from.map((part, k) => part + speed[k] * t + 0.5 * g[k] * t * t);
      const late = w.map((part, k) => part - g[k] * h); // as if it had flown so from the start
      const hit = free(x, v, when);
      const start = hit.map((part, k) => part - late[k] * when - 0.5 * g[k] * when * when);
      const end = free(start, late, h).map((part, k) => Math.fround(
        period[k] > 0 ? part - period[k] * Math.round(part / period[k]) : part));
      // Counts run over the end of 31 bits.
      const a = { x, v, count: hits === 3 ? STILL : 0x7ffffffe };
      const total = hits === 3 ? 2 : (0x7ffffffe + hits) & 0x7fffffff;
      const b = { x: end, v: w.map(Math.fround), count: total };
      cases.push([a, b]);
      x0.push(...a.x); v0.push(...a.v); x1.push(...b.x); v1.push(...b.v);
      c0.push(a.count); c1.push(b.count);
    }
    for (const [name, values] of Object.entries({ aX0: x0, aV0: v0, aX1: x1, aV1: v1 })) {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
      const at = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 0, 0);
    }
    for (const [name, values] of Object.entries({ aC0: c0, aC1: c1 })) {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, new Uint32Array(values), gl.STATIC_DRAW);
      const at = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribIPointer(at, 1, gl.UNSIGNED_INT, 0, 0);
    }
    const at = (name) => gl.getUniformLocation(program, name);
    gl.uniform1f(at("uS"), s);
    gl.uniform1f(at("uH"), h);
    gl.uniform3fv(at("uG"), g);
    gl.uniform3fv(at("uPeriod"), period);
    gl.uniform3fv(at("uPerPeriod"), period.map((part) => (part > 0 ? 1 / part : 0)));
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    const out = gl.createBuffer();
    gl.bindBuffer(gl.TRANSFORM_FEEDBACK_BUFFER, out);
    gl.bufferData(gl.TRANSFORM_FEEDBACK_BUFFER, 28 * N, gl.STREAM_READ);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, out);
    gl.enable(gl.RASTERIZER_DISCARD);
    gl.beginTransformFeedback(gl.POINTS);
    gl.drawArrays(gl.POINTS, 0, N);
    gl.endTransformFeedback();
    const got = new Float32Array(7 * N);
    gl.getBufferSubData(gl.TRANSFORM_FEEDBACK_BUFFER, 0, got);
    cases.forEach(([a, b], i) => {
      const { x, v, v2 } = motion(a, b, s, h, g, period);
      const off = x.map((part, k) => {
        const gap = Math.abs(part - got[7 * i + k]);
        return period[k] > 0 ? Math.min(gap, Math.abs(period[k] - gap)) : gap;
      });
      worst.place = Math.max(worst.place, ...off);
      const turned = v.map((part, k) => Math.abs(part - got[7 * i + 3 + k]));
      worst.velocity = Math.max(worst.velocity, ...turned);
      worst.energy = Math.max(worst.energy, Math.abs(v2 - got[7 * i + 6]));
      worst.cases++;
    });
  }
  return worst;
})()
