/** From where a scene is seen when nobody has moved the camera. */
import { dot } from "./matrix.js";

const [AZIMUTH, HEIGHT] = [-0.42, 0.3]; // radians: two walls and the floor are seen

/**
 * How much wider than deep it is: the long side of a long box is seen more from the front.
 * @param {import("./matrix.js").Vec3[]} points @param {import("./matrix.js").Vec3[]} compass forward, right
 */
function slenderness(points, compass) {
  const [deep, wide] = compass.map((axis) => {
    const along = points.map((point) => dot(point, axis));
    return Math.max(...along) - Math.min(...along);
  });
  return wide > 0 && deep > 0 ? wide / deep : 1;
}

/**
 * @param {import("./camera.js").Camera} camera
 * @param {Pick<import("./walls.js").Walls, "bounds" | "faces">} walls
 * @param {import("./protocol.js").About} about
 */
export function standBack(camera, { bounds, faces }, about) {
  camera.azimuth = AZIMUTH / Math.max(1, Math.sqrt(slenderness(bounds.points, camera.compass)));
  camera.height = HEIGHT;
  // From the gas's side of a plane that stands alone.
  const behind = faces.some((face) => face.fade > 0 && dot(face.normal, camera.axes.back) < 0);
  if (behind) camera.azimuth *= -1;
  camera.fit(bounds);
  if (about.camera === null) return;
  /** @typedef {[number, number, number]} Vec3 */
  const { position, target } = about.camera;
  camera.look(/** @type {Vec3} */ (position), /** @type {Vec3} */ (target));
}
