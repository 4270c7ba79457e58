// Draws one picture with a renderer of its own, away from the page's; evaluated in the page.
// The answer: the picture as a PNG and where the camera stands.
async (spec) => {
  const { Renderer } = await import("/renderer.js");
  const { Camera } = await import("/camera.js");
  const [width, height] = [480, 360];
  const n = spec.x[0].length / 3;
  const about = {
    period: [0, 0, 0], gravity: [0, 0, 0], walls: [], low: [-4, -4, -4], high: [4, 4, 4],
    full_energy: 1, full_speed: 2, collide: true, wire: false, color: "own", camera: null,
    ...spec.about,
  };
  const scene = {
    number: 1, n, about,
    radius: Float32Array.from(spec.radius), mass: new Float32Array(n).fill(1),
    color: Uint32Array.from(spec.color), species: new Uint32Array(n),
  };
  const keyframes = spec.x.map((x, k) => {
    const raw = new ArrayBuffer(28 * n);
    const position = new Float32Array(raw, 0, 3 * n);
    const velocity = new Float32Array(raw, 12 * n, 3 * n);
    const counts = new Uint32Array(raw, 24 * n, n);
    position.set(x);
    if (spec.v) velocity.set(spec.v);
    if (spec.counts) counts.set(spec.counts);
    return { n, t: k, gravity: [0, 0, 0], spheres: new Uint8Array(raw), position, velocity, counts };
  });
  const canvas = document.createElement("canvas");
  const renderer = new Renderer(canvas);
  renderer.governor.force(spec.level ?? 3);
  renderer.setScene(scene);
  const camera = new Camera();
  const sides = spec.t ?? [0];
  camera.resize(width / sides.length, height, { left: 0, right: 0, top: 0, bottom: 0 });
  camera.stand(about.gravity);
  camera.fit(renderer.walls.bounds);
  if (spec.look) camera.look(...spec.look);
  const picture = {
    sides: sides.map((t, k) => ({
      first: keyframes[0],
      second: keyframes.at(-1),
      t,
      viewport: { x: (k * width) / sides.length, y: 0, width: width / sides.length, height },
    })),
    camera,
    options: { color: about.color, full: spec.full ?? 1, wire: about.wire, theme: spec.theme ?? "dark", arrows: spec.swarm ?? 0 },
    marks: spec.marks ?? [],
    arrows: spec.arrows ?? [],
    trails: (spec.trails ?? []).map((trail) => ({ ...trail, points: Float32Array.from(trail.points, (p) => p ?? NaN) })),
    ghost: spec.ghost ?? null,
  };
  renderer.draw(picture);
  const error = renderer.gl.getError();
  const png = canvas.toDataURL("image/png");
  let blob = null;
  if (spec.blob) {
    const made = await renderer.toBlob();
    blob = { type: made.type, bytes: [...new Uint8Array(await made.slice(0, 24).arrayBuffer())] };
  }
  renderer.gl.getExtension("WEBGL_lose_context")?.loseContext();
  return { png, error, blob, ratio: canvas.width / width, width: camera.size.width, height, eye: camera.eye, target: camera.target };
}
