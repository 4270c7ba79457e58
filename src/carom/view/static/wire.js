// Made by carom/view/wire.py, which explains it; a test compares the two.
export const MAGIC = 1330790723;
export const VERSION = 3;
export const SOCKET_PATH = "/live";
export const FRAME = 1;
export const SCENE = 2;
export const SKETCH = 3;
export const PLAYING = 1;
export const FAILED = 2;
export const TWIN = 4;
export const REVERSED = 8;
export const STILL = 2147483648;
export const MAX_CREDITS = 4;
export const SLOWEST = 0.001;
export const FASTEST = 100;
export const WRONG_TOKEN = 4001;
export const SCENE_HEADER_BYTES = 24;
export const FRAME_HEADER_BYTES = 192;
export const SPHERE_BYTES = 28;
export const REEL_FORMAT = 3;
export const REEL_COLUMNS = ["t", "gravity_x", "gravity_y", "gravity_z", "kinetic", "potential", "dissipated", "drift", "collisions", "wall_collisions", "momentum_x", "momentum_y", "momentum_z", "temperature", "full_energy", "full_speed"];
/** Where each number of a message's header stands, in bytes. */
export const AT = {
  magic: 0,
  version: 4,
  kind: 6,
  n: 8,
  epoch: 12,
  flags: 16,
  scene: 20,
  t: 24,
  clock: 32,
  gravity_x: 40,
  gravity_y: 48,
  gravity_z: 56,
  kinetic: 64,
  potential: 72,
  dissipated: 80,
  drift: 88,
  collisions: 96,
  wall_collisions: 104,
  speed: 112,
  reached: 120,
  momentum_x: 128,
  momentum_y: 136,
  momentum_z: 144,
  temperature: 152,
  missed: 160,
  overlap: 168,
  full_energy: 176,
  full_speed: 184,
};
/** The keys of each operation a page may ask for, besides `op`. */
export const OPERATIONS = {
  hello: ["token", "version"],
  credit: ["count"],
  play: [],
  pause: [],
  speed: ["value"],
  restart: [],
  step: [],
  back: [],
  reverse: [],
  rule: ["restitution"],
  walls: ["restitution"],
  gravity: ["value"],
  scene: ["name", "options"],
  add: ["position", "velocity", "radius", "mass", "color"],
  remove: ["index"],
  push: ["index", "velocity"],
  compare: ["on"],
  source: [],
};
