/** Ties the parts of the page together. */
import { Camera } from "./camera.js";
import { Connection, takeToken } from "./connection.js";
import { Controls, announce } from "./controls.js";
import { at, put } from "./dom.js";
import { Gallery } from "./gallery.js";
import { attachPointers, cameraKey } from "./gestures.js";
import { Help } from "./help.js";
import { listen } from "./keys.js";
import { layout } from "./layout.js";
import { drawLegend, fullOf } from "./legend.js";
import { readLink, runsAlready } from "./link.js";
import { dot } from "./matrix.js";
import { Parameters } from "./parameters.js";
import { say } from "./protocol.js";
import { Readout } from "./readout.js";
import { Renderer } from "./renderer.js";
import { keepSections } from "./sections.js";
import { SettingsPanel } from "./settings.js";
import { Share } from "./share.js";
import { Comparison, around } from "./split.js";
import { Theme } from "./theme.js";
import { Timeline } from "./timeline.js";
import { toast } from "./toast.js";

/**
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./protocol.js").ColorMode} ColorMode
 * @typedef {import("./protocol.js").Notes} Notes
 */

const FINEST = 2; // pixels of the picture per pixel of the page
const SLOWLY = 250; // milliseconds between looks at what changes slowly
const NARROW = matchMedia("(max-width: 720px)");

class Page {
  constructor() {
    this.canvas = /** @type {HTMLCanvasElement} */ (at("view"));
    this.renderer = new Renderer(this.canvas);
    this.camera = new Camera();
    this.timeline = new Timeline();
    this.twin = new Timeline();
    this.readout = new Readout();
    /** @type {Scene | null} */ this.scene = null;
    /** @type {Notes["settings"] | null} */ this.settings = null;
    this.options = { color: /** @type {ColorMode} */ ("energy"), full: 1, wire: false };
    /** @type {import("./split.js").Viewport[]} */ this.viewports = [];
    this.stale = true; // something other than time and camera has changed
    this.drawn = { t: NaN, camera: -1 };
    this.before = performance.now();
    this.looked = -Infinity; // when slow things were last looked at
    this.wanted = readLink(location.hash); // the scene that the address asks for
    const token = takeToken();
    this.theme = new Theme(() => (this.stale = true));
    this.actions = this.#actions();
    this.controls = new Controls(this.actions, this.#wishes());
    this.#parts(token);
    this.#watch();
    this.connection = new Connection(token, {
      scene: (scene) => this.#setScene(scene),
      frame: (frame) => this.#take(frame),
      note: (key, value) => this.#hear({ [key]: value }),
      state: (state, sentence) => this.#state(state, sentence),
    });
    requestAnimationFrame((now) => this.#tick(now));
  }

  /** @param {string} token */
  #parts(token) {
    const send = (/** @type {string} */ message) => this.connection.send(message);
    this.gallery = new Gallery((name) => send(say.scene(name, {})));
    this.help = new Help();
    this.share = new Share({
      token,
      picture: () => this.renderer.toBlob(),
      askSource: () => send(say.source()),
    });
    this.parameters = new Parameters((name, options) => send(say.scene(name, options)));
    this.settingsPanel = new SettingsPanel(send, this.camera);
    this.comparison = new Comparison();
    attachPointers(this.canvas, this.camera);
  }

  /** Listen to the window. */
  #watch() {
    listen(this.actions, () => false, (event) => cameraKey(event, this.camera));
    keepSections(at("panel"));
    const arrange = () => {
      at(NARROW.matches ? "panel-top" : "actions").prepend(at("extras"));
      this.controls.openPanel(!NARROW.matches);
    };
    arrange();
    NARROW.addEventListener("change", arrange);
    new ResizeObserver(() => this.#resize()).observe(this.canvas);
    document.addEventListener("fullscreenchange", () => {
      const full = document.fullscreenElement !== null;
      at("fullscreen").setAttribute("aria-pressed", String(full));
    });
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => location.reload());
  }

  /** @returns {import("./keys.js").Actions} */
  #actions() {
    const send = (/** @type {string} */ message) => this.connection.send(message);
    return {
      toggle: () => send(this.timeline.newest?.playing === false ? say.play() : say.pause()),
      step: () => send(say.step()),
      back: () => send(say.back()),
      restart: () => send(say.restart()),
      reverse: () => send(say.reverse()),
      slower: () => this.controls.shift(-1),
      faster: () => this.controls.shift(1),
      normal: () => this.controls.ask(1),
      wire: () => this.#setWire(!this.options.wire),
      nextColor: () => this.#setColor(/** @type {ColorMode} */ (this.controls.colorAfter(this.options.color))),
      fit: () => this.#fit(),
      compare: () => send(say.compare(!this.settings?.comparing)),
      fullscreen: () => void toggleFullScreen(),
      gallery: () => void this.gallery.open(this.scene?.about.origin?.name ?? null),
      panel: () => this.controls.openPanel(at("panel").hidden),
      settings: () => this.#openSettings(),
      share: () => this.share.open(this.scene?.about.title || "carom", this.scene?.about.origin ?? null),
      theme: () => this.#nextTheme(),
      help: () => this.help.open(),
      leave: () => this.#leave(),
    };
  }

  /** @returns {import("./controls.js").Wishes} */
  #wishes() {
    return {
      speed: (value) => this.connection.send(say.speed(value)),
      color: (mode) => this.#setColor(/** @type {ColorMode} */ (mode)),
      wire: (wire) => this.#setWire(wire),
      layout: () => this.#resize(),
    };
  }

  #openSettings() {
    this.controls.openPanel(true);
    const section = /** @type {HTMLDetailsElement} */ (at("section-settings"));
    section.open = true;
    section.querySelector("input")?.focus();
  }

  #nextTheme() {
    this.theme.next();
    const { choice } = this.theme;
    toast(choice === "auto" ? "Dark or light as your system is." : `Always ${choice}.`);
  }

  /** Escape, when nothing is selected. */
  #leave() {
    if (this.settings?.comparing) this.actions.compare();
    else if (NARROW.matches) this.controls.openPanel(false);
    this.canvas.focus({ preventScroll: true });
  }

  /** @param {Scene} scene */
  #setScene(scene) {
    const before = this.scene;
    this.scene = scene;
    this.renderer.setScene(scene);
    this.timeline.clear();
    this.twin.clear();
    const { about } = scene;
    const fresh = before === null || before.about.key !== about.key;
    // Another number of balls in the same scene is no reason to change its colours.
    const other = fresh && (about.origin === null || before?.about.origin?.name !== about.origin.name);
    if (fresh) this.camera.stand(/** @type {[number, number, number]} */ (about.gravity));
    const title = about.title || "carom";
    put(at("title"), title);
    document.title = title === "carom" ? title : `${title} · carom`;
    at("view").setAttribute("aria-label", `${title}: ${scene.n} spheres in three dimensions`);
    at("choose-species").hidden = new Set(scene.species).size < 2;
    this.parameters.setOrigin(about.origin);
    this.settingsPanel.setScene(scene, fresh);
    if (other) this.#setWire(about.wire);
    this.#setColor(other ? about.color : this.options.color);
    if (other || (fresh && !this.camera.moved)) this.#fit();
    this.#obeyAddress();
    this.stale = true;
  }

  /** @param {Keyframe} frame */
  #take(frame) {
    if (frame.scene !== this.scene?.number) return;
    if (frame.twin) {
      this.twin.push(frame);
      return;
    }
    this.timeline.push(frame);
    this.readout.push(frame);
    this.controls.follow(frame);
  }

  /** @param {Partial<Notes>} note with one key */
  #hear(note) {
    if (note.failure !== undefined) this.#say("failure", note.failure);
    if (note.settings !== undefined) this.#setSettings(note.settings);
    if (note.source !== undefined) this.share.setSource(note.source);
    if (note.catalogue !== undefined) {
      this.gallery.setCatalogue(note.catalogue);
      this.parameters.setCatalogue(note.catalogue);
      this.#obeyAddress();
    }
    if (note.role !== undefined) document.body.dataset.role = note.role;
    if (note.refused !== undefined) {
      toast(note.refused);
      this.settingsPanel.revert();
      this.parameters.revert();
    }
  }

  /** Load the scene that the link asked for, once, unless it runs already. */
  #obeyAddress() {
    if (this.wanted === null || this.scene === null) return;
    const { wanted } = this;
    this.wanted = null;
    if (runsAlready(wanted, this.scene.about.origin)) return;
    this.connection.send(say.scene(wanted.name, wanted.options));
  }

  /** @param {Notes["settings"]} settings */
  #setSettings(settings) {
    const before = this.settings?.comparing ?? false;
    this.settings = settings;
    this.settingsPanel.show(settings);
    at("compare").setAttribute("aria-pressed", String(settings.comparing));
    const loses = Math.min(settings.restitution, settings.wall_restitution ?? 1) < 1;
    document.body.dataset.loses = String(loses);
    if (settings.comparing === before) return;
    this.twin.clear();
    this.comparison.show(settings.comparing);
    announce(settings.comparing ? "Exact and ticks side by side" : "One picture");
    this.#resize();
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

  /** @param {ColorMode} mode */
  #setColor(mode) {
    this.options.color = mode;
    this.controls.markColor(mode);
    if (this.scene !== null) {
      this.options.full = fullOf(mode, this.scene, this.timeline.newest?.counts);
      drawLegend(at("legend"), mode, this.options.full, this.scene);
    }
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
    const ratio = Math.min(devicePixelRatio, FINEST);
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const panel = at("panel");
    const covered = !panel.hidden;
    const box = (/** @type {string} */ id) => at(id).getBoundingClientRect();
    const split = this.settings?.comparing === true;
    const top = box("heading").bottom;
    const arranged = layout({
      width,
      height,
      right: covered && !NARROW.matches ? box("panel").left : width,
      bottom: covered && NARROW.matches ? box("panel").top : box("bar").top,
      top,
      labels: split ? top + 64 : 0,
      narrow: NARROW.matches,
    });
    this.viewports = arranged.viewports;
    if (split) this.comparison.arrange(arranged.viewports, top);
    this.camera.resize(arranged.size.width, arranged.size.height, arranged.insets);
    if (!this.camera.moved) this.#fit();
    this.stale = true;
  }

  /** @param {"open" | "waiting" | "refused"} state @param {string} sentence */
  #state(state, sentence) {
    document.body.dataset.connection = state;
    this.#say("connection", sentence);
    if (state === "open") return;
    this.timeline.clear();
    this.twin.clear();
  }

  /** @param {string} id @param {string} sentence */
  #say(id, sentence) {
    put(at(id), sentence);
    at(id).hidden = sentence === "";
  }

  /** @param {number} now */
  #tick(now) {
    requestAnimationFrame((next) => this.#tick(next));
    const seconds = Math.min(0.25, (now - this.before) / 1000);
    this.before = now;
    const pair = this.timeline.advance(seconds);
    this.connection.returnCredit();
    if (pair === null || this.scene === null) return;
    const { t } = this.timeline;
    this.readout.show(t, now);
    if (now - this.looked > SLOWLY) this.#look(now);
    const { version } = this.camera;
    if (!this.stale && t === this.drawn.t && version === this.drawn.camera) return;
    this.renderer.draw(this.#picture(pair, t));
    this.drawn = { t, camera: version };
    this.stale = false;
  }

  /** What changes slowly. @param {number} now */
  #look(now) {
    this.looked = now;
    this.settingsPanel.turnCompass();
    const scene = /** @type {Scene} */ (this.scene);
    const { newest } = this.timeline;
    if (this.settings?.comparing) {
      this.comparison.update([newest, this.twin.newest], this.settings.tick, now);
    }
    if (this.options.color !== "collisions") return;
    const full = fullOf("collisions", scene, newest?.counts);
    if (full !== this.options.full) this.#setColor("collisions");
  }

  /** @param {[Keyframe, Keyframe]} pair @param {number} t @returns {import("./renderer.js").Picture} */
  #picture([first, second], t) {
    const sides = [{ first, second, t, viewport: this.viewports[0] }];
    const beside = around(this.twin.keyframes, t);
    if (this.viewports.length > 1 && beside !== null) {
      sides.push({ first: beside[0], second: beside[1], t, viewport: this.viewports[1] });
    }
    return {
      sides,
      camera: this.camera,
      options: { ...this.options, theme: this.theme.name, arrows: false },
      marks: [],
      arrows: [],
      trails: [],
      ghost: null,
    };
  }
}

async function toggleFullScreen() {
  try {
    if (document.fullscreenElement !== null) await document.exitFullscreen();
    else await document.documentElement.requestFullscreen();
  } catch {
    toast("This browser does not let the page fill the screen.");
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
