/**
 * Ties the parts of the page together. Where the motion comes from is told by whoever starts it:
 * `main.js` for the live view, `replay.js` for a file, `widget.js` for a notebook.
 */
import { Banners } from "./banners.js";
import { Camera } from "./camera.js";
import { Controls, announce } from "./controls.js";
import { at, put } from "./dom.js";
import { toggleFullScreen, watchFullScreen } from "./fullscreen.js";
import { Gallery } from "./gallery.js";
import { cameraKey } from "./gestures.js";
import { Help } from "./help.js";
import { Inspector } from "./inspector.js";
import { listen } from "./keys.js";
import { layout } from "./layout.js";
import { runsAlready } from "./link.js";
import { Look } from "./look.js";
import { Parameters } from "./parameters.js";
import { Plots } from "./plots.js";
import { say } from "./protocol.js";
import { Readout } from "./readout.js";
import { Recorder } from "./recorder.js";
import { Renderer } from "./renderer.js";
import { keepSections } from "./sections.js";
import { SettingsPanel } from "./settings.js";
import { Share } from "./share.js";
import { Comparison, around } from "./split.js";
import { standBack } from "./standpoint.js";
import { showOnly } from "./start.js";
import { Theme } from "./theme.js";
import { Timeline } from "./timeline.js";
import { toast } from "./toast.js";
import { attachToolbar } from "./toolbar.js";
import { Hands } from "./tools.js";

/**
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./protocol.js").Notes} Notes
 * @typedef {import("./connection.js").Listener} Listener
 *
 * @typedef {object} Start
 * @property {import("./keys.js").Mode} mode
 * @property {(listener: Listener) => {send: (message: string) => void, returnCredit: () => void}} connect
 * @property {Pick<Timeline, "t" | "newest" | "push" | "clear" | "advance">} [timeline]
 * @property {string} [token]
 * @property {import("./link.js").Origin | null} [wanted] the scene that the address asks for
 * @property {import("./keys.js").Actions} [actions] more of them
 */

const SLOWLY = 250; // milliseconds between looks at what changes slowly
const LABELS = 80; // pixels that the numbers above the halves of the split screen take
// As in narrow.css: a sheet instead of a panel, and a screen too low for an open panel at first.
const NARROW = matchMedia("(max-width: 500px), (max-width: 960px) and (min-height: 501px)");
const LOW = matchMedia("(max-height: 500px)");

export class Page {
  /** @param {Start} start */
  constructor({ mode, connect, timeline = new Timeline(), token = "", wanted = null, actions = {} }) {
    const send = (/** @type {string} */ message) => this.connection.send(message);
    const fit = () => this.camera.glide(() => this.#fit());
    showOnly(mode);
    this.mode = mode;
    this.wanted = wanted;
    this.banners = new Banners();
    this.canvas = /** @type {HTMLCanvasElement} */ (at("view"));
    this.renderer = new Renderer(this.canvas);
    this.camera = new Camera();
    this.timeline = timeline;
    this.twin = new Timeline();
    this.recorder = new Recorder();
    /** @type {Scene | null} */ this.scene = null;
    /** @type {Notes["settings"] | null} */ this.settings = null;
    /** @type {import("./split.js").Viewport[]} */ this.viewports = [];
    this.stale = true; // something other than time, camera and hands has changed
    /** @type {{t: number, second?: Keyframe, twin?: Keyframe, camera: number, hands: number}} */
    this.drawn = { t: NaN, camera: -1, hands: -1 };
    this.before = performance.now();
    this.looked = -Infinity; // when slow things were last looked at
    this.stumbled = ""; // why the last picture could not be drawn
    const changed = () => (this.stale = true);
    this.theme = new Theme(changed);
    this.look = new Look(changed);
    this.readout = new Readout();
    this.plots = new Plots(at("plots"), mode !== "replay");
    const changes = mode !== "replay"; // whether people can change the motion
    this.hands = new Hands({ canvas: this.canvas, camera: this.camera, send, toast, fit, changes });
    this.inspector = new Inspector(at("inspector"), this.hands);
    this.gallery = new Gallery((name) => send(say.scene(name, {})));
    this.help = new Help(mode);
    const askSource = changes ? () => send(say.source()) : null;
    const keep = mode === "live" ? () => this.actions.keep() : null;
    this.share = new Share({ token, picture: () => this.#photo(), askSource, keep });
    this.parameters = new Parameters((name, options) => send(say.scene(name, options)));
    this.laws = new SettingsPanel(send, this.camera);
    this.comparison = new Comparison();
    this.actions = { ...this.#actions(send, fit), ...actions };
    const speed = (/** @type {number} */ value) => send(say.speed(value));
    this.controls = new Controls(this.actions, { speed, layout: () => this.#resize() });
    this.#watch();
    this.connection = this.#connect(connect);
    requestAnimationFrame((now) => this.#tick(now));
  }

  /** @param {Start["connect"]} connect @returns {ReturnType<Start["connect"]>} */
  #connect(connect) {
    return connect({
      scene: (scene) => this.#setScene(scene),
      frame: (frame) => this.#take(frame),
      note: (key, value) => this.#hear({ [key]: value }),
      state: (state, sentence) => this.#state(state, sentence),
    });
  }

  /** Listen to the window. */
  #watch() {
    attachToolbar(this.hands);
    const camera = (/** @type {KeyboardEvent} */ event) => cameraKey(event, this.camera);
    listen(this.mode, this.actions, (event) => this.hands.key(event), camera);
    keepSections(at("panel"));
    const arrange = () => {
      at(NARROW.matches ? "panel-top" : "actions").prepend(at("extras"));
      this.controls.openPanel(!NARROW.matches && !LOW.matches);
    };
    arrange();
    for (const query of [NARROW, LOW]) query.addEventListener("change", arrange);
    new ResizeObserver(() => this.#resize()).observe(this.canvas);
    watchFullScreen(at("fullscreen"));
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => location.reload());
  }

  /**
   * @param {(message: string) => void} send @param {() => void} fit
   * @returns {import("./keys.js").Actions}
   */
  #actions(send, fit) {
    return {
      toggle: () => send(this.timeline.newest?.playing === false ? say.play() : say.pause()),
      step: () => send(say.step()),
      back: () => send(say.back()),
      restart: () => send(say.restart()),
      reverse: () => send(say.reverse()),
      slower: () => this.controls.shift(-1),
      faster: () => this.controls.shift(1),
      normal: () => this.controls.ask(1),
      wire: () => this.look.setWire(!this.look.wire),
      nextColor: () => this.look.nextColor(),
      fit,
      compare: () => send(say.compare(!this.settings?.comparing)),
      fullscreen: () => void toggleFullScreen(),
      gallery: () => void this.gallery.open(this.scene?.about.origin?.name ?? null),
      panel: () => this.controls.openPanel(at("panel").hidden),
      settings: () => this.#openSettings(),
      share: () => this.share.open(this.#title, this.mode === "live" ? (this.scene?.about.origin ?? null) : null),
      keep: () => void this.recorder.save(this.#title),
      theme: () => this.#nextTheme(),
      help: () => this.help.open(),
      leave: () => this.#leave(),
    };
  }

  get #title() {
    return this.scene?.about.title || "carom";
  }

  #openSettings() {
    this.controls.openPanel(true);
    const section = /** @type {HTMLDetailsElement} */ (at("section-settings"));
    section.open = true;
    section.scrollIntoView();
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
    if (this.mode === "live") this.recorder.setScene(scene);
    this.renderer.setScene(scene);
    this.timeline.clear();
    this.twin.clear();
    const { about } = scene;
    // Keys of another program, which took over the port, begin anew; its title differs.
    const fresh = before?.about.key !== about.key || before.about.title !== about.title;
    // Another number of balls in the same scene is no reason to change its colours.
    const other = fresh && (about.origin === null || before?.about.origin?.name !== about.origin.name);
    if (fresh) this.camera.stand(/** @type {[number, number, number]} */ (about.gravity));
    const title = this.#title;
    put(at("title"), title);
    document.title = title === "carom" ? title : `${title} · carom`;
    at("view").setAttribute("aria-label", `${title}: ${scene.n} spheres in three dimensions`);
    this.parameters.setOrigin(about.origin);
    this.laws.setScene(scene, fresh);
    this.look.setScene(scene, other);
    this.hands.setScene(scene, fresh);
    this.plots.setScene(scene, fresh);
    if (other) this.#resize();
    if (other || (fresh && !this.camera.moved)) this.#fit();
    this.#obeyAddress();
    this.banners.fail("page", "");
    this.stale = true;
  }

  /** @param {Keyframe} frame */
  #take(frame) {
    if (frame.scene !== this.scene?.number) return;
    this.plots.push(frame, this.theme.name);
    if (frame.twin) {
      this.twin.push(frame);
      return;
    }
    if (this.mode === "live") this.recorder.push(frame);
    this.timeline.push(frame);
    this.readout.push(frame);
    this.controls.follow(frame);
  }

  /** @param {Partial<Notes>} note with one key */
  #hear(note) {
    if (note.failure !== undefined) this.banners.fail("simulation", note.failure);
    if (note.settings !== undefined) this.#setSettings(note.settings);
    if (note.event !== undefined) this.hands.showEvent(note.event);
    if (note.walls !== undefined) this.plots.walls(note.walls);
    if (note.source !== undefined) this.share.setSource(note.source);
    if (note.catalogue !== undefined) {
      this.gallery.setCatalogue(note.catalogue);
      this.parameters.setCatalogue(note.catalogue);
    }
    if (note.role !== undefined) {
      document.body.dataset.role = note.role;
      at("watching").hidden = note.role !== "watch";
    }
    if (note.refused !== undefined) {
      toast(note.refused);
      this.laws.revert();
      this.parameters.revert();
    }
  }

  /** Load the scene that the link asked for, once, unless it runs already. */
  #obeyAddress() {
    const { wanted } = this;
    this.wanted = null;
    if (wanted === null || runsAlready(wanted, this.scene?.about.origin ?? null)) return;
    this.connection.send(say.scene(wanted.name, wanted.options));
  }

  /** @param {Notes["settings"]} settings */
  #setSettings(settings) {
    const before = this.settings?.comparing ?? false;
    this.settings = settings;
    this.laws.show(settings);
    const loses = Math.min(settings.restitution, settings.wall_restitution ?? 1) < 1;
    document.body.dataset.loses = String(loses);
    if (settings.comparing === before) return;
    at("compare").setAttribute("aria-pressed", String(settings.comparing));
    this.twin.clear();
    this.comparison.show(settings.comparing);
    announce(settings.comparing ? "Exact and ticks side by side" : "One picture");
    this.#resize();
  }

  /** Look at everything, the way the scene asks for. */
  #fit() {
    if (this.scene !== null) standBack(this.camera, this.renderer.walls, this.scene.about);
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    const covered = !at("panel").hidden;
    const box = (/** @type {string} */ id) => at(id).getBoundingClientRect();
    const split = this.settings?.comparing === true;
    const top = box("heading").bottom;
    const { viewports, size, insets } = layout({
      width,
      height,
      right: covered && !NARROW.matches ? box("panel").left : width,
      bottom: covered && NARROW.matches ? box("panel").top : box(at("film").hidden ? "bar" : "film").top,
      top,
      labels: split ? LABELS : 0,
      narrow: NARROW.matches,
    });
    this.viewports = viewports;
    if (split) this.comparison.arrange(viewports, NARROW.matches ? 0 : top);
    this.camera.resize(size.width, size.height, insets);
    if (!this.camera.moved) this.#fit();
    this.stale = true;
  }

  /** @param {"open" | "waiting" | "refused"} state @param {string} sentence */
  #state(state, sentence) {
    document.body.dataset.connection = state;
    this.banners.say("connection", sentence);
  }

  /** @param {number} now */
  #tick(now) {
    requestAnimationFrame((next) => this.#tick(next));
    this.connection.returnCredit();
    try {
      this.#show(now);
      this.stumbled = "";
    } catch (error) {
      // Once: the next picture will very likely fail as this one did.
      if (String(error) !== this.stumbled) reportError(error);
      this.stumbled = String(error);
    }
  }

  /** Draw what there is to see now. @param {number} now */
  #show(now) {
    const seconds = Math.min(0.25, (now - this.before) / 1000);
    this.before = now;
    const pair = this.timeline.advance(seconds);
    if (pair === null || this.scene === null) return;
    const { t } = this.timeline;
    const sides = this.#sides(pair, t);
    this.hands.setSides(sides);
    this.readout.show(t, now);
    this.plots.show(now);
    if (now - this.looked > SLOWLY) this.#glance(now);
    const [{ second }, beside] = sides;
    const next = { t, second, twin: beside?.second, camera: this.camera.version, hands: this.hands.version };
    const { drawn } = this;
    // While time stands another keyframe of the same moment may hold other velocities.
    const moved = t !== drawn.t || second !== drawn.second || next.twin !== drawn.twin;
    const seen = moved || next.camera !== drawn.camera || next.hands !== drawn.hands;
    if (!seen && !this.stale) return;
    this.renderer.draw(this.#picture(sides));
    this.drawn = next;
    this.stale = false;
  }

  /** @param {[Keyframe, Keyframe]} pair @param {number} t */
  #sides([first, second], t) {
    const sides = [{ first, second, t, viewport: this.viewports[0] }];
    const beside = this.viewports.length > 1 ? around(this.twin.keyframes, t) : null;
    if (beside !== null) {
      sides.push({ first: beside[0], second: beside[1], t, viewport: this.viewports[1] });
    }
    return sides;
  }

  /** @param {import("./tools.js").Side[]} sides @returns {import("./renderer.js").Picture} */
  #picture(sides) {
    const { color, full, wire } = this.look;
    const arrows = this.hands.isOn("arrows") ? this.hands.time : 0;
    const options = { color, full, wire, theme: this.theme.name, arrows };
    return { sides, camera: this.camera, options, ...this.hands.overlay() };
  }

  /** The picture as a file, in its middle what the page shows beside its panels. */
  async #photo() {
    while (this.renderer.picture === null) await new Promise((go) => requestAnimationFrame(go));
    const { insets } = this.camera;
    this.camera.insets = { left: 0, right: 0, top: 0, bottom: 0 };
    const file = this.renderer.toBlob();
    this.camera.insets = insets;
    this.stale = true;
    return file;
  }

  /** What changes slowly. @param {number} now */
  #glance(now) {
    this.looked = now;
    this.laws.gravity.turnCompass();
    this.hands.theme = this.theme.name;
    // A hint how to select one has its place where there is room.
    const chosen = this.hands.selected !== null || this.hands.isOn("add");
    at("section-inspector").hidden = NARROW.matches && !chosen;
    const { newest } = this.timeline;
    if (newest !== undefined) this.look.watch(newest);
    if (this.settings?.comparing) {
      this.comparison.update([newest, this.twin.newest], this.settings.tick, now);
    }
  }
}
