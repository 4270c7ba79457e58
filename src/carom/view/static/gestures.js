/** Mouse, touch and keys that move the camera. */

const TURN = 0.0065; // radians per pixel
const KEY_TURN = 0.08; // radians per key
const KEY_PAN = 24; // pixels per key
const KEY_ZOOM = 1.12;

/**
 * @param {HTMLCanvasElement} canvas
 * @param {import("./camera.js").Camera} camera
 */
export function attachPointers(canvas, camera) {
  /** @type {Map<number, {x: number, y: number}>} */
  const down = new Map();
  const spread = () => {
    const [a, b] = [...down.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, d: Math.hypot(a.x - b.x, a.y - b.y) };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = down.get(event.pointerId);
    if (last === undefined) return;
    const place = { x: event.clientX, y: event.clientY };
    if (down.size === 2) {
      const before = spread();
      down.set(event.pointerId, place);
      const after = spread();
      camera.pan(after.x - before.x, after.y - before.y);
      if (before.d > 0 && after.d > 0) camera.zoom(before.d / after.d);
      return;
    }
    down.set(event.pointerId, place);
    const [x, y] = [place.x - last.x, place.y - last.y];
    if (event.buttons & 6 || event.shiftKey) camera.pan(x, y);
    else camera.turn(x * TURN, y * TURN);
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) =>
      down.delete(/** @type {PointerEvent} */ (event).pointerId),
    );
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const pixels = event.deltaY * [1, 30, 300][event.deltaMode];
      camera.zoom(Math.exp(Math.max(-240, Math.min(240, pixels)) * 0.0016));
    },
    { passive: false },
  );
}

/**
 * Move the camera by a key; false if the key is none of its own.
 * @param {KeyboardEvent} event @param {import("./camera.js").Camera} camera
 */
export function cameraKey(event, camera) {
  const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[
    event.key
  ];
  if (arrow !== undefined) {
    const [x, y] = arrow;
    if (event.shiftKey) camera.pan(-x * KEY_PAN, -y * KEY_PAN);
    else camera.turn(x * KEY_TURN, -y * KEY_TURN);
    return true;
  }
  if (event.key === "+" || event.key === "=") camera.zoom(1 / KEY_ZOOM);
  else if (event.key === "-" || event.key === "_") camera.zoom(KEY_ZOOM);
  else return false;
  return true;
}
