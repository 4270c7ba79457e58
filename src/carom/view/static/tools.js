/**
 * What hands do in the picture: select a sphere, follow it, draw its trail, turn its velocity,
 * delete it, add another. Once per picture it is told what is drawn, and says what to draw on top.
 *
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./matrix.js").Vec3} Vec3
 * @typedef {{first: Keyframe, second: Keyframe, t: number,
 *   viewport: {x: number, y: number, width: number, height: number}}} Side
 * @typedef {"add" | "arrows" | "trail" | "follow"} Tool
 */
import { annotate } from "./annotations.js";
import { arrowTime } from "./arrows.js";
import { Flash } from "./flash.js";
import { attachPointers } from "./gestures.js";
import { Handle, Label } from "./handle.js";
import { placeOf } from "./interpolation.js";
import { NewBall, median } from "./newball.js";
import { pick } from "./pick.js";
import { say } from "./protocol.js";
import { Trail } from "./trail.js";
import { buildWalls, reachOf } from "./walls.js";

const SLACK = 5; // pixels by which the mouse may miss a small sphere
const TOUCH_SLACK = 18; // and a finger
const CALM = matchMedia("(prefers-reduced-motion: reduce)");

export class Hands {
  /**
   * @param {object} parts
   * @param {HTMLCanvasElement} parts.canvas
   * @param {import("./camera.js").Camera} parts.camera
   * @param {(message: string) => void} parts.send to the server
   * @param {(sentence: string) => void} parts.toast tells people something
   * @param {() => void} [parts.fit] shows everything
   * @param {boolean} [parts.changes] whether hands can change the motion, or only look
   */
  constructor({ canvas, camera, send, toast, fit = () => {}, changes = true }) {
    this.canvas = canvas;
    this.camera = camera;
    this.send = send;
    this.toast = toast;
    this.fit = fit;
    this.changes = changes;
    /** @type {Scene | null} */ this.scene = null;
    /** @type {Side[]} */ this.sides = [];
    /** @type {number | null} */ this.selected = null;
    this.side = 0; // on which it was selected
    /** @type {"turn" | "add"} */ this.mode = "turn";
    this.trailing = true; // a selected sphere draws its trail
    this.told = false; // how balls are added
    this.arrows = false; // of all spheres; drawn by whoever draws them
    /** @type {"dark" | "light"} */ this.theme = "dark";
    this.version = 0; // counts changes of what is drawn on top, besides those of time and camera
    this.next = new NewBall();
    this.flash = new Flash();
    /** @type {Trail[]} */ this.trails = [];
    this.reach = 1; // radius of everything that is drawn
    this.time = 1; // simulated time of an arrow
    this.before = performance.now();
    /** Told once per picture, with milliseconds. @type {((now: number) => void)[]} */
    this.listeners = [];
    const parent = canvas.parentElement ?? document.body;
    const layer = document.createElement("div");
    layer.className = "hand-layer";
    parent.insertBefore(layer, canvas.nextSibling);
    this.handle = new Handle(layer, canvas, camera, (velocity) => this.#push(velocity));
    this.label = new Label(layer);
    attachPointers(canvas, camera, this);
    canvas.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && this.#addInTheMiddle()) event.preventDefault();
    });
    canvas.addEventListener("pointerleave", () => this.#forgetGhost());
    const calm = () => (this.flash.calm = camera.calm = CALM.matches);
    CALM.addEventListener("change", calm);
    calm();
  }

  /** @param {Scene} scene @param {boolean} fresh whether it is another one, not the same with other spheres */
  setScene(scene, fresh) {
    const before = this.scene;
    this.scene = scene;
    this.sides = [];
    if (fresh) {
      this.select(null);
      this.flash.clear();
      this.leaveAdding();
      this.#measure(scene);
    } else if (before !== null && scene.n < before.n) this.select(null); // numbers mean other spheres now
    this.version++;
  }

  /** Scales that stay as long as the scene does, whatever is added or pushed. @param {Scene} scene */
  #measure(scene) {
    this.reach = reachOf(buildWalls(scene.about).bounds);
    this.time = this.handle.time = arrowTime(median(scene.radius) || 0, this.reach, scene.about);
    this.handle.fullSpeed = scene.about.full_speed;
    this.next.resemble(scene, this.reach);
  }

  /** What is going to be drawn now; to be told before every picture. @param {Side[]} sides */
  setSides(sides) {
    const now = performance.now();
    this.camera.advance(Math.min(0.1, (now - this.before) / 1000));
    this.before = now;
    if (this.scene === null) return;
    this.sides = sides;
    this.trails.splice(sides.length); // that of a side which has gone would go on elsewhere
    if (this.selected !== null) this.#attend(this.selected);
    if (sides.length > 0 && this.flash.update(sides[0], this.scene, now)) this.version++;
    for (const listener of this.listeners) listener(now);
  }

  /** Carry the camera along and lengthen the trail. @param {number} i */
  #attend(i) {
    const sphere = this.stateOf(i, this.side);
    if (sphere !== null) this.camera.carry(sphere.x);
    const period = this.#period;
    if (this.trailing) {
      this.sides.forEach(({ first, second, t }, k) => {
        this.trails[k] ??= new Trail();
        this.trails[k].extend(first, second, t, i, period);
      });
    }
    this.#holdVelocity(i);
  }

  /** @param {number} i */
  #holdVelocity(i) {
    const [side] = this.sides;
    // Beside ticks nothing is changed: both sides began alike.
    const alone = this.sides.length === 1;
    const stands = this.changes && alone && !side.second.playing && side.t === side.second.t;
    const free = this.scene !== null && Number.isFinite(this.scene.mass[i]);
    const sphere = stands && free && this.mode === "turn" ? this.stateOf(i, 0) : null;
    const radius = this.scene?.radius[i] ?? 0;
    const ball = sphere === null ? null : { ...sphere, radius, viewport: side.viewport };
    const { wanted } = this.handle;
    if (this.handle.hold(ball, side?.second.epoch ?? -1)) this.version++;
    if (this.handle.drag !== null || this.handle.wanted !== wanted) this.version++;
  }

  /** What lies over the picture. */
  overlay() {
    return annotate(this);
  }

  /** Place and velocity of a sphere as drawn on a side. @param {number} i @param {number} side */
  stateOf(i, side) {
    const shown = this.sides[side] ?? this.sides[0];
    if (shown === undefined || i >= shown.second.n) return null;
    return placeOf(shown.first, shown.second, shown.t, i, this.#period);
  }

  get #period() {
    return /** @type {Vec3} */ (this.scene?.about.period ?? [0, 0, 0]);
  }

  get following() {
    return this.selected !== null && this.camera.follows;
  }

  /** @param {number | null} i @param {number} [side] */
  select(i, side = 0) {
    const { following } = this;
    if (i === this.selected && side === this.side) return;
    this.selected = i;
    this.side = side;
    this.trails = [];
    this.handle.hold(null, -1);
    if (i === null) this.camera.follows = false;
    else if (following) this.#follow(i);
    this.version++;
  }

  /** The sphere after the selected one, or before it; they follow one another in a ring. @param {1 | -1} way */
  selectNext(way) {
    const n = this.scene?.n ?? 0;
    if (n === 0) return;
    const from = this.selected ?? (way > 0 ? -1 : n);
    this.select((from + way + n) % n, this.side);
  }

  /** @param {Tool} tool */
  isOn(tool) {
    if (tool === "add") return this.mode === "add";
    if (tool === "arrows") return this.arrows;
    return tool === "trail" ? this.trailing && this.selected !== null : this.following;
  }

  /** Switch a tool on or off. @param {Tool} tool */
  toggle(tool) {
    this.version++;
    if (tool === "arrows") this.arrows = !this.arrows;
    else if (tool === "add") this.mode === "add" ? this.leaveAdding() : this.#startAdding();
    else if (this.selected === null) {
      const what = tool === "trail" ? "its trail comes with it" : "then follow it";
      this.toast(`Select a sphere first, ${what}.`);
    } else if (tool === "trail") {
      this.trailing = !this.trailing;
      this.trails = [];
    } else if (this.following) this.camera.follows = false;
    else this.#follow(this.selected);
  }

  #startAdding() {
    if (!this.changes) return;
    this.mode = "add";
    this.canvas.dataset.mode = "add";
    if (!this.told) this.toast("Press where the ball should be, drag to give it a velocity, let go.");
    this.told = true;
  }

  /** @param {number} i */
  #follow(i) {
    const sphere = this.stateOf(i, this.side);
    if (sphere !== null) this.camera.follow(sphere.x);
  }

  leaveAdding() {
    this.mode = "turn";
    delete this.canvas.dataset.mode;
    this.#forgetGhost();
  }

  #forgetGhost() {
    if (this.next.ghost !== null) this.version++;
    this.next.ghost = null;
    this.label.hide();
  }

  /** Take the selected sphere away. */
  remove() {
    if (this.selected === null || !this.changes) return;
    this.send(say.remove(this.selected));
    this.select(null);
  }

  /** @param {Vec3} velocity */
  #push(velocity) {
    if (this.selected !== null) this.send(say.push(this.selected, velocity));
    this.version++;
  }

  /** A step has led to a collision. @param {import("./flash.js").Event} event */
  showEvent(event) {
    this.flash.show(event, performance.now());
    this.version++;
  }

  /** True if the key meant something here. @param {KeyboardEvent} event */
  key(event) {
    const { target } = event;
    if (target instanceof HTMLInputElement && !["range", "radio", "checkbox"].includes(target.type)) {
      return false;
    }
    switch (event.key.toLowerCase()) {
      case "j":
        this.selectNext(event.shiftKey ? -1 : 1);
        return true;
      case "a":
        this.toggle("add");
        return true;
      case "d":
        this.toggle("arrows");
        return true;
      case "t":
        this.toggle("trail");
        return true;
      case "o":
        this.toggle("follow");
        return true;
      case "delete":
      case "backspace":
        if (this.selected === null) return false;
        this.remove();
        return true;
      case "escape":
        return this.#escape();
      default:
        return false;
    }
  }

  /** Leave whatever was begun last. */
  #escape() {
    if (this.next.ghost !== null && this.#throwing) this.#forgetGhost();
    else if (this.handle.cancel()) this.version++;
    else if (this.mode === "add") this.leaveAdding();
    else if (this.selected !== null) this.select(null);
    else return false;
    return true;
  }

  #throwing = false; // a pointer holds the ghost

  /** The viewport under a pixel of the canvas, and the pixel in it. @param {number} x @param {number} y */
  #locate(x, y) {
    const inside = this.sides.findIndex(
      ({ viewport: v }) => x >= v.x && x < v.x + v.width && y >= v.y && y < v.y + v.height,
    );
    const side = Math.max(0, inside);
    const { x: left, y: top } = this.sides[side]?.viewport ?? { x: 0, y: 0 };
    return { side, x: x - left, y: y - top };
  }

  /** Where a ball is put that is put in a pixel. @param {number} x @param {number} y */
  #spot(x, y) {
    const at = this.#locate(x, y);
    return this.camera.onPlane(at.x, at.y, this.camera.center);
  }

  /** @param {number} x @param {number} y @returns {import("./gestures.js").Drag | null} */
  grab(x, y) {
    if (this.mode !== "add" || this.scene === null) return null;
    this.#throwing = true;
    this.next.put(this.#spot(x, y));
    this.version++;
    return {
      move: (x, y) => {
        const { ghost } = this.next;
        if (ghost === null) return;
        this.next.aim(this.#spot(x, y), this.time);
        const { left, top } = this.canvas.getBoundingClientRect();
        this.label.show(left + x, top + y, ghost.velocity);
        this.version++;
      },
      end: () => {
        this.#throwing = false;
        const ball = this.next.release();
        if (ball !== null) this.send(say.add(ball));
        this.label.hide();
        this.version++;
      },
      cancel: () => {
        this.#throwing = false;
        this.#forgetGhost();
      },
    };
  }

  /** Without a pointer: one at rest in the middle of the picture. */
  #addInTheMiddle() {
    if (this.mode !== "add") return false;
    this.next.put(this.camera.center);
    const ball = this.next.release();
    if (ball !== null) this.send(say.add(ball));
    this.version++;
    return true;
  }

  /** @param {number} x @param {number} y */
  hover(x, y) {
    if (this.mode !== "add" || this.scene === null) return;
    this.next.put(this.#spot(x, y));
    this.version++;
  }

  /** The sphere that is seen in a pixel of the canvas. @param {number} x @param {number} y @param {number} slack pixels */
  under(x, y, slack) {
    const at = this.#locate(x, y);
    const shown = this.sides[at.side];
    if (this.scene === null || shown === undefined) return { i: null, side: 0 };
    const ray = this.camera.ray(at.x, at.y);
    const { radius } = this.scene;
    const { first, second, t } = shown;
    const i = pick(first, second, t, radius, this.#period, ray, slack * this.camera.pixel);
    return { i, side: at.side };
  }

  /** @param {number} x @param {number} y @param {boolean} touch */
  tap(x, y, touch) {
    const { i, side } = this.under(x, y, touch ? TOUCH_SLACK : SLACK);
    this.select(i, side);
  }

  /** @param {number} x @param {number} y */
  twice(x, y) {
    const { i, side } = this.under(x, y, SLACK);
    if (i === null) this.fit();
    else this.select(i, side);
  }
}
