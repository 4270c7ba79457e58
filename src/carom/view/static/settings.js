/**
 * Sliders for the laws: restitution of spheres and of walls, strength and direction of gravity.
 * @typedef {import("./protocol.js").Settings} Settings
 * @typedef {import("./matrix.js").Vec3} Vec3
 */
import { at, element, put } from "./dom.js";
import { DIRECTIONS, allowed, angles, direction } from "./gravity.js";
import { spaced } from "./later.js";
import { dot, scale } from "./matrix.js";
import { short } from "./numbers.js";
import { say } from "./protocol.js";
import { Slider } from "./slider.js";

const EVERY = 80; // milliseconds between messages while a slider moves
const SVG = "http://www.w3.org/2000/svg";

export class SettingsPanel {
  /** @param {(message: string) => void} send @param {import("./camera.js").Camera} camera */
  constructor(send, camera) {
    this.camera = camera;
    /** @type {Settings | null} */ this.last = null;
    /** @type {import("./gravity.js").Frame} */
    this.frame = { up: [0, 0, 1], forward: [0, 1, 0], right: [1, 0, 0] };
    /** @type {number[]} */ this.period = [0, 0, 0];
    const unit = { low: 0, high: 1 };
    this.restitution = new Slider({
      name: "Restitution of spheres",
      help: "1: no energy is lost when spheres collide; 0: they do not bounce at all",
      range: unit,
      changed: spaced((e) => send(say.rule(e)), EVERY),
    });
    this.walls = new Slider({
      name: "Restitution of walls",
      help: "1: spheres leave a wall as fast as they came",
      range: unit,
      changed: spaced((e) => send(say.walls(e)), EVERY),
    });
    this.sendGravity = spaced((/** @type {Vec3} */ g) => send(say.gravity(g)), EVERY);
    this.cure = element("p", { class: "note" });
    this.gravity = element("div", { class: "gravity" });
    at("settings").append(this.restitution.place, this.cure, this.walls.place, this.gravity);
    this.#buildGravity(1);
  }

  /** @param {import("./protocol.js").Scene} scene @param {boolean} fresh whether the camera stood up anew */
  setScene({ about }, fresh) {
    if (fresh) {
      const [forward, right] = this.camera.compass;
      this.frame = { up: this.camera.up, forward, right };
    }
    this.period = about.period;
    const top = Number(about.full_gravity.toPrecision(2));
    if (fresh || this.strength.range?.high !== top) this.#buildGravity(top);
    if (this.last !== null) this.show(this.last);
  }

  /** @param {number} top */
  #buildGravity(top) {
    const changed = () => this.#sendGravity();
    this.strength = new Slider({ name: "Gravity", range: { low: 0, high: top }, changed });
    const half = { low: 0, high: 180, whole: true };
    const full = { low: 0, high: 360, whole: true };
    this.tilt = new Slider({ name: "Tilt from down, degrees", range: half, changed });
    this.heading = new Slider({ name: "Heading, degrees", range: full, changed });
    this.buttons = DIRECTIONS.map(([name, glyph, tilt, heading]) => {
      const button = element(
        "button",
        { type: "button", "aria-label": `Gravity ${name}`, "aria-pressed": "false", title: name },
        glyph,
      );
      button.addEventListener("click", () => this.#turn(tilt, heading));
      return button;
    });
    this.arrow = document.createElementNS(SVG, "path");
    const glyph = document.createElementNS(SVG, "svg");
    const ring = document.createElementNS(SVG, "circle");
    for (const [name, value] of Object.entries({ viewBox: "-12 -12 24 24", "aria-hidden": "true", class: "compass" })) {
      glyph.setAttribute(name, value);
    }
    for (const [name, value] of Object.entries({ cx: "0", cy: "0", r: "10.5" })) {
      ring.setAttribute(name, value);
    }
    glyph.append(ring, this.arrow);
    const group = element("div", { class: "directions", role: "group", "aria-label": "Direction of gravity" });
    group.append(...this.buttons);
    this.angles = element("div", {}, this.tilt.place, this.heading.place);
    this.noGravity = element("p", { class: "note" }, "Periodic in all directions: gravity would have no floor to pull to.");
    this.gravityRows = element("div", {}, this.strength.place, element("div", { class: "pointing" }, glyph, group), this.angles);
    this.gravity.replaceChildren(this.gravityRows, this.noGravity);
    this.shownArrow = "";
  }

  /** What the server says holds now. @param {Settings} settings */
  show(settings) {
    this.last = settings;
    this.#write(settings, false);
  }

  /** Back to what holds: a wish was refused. */
  revert() {
    if (this.last !== null) this.#write(this.last, true);
  }

  /** @param {Settings} settings @param {boolean} force */
  #write(settings, force) {
    const set = (/** @type {Slider} */ slider, /** @type {number} */ value) =>
      force ? slider.force(value) : slider.show(value);
    set(this.restitution, settings.restitution);
    this.walls.place.hidden = settings.wall_restitution === null;
    if (settings.wall_restitution !== null) set(this.walls, settings.wall_restitution);
    const cured = settings.contact_time !== null && settings.contact_time > 0;
    this.cure.hidden = !cured;
    if (cured) {
      put(
        this.cure,
        `Collisions of a sphere less than ${short(settings.contact_time ?? 0)} apart are elastic: ` +
          "without this, balls that lose energy could collide without end in no time.",
      );
    }
    const bound = this.period.every((length) => length > 0);
    this.gravityRows.hidden = bound;
    this.noGravity.hidden = !bound;
    this.angles.hidden = this.period.some((length) => length > 0);
    const { strength, tilt, heading } = angles(this.frame, settings.gravity);
    if (!force && [this.strength, this.tilt, this.heading].some((slider) => slider.busy)) {
      this.#mark();
      return;
    }
    set(this.strength, Number(strength.toPrecision(6)));
    if (strength > 0 || Number.isNaN(this.tilt.value)) {
      set(this.tilt, tilt);
      set(this.heading, heading);
    }
    this.#mark();
  }

  /** @param {number} tilt @param {number} heading */
  #turn(tilt, heading) {
    this.tilt.force(tilt);
    this.heading.force(heading);
    // Somebody who chooses a direction wants to see gravity.
    if (!(this.strength.value > 0)) this.strength.force((this.strength.range?.high ?? 1) / 4);
    this.#sendGravity();
  }

  /** @returns {Vec3} */
  #unit() {
    return direction(this.frame, this.tilt.value || 0, this.heading.value || 0);
  }

  #sendGravity() {
    this.#mark();
    this.sendGravity(scale(this.#unit(), this.strength.value || 0));
  }

  /** Press the button of the direction that holds, and block those that cannot. */
  #mark() {
    const unit = this.#unit();
    DIRECTIONS.forEach(([, , tilt, heading], k) => {
      const its = direction(this.frame, tilt, heading);
      this.buttons[k].setAttribute("aria-pressed", String(dot(unit, its) > 1 - 1e-9));
      this.buttons[k].disabled = !allowed(its, this.period);
    });
    this.turnCompass();
  }

  /** Point the little arrow as gravity points in the picture. */
  turnCompass() {
    const { right, up } = this.camera.axes;
    const unit = this.#unit();
    const [x, y] = [9 * dot(unit, right), -9 * dot(unit, up)];
    const size = Math.hypot(x, y);
    const path =
      size < 1.5
        ? "M-3 0h6M0 -3v6"
        : arrow(x, y, size);
    if (path === this.shownArrow) return;
    this.shownArrow = path;
    this.arrow.setAttribute("d", path);
  }
}

/** An arrow through the middle, as an SVG path. @param {number} x @param {number} y @param {number} size */
function arrow(x, y, size) {
  const [ux, uy] = [x / size, y / size];
  const head = Math.min(5, size);
  const point = (/** @type {number} */ along, /** @type {number} */ aside) =>
    `${(x - ux * along - uy * aside).toFixed(1)} ${(y - uy * along + ux * aside).toFixed(1)}`;
  return `M${(-x).toFixed(1)} ${(-y).toFixed(1)}L${point(0, 0)}M${point(head, head * 0.7)}L${point(0, 0)}L${point(head, -head * 0.7)}`;
}
