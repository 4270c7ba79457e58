/**
 * The control of gravity: strength, six buttons, two angles, and a compass that shows where it
 * pulls in the picture as it is turned now.
 * @typedef {import("./matrix.js").Vec3} Vec3
 */
import { element } from "./dom.js";
import { DIRECTIONS, allowed, angles, direction } from "./gravity.js";
import { dot, scale } from "./matrix.js";
import { Slider } from "./slider.js";

const SVG = "http://www.w3.org/2000/svg";
const NEEDLE = 9; // half its length, of 12

export class GravityPad {
  /** @param {import("./camera.js").Camera} camera @param {(gravity: Vec3) => void} changed */
  constructor(camera, changed) {
    this.camera = camera;
    this.changed = changed;
    /** Down, when the scene began. @type {import("./gravity.js").Frame} */
    this.frame = { up: [0, 0, 1], forward: [0, 1, 0], right: [1, 0, 0] };
    /** @type {number[]} */ this.period = [0, 0, 0];
    this.full = 1;
    this.needle = document.createElementNS(SVG, "path");
    this.place = element("div", { class: "gravity" });
    this.buttons = DIRECTIONS.map(([name, glyph, tilt, heading]) => {
      const names = { "aria-label": `Gravity ${name}`, "aria-pressed": "false", title: name };
      const button = element("button", { type: "button", ...names }, glyph);
      button.addEventListener("click", () => this.#turn(tilt, heading));
      return button;
    });
    const report = () => this.#report();
    const angle = (/** @type {string} */ name, /** @type {number} */ high) =>
      new Slider({ name, range: { low: 0, high, whole: true }, changed: report });
    this.tilt = angle("Tilt from down, °", 180);
    this.heading = angle("Heading, °", 360);
    this.tilt.force(0);
    this.heading.force(0);
    this.strength = this.#strength(1);
    const group = { class: "directions", role: "group", "aria-label": "Direction of gravity" };
    const row = element("div", { class: "pointing" }, compass(this.needle), element("div", group, ...this.buttons));
    this.angles = element("div", {}, this.tilt.place, this.heading.place);
    this.rows = element("div", {}, this.strength.place, row, this.angles);
    const why = "This world is periodic in all directions: nothing could ever come to rest below.";
    this.none = element("p", { class: "note" }, `No gravity. ${why}`);
    this.place.append(this.rows, this.none);
  }

  /** @param {number} full */
  #strength(full) {
    const strength = new Slider({
      name: "Gravity",
      range: { low: 0, high: full },
      changed: () => this.#report(),
    });
    strength.force(0);
    return strength;
  }

  /** @param {import("./protocol.js").About} about @param {boolean} fresh whether the camera stood up anew */
  setScene(about, fresh) {
    if (fresh) {
      const [forward, right] = this.camera.compass;
      this.frame = { up: this.camera.up, forward, right };
    }
    this.period = about.period;
    const full = Number(about.full_gravity.toPrecision(2)) || 1;
    if (full !== this.full) {
      this.full = full;
      const { value } = this.strength;
      const next = this.#strength(full);
      this.strength.place.replaceWith(next.place);
      this.strength = next;
      this.strength.force(value);
    }
    const bound = about.period.filter((length) => length > 0).length;
    this.rows.hidden = bound === 3;
    this.none.hidden = bound !== 3;
    // Along a periodic axis there is none, so angles in between are of no use.
    this.angles.hidden = bound > 0;
    this.#mark();
  }

  /** Show what holds. @param {Vec3} gravity @param {boolean} force even while somebody changes it */
  show(gravity, force) {
    const sliders = [this.strength, this.tilt, this.heading];
    if (!force && sliders.some(({ busy }) => busy)) return;
    const { strength, tilt, heading } = angles(this.frame, gravity);
    this.strength.force(Number(strength.toPrecision(6)));
    // Without gravity the direction chosen before stays.
    if (strength > 0) {
      this.tilt.force(tilt);
      this.heading.force(heading);
    }
    this.#mark();
  }

  /** @param {number} tilt @param {number} heading */
  #turn(tilt, heading) {
    this.tilt.force(tilt);
    this.heading.force(heading);
    // Somebody who chooses a direction wants to see gravity.
    if (!(this.strength.value > 0)) this.strength.force(this.full / 4);
    this.#report();
  }

  /** @returns {Vec3} */
  get #unit() {
    return direction(this.frame, this.tilt.value, this.heading.value);
  }

  #report() {
    this.#mark();
    this.changed(scale(this.#unit, this.strength.value));
  }

  /** Press the button of the direction that holds, and block those that cannot be. */
  #mark() {
    const unit = this.#unit;
    DIRECTIONS.forEach(([, , tilt, heading], k) => {
      const its = direction(this.frame, tilt, heading);
      const holds = this.strength.value > 0 && dot(unit, its) > 1 - 1e-9;
      this.buttons[k].setAttribute("aria-pressed", String(holds));
      this.buttons[k].disabled = !allowed(its, this.period);
    });
    this.turnCompass();
  }

  /** Turn the needle as the camera stands. */
  turnCompass() {
    const { right, up } = this.camera.axes;
    const unit = this.#unit;
    const path = needle(NEEDLE * dot(unit, right), -NEEDLE * dot(unit, up));
    if (this.needle.getAttribute("d") !== path) this.needle.setAttribute("d", path);
  }
}

/** @param {SVGPathElement} hand */
function compass(hand) {
  const face = document.createElementNS(SVG, "svg");
  const ring = document.createElementNS(SVG, "circle");
  face.setAttribute("viewBox", "-12 -12 24 24");
  face.setAttribute("class", "compass");
  face.setAttribute("aria-hidden", "true");
  ring.setAttribute("r", "10.5");
  face.append(ring, hand);
  return face;
}

/** An arrow through the middle, shorter the more it points away. @param {number} x @param {number} y */
function needle(x, y) {
  const size = Math.hypot(x, y);
  if (size < 1.5) return "M-3 0h6M0 -3v6";
  const [ux, uy] = [x / size, y / size];
  const wing = Math.min(4.5, size);
  const point = (/** @type {number} */ back, /** @type {number} */ aside) =>
    `${(x - ux * back - uy * aside).toFixed(1)} ${(y - uy * back + ux * aside).toFixed(1)}`;
  const tip = point(0, 0);
  return `M${point(2 * size, 0)}L${tip}M${point(wing, 0.7 * wing)}L${tip}L${point(wing, -0.7 * wing)}`;
}
