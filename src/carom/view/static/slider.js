/**
 * One number that people can change: a slider where it has limits, and a field to type it.
 * While somebody changes it, numbers that come from outside wait.
 */
import { element } from "./dom.js";
import { placeOf, places, valueAt } from "./scales.js";

const HOLDS = 800; // milliseconds after the last touch during which nothing from outside is shown

let made = 0; // for ids that tie labels to fields

/**
 * @typedef {object} Options
 * @property {string} name
 * @property {string} [help]
 * @property {import("./scales.js").Range | null} range null: a field only
 * @property {boolean} [whole]
 * @property {(value: number) => void} changed
 */

export class Slider {
  /** @param {Options} options */
  constructor({ name, help, range, whole = false, changed }) {
    this.range = range;
    this.whole = whole;
    this.changed = changed;
    this.value = NaN;
    this.held = false; // by a finger or a mouse button
    this.touched = -Infinity;
    const id = `number-${++made}`;
    this.field = element("input", { type: "number", id, step: whole ? "1" : "any" });
    const label = element("label", { for: id }, name);
    this.top = element("div", { class: "top" }, label, this.field);
    this.place = element("div", { class: "setting" }, this.top);
    if (help) this.place.title = help;
    /** @type {HTMLInputElement | null} */ this.slider = null;
    if (range !== null) this.#addSlider(name, range);
    this.field.addEventListener("change", () => this.#typed());
  }

  /** @param {string} name @param {import("./scales.js").Range} range */
  #addSlider(name, range) {
    const slider = element("input", { type: "range", min: "0", step: "1", "aria-label": name });
    slider.max = String(places(range));
    slider.addEventListener("input", () => {
      this.touched = performance.now();
      this.#write(valueAt(range, slider.valueAsNumber));
      this.changed(this.value);
    });
    slider.addEventListener("pointerdown", () => (this.held = true));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      slider.addEventListener(end, () => (this.held = false));
    }
    this.place.append(slider);
    this.slider = slider;
  }

  /** Is somebody changing it? */
  get busy() {
    const typing = document.activeElement === this.field;
    return this.held || typing || performance.now() - this.touched < HOLDS;
  }

  /** Show a number that came from outside. @param {number} value */
  show(value) {
    if (this.busy || value === this.value) return;
    this.#write(value);
    if (this.slider !== null && this.range !== null) {
      this.slider.value = String(placeOf(this.range, value));
    }
  }

  /** Show it even while it is being changed: what was asked for was refused. @param {number} value */
  force(value) {
    this.touched = -Infinity;
    this.#write(value);
    if (this.slider !== null && this.range !== null) {
      this.slider.value = String(placeOf(this.range, value));
    }
  }

  /** @param {number} value */
  #write(value) {
    this.value = value;
    this.field.value = String(value);
    this.slider?.setAttribute("aria-valuetext", String(value));
  }

  #typed() {
    const value = this.field.valueAsNumber;
    if (!Number.isFinite(value)) {
      this.field.value = String(this.value);
      return;
    }
    this.touched = performance.now();
    this.#write(this.whole ? Math.round(value) : value);
    if (this.slider !== null && this.range !== null) {
      this.slider.value = String(placeOf(this.range, this.value));
    }
    this.changed(this.value);
  }
}
