/** Ties the parts of the page together. */
import { Camera } from "./camera.js";
import { Connection, takeToken } from "./connection.js";
import { Controls } from "./controls.js";
import { attachPointers } from "./gestures.js";
import { drawLegend } from "./legend.js";
import { dot } from "./matrix.js";
import { say } from "./protocol.js";
import { Readout } from "./readout.js";
import { Renderer } from "./renderer.js";
import { Timeline } from "./timeline.js";

const NARROW = matchMedia("(max-width: 720px)");
const LIGHT = matchMedia("(prefers-color-scheme: light)");

/** @param {string} id */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

class Page {
  constructor() {
    this.canvas = /** @type {HTMLCanvasElement} */ (at("view"));
    this.renderer = new Renderer(this.canvas);
    this.camera = new Camera();
    this.timeline = new Timeline();
    this.readout = new Readout();
    /** @type {import("./protocol.js").Scene | null} */ this.scene = null;
    /** @type {import("./renderer.js").Options} */
    this.options = {
      color: "energy",
      full: 1,
      wire: false,
      theme: LIGHT.matches ? "light" : "dark",
      arrows: false,
    };
    /** @type {[import("./protocol.js").Keyframe, import("./protocol.js").Keyframe] | null} */
    this.pair = null;
    this.stale = true; // something other than time and camera has changed
    this.drawn = { t: NaN, camera: -1 };
    this.before = performance.now();
    this.controls = new Controls(this.#wishes(), this.camera);
    this.connection = new Connection(takeToken(), {
      scene: (scene) => this.#setScene(scene),
      frame: (frame) => this.#take(frame),
      note: (key, value) => {
        if (key === "failure") this.#say("failure", /** @type {string} */ (value));
      },
      state: (state, sentence) => this.#state(state, sentence),
    });
    attachPointers(this.canvas, this.camera);
    this.controls.openPanel(!NARROW.matches);
    new ResizeObserver(() => this.#resize()).observe(this.canvas);
    NARROW.addEventListener("change", () => this.controls.openPanel(!NARROW.matches));
    LIGHT.addEventListener("change", () => {
      this.options.theme = LIGHT.matches ? "light" : "dark";
      this.stale = true;
    });
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => location.reload());
    this.#resize();
    requestAnimationFrame((now) => this.#tick(now));
  }

  /** @returns {import("./controls.js").Wishes} */
  #wishes() {
    return {
      toggle: () => {
        const playing = this.timeline.newest?.playing ?? true;
        this.connection.send(playing ? say.pause() : say.play());
      },
      restart: () => this.connection.send(say.restart()),
      speed: (value) => this.connection.send(say.speed(value)),
      color: (mode) => this.#setColor(/** @type {import("./renderer.js").ColorMode} */ (mode)),
      wire: (wire) => this.#setWire(wire),
      fit: () => this.#fit(),
      panel: () => this.#resize(),
    };
  }

  /** @param {import("./protocol.js").Scene} scene */
  #setScene(scene) {
    const before = this.scene;
    this.scene = scene;
    this.renderer.setScene(scene);
    this.pair = null;
    this.timeline.clear();
    const { about } = scene;
    // After a restart the same scene comes again: what people chose stays.
    const same =
      before !== null &&
      before.n === scene.n &&
      JSON.stringify(before.about) === JSON.stringify(about);
    if (!same) {
      const title = about.title || "carom";
      at("title").textContent = title;
      document.title = title === "carom" ? title : `${title} · carom`;
      at("view").setAttribute("aria-label", `${title}: ${scene.n} spheres in three dimensions`);
      at("choose-species").hidden = new Set(scene.species).size < 2;
      this.camera.stand(/** @type {[number, number, number]} */ (about.gravity));
      this.#setColor(about.color);
      this.#setWire(about.wire);
      this.#fit();
    }
    this.stale = true;
  }

  /** @param {import("./protocol.js").Keyframe} frame */
  #take(frame) {
    if (frame.scene !== this.scene?.number) return;
    this.timeline.push(frame);
    this.readout.push(frame);
    this.controls.follow(frame);
  }

  /** Look at everything, the way the scene asks for. */
  #fit() {
    if (this.scene === null) return;
    const { camera } = this.scene.about;
    const { bounds, faces } = this.renderer.walls;
    this.camera.azimuth = -0.42;
    this.camera.height = 0.3;
    // From the gas's side of a plane that stands alone.
    const behind = faces.some((face) => face.fade > 0 && dot(face.normal, this.camera.axes.back) < 0);
    if (behind) this.camera.azimuth *= -1;
    this.camera.fit(bounds);
    if (camera !== null) {
      /** @typedef {[number, number, number]} Vec3 */
      this.camera.look(/** @type {Vec3} */ (camera.position), /** @type {Vec3} */ (camera.target));
    }
  }

  /** @param {import("./renderer.js").ColorMode} mode */
  #setColor(mode) {
    this.options.color = mode;
    const about = this.scene?.about;
    this.options.full = (mode === "speed" ? about?.full_speed : about?.full_energy) ?? 1;
    this.controls.markColor(mode);
    if (this.scene !== null) drawLegend(at("legend"), mode, this.scene);
    this.stale = true;
  }

  /** @param {boolean} wire */
  #setWire(wire) {
    this.options.wire = wire;
    this.controls.markWire(wire);
    this.stale = true;
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    const panel = at("panel");
    const bar = at("bar").getBoundingClientRect();
    const below = NARROW.matches && !panel.hidden ? panel.getBoundingClientRect() : bar;
    this.camera.resize(width, height, {
      left: 0,
      right: NARROW.matches || panel.hidden ? 0 : width - panel.getBoundingClientRect().left,
      top: NARROW.matches ? at("heading").getBoundingClientRect().bottom : 0,
      bottom: height - below.top,
    });
    if (!this.camera.moved) this.#fit();
    this.stale = true;
  }

  /** @param {"open" | "waiting" | "refused"} state @param {string} sentence */
  #state(state, sentence) {
    document.body.dataset.connection = state;
    this.#say("connection", sentence);
    if (state !== "open") this.timeline.clear();
  }

  /** @param {string} id @param {string} sentence */
  #say(id, sentence) {
    at(id).textContent = sentence;
    at(id).hidden = sentence === "";
  }

  /** @param {number} now */
  #tick(now) {
    requestAnimationFrame((next) => this.#tick(next));
    const seconds = Math.min(0.25, (now - this.before) / 1000);
    this.before = now;
    const pair = this.timeline.advance(seconds);
    this.connection.returnCredit();
    if (pair !== null) {
      this.pair = pair;
      this.readout.show(this.timeline.t, now);
    }
    if (this.pair === null) return;
    const { t } = this.timeline;
    const { version } = this.camera;
    if (!this.stale && t === this.drawn.t && version === this.drawn.camera) return;
    const [first, second] = this.pair;
    const viewport = { x: 0, y: 0, ...this.camera.size };
    this.renderer.draw({
      sides: [{ first, second, t, viewport }],
      camera: this.camera,
      options: this.options,
      marks: [],
      arrows: [],
      trails: [],
      ghost: null,
    });
    this.drawn = { t, camera: version };
    this.stale = false;
  }
}

try {
  // For the browser's console: everything on the page hangs on this one name.
  /** @type {any} */ (globalThis).carom = new Page();
} catch (error) {
  const place = at("connection");
  place.textContent = `The view cannot start: ${/** @type {Error} */ (error).message}.`;
  place.hidden = false;
  throw error;
}
