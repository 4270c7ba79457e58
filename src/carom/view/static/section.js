/** One plot: a heading that opens and closes it, a canvas, its key, and what it says in words. */
import { element, put as write } from "./dom.js";

/**
 * @typedef {object} Series
 * @property {string} name
 * @property {string} color name of a CSS property
 * @property {boolean} [dash]
 * @property {string} [value]
 *
 * @typedef {object} Said
 * @property {Series[]} [series]
 * @property {string} [words] the plot's result
 * @property {string} [tone] "good", "fair" or nothing
 * @property {string} [note]
 * @property {string} [now] the number beside the heading
 */

/** @param {HTMLElement} place @param {string} text "" hides it */
function put(place, text) {
  write(place, text);
  place.hidden = text === "";
}

export class Section {
  /** @param {string} title @param {boolean} open @param {(section: Section) => void} render */
  constructor(title, open, render) {
    this.title = title;
    this.render = render;
    this.drawn = -Infinity; // when, in milliseconds
    this.changed = true; // something is not on the screen yet
    this.canvas = element("canvas", { role: "img", "aria-label": title });
    this.now = element("span", { class: "now" });
    this.key = element("ul", { class: "series" });
    this.words = element("p", { class: "words" });
    this.note = element("p", { class: "note" });
    const summary = element("summary", {}, element("h3", {}, title), this.now);
    const content = element("div", { class: "content" }, this.canvas, this.key, this.words, this.note);
    this.details = element("details", { class: "plot" }, summary, content);
    this.details.open = open;
    this.width = 0; // as last laid out: asking for it would lay out the page at once
    new ResizeObserver(([{ contentRect }]) => (this.width = contentRect.width)).observe(this.details);
    this.details.addEventListener("toggle", () => this.#hurry());
    new ResizeObserver(() => this.#hurry()).observe(this.canvas);
  }

  #hurry() {
    this.changed = true;
    this.drawn = -Infinity;
  }

  /** Is it seen by anybody? */
  get open() {
    return this.details.open && this.width > 0;
  }

  /** @param {number} limit milliseconds: drawn since then is soon enough */
  due(limit) {
    return this.changed && this.drawn <= limit && this.open;
  }

  /** @param {number} now milliseconds */
  draw(now) {
    this.drawn = now;
    this.changed = false;
    this.canvas.hidden = false;
    this.render(this);
  }

  /** For people who do not see the canvas. @param {string} text */
  describe(text) {
    this.canvas.setAttribute("aria-label", text.trim());
  }

  /** There is nothing to draw. @param {string} words why */
  empty(words) {
    this.canvas.hidden = true;
    this.say({ words });
  }

  /** @param {Said} said */
  say({ series = [], words = "", tone = "", note = "", now = "" }) {
    put(this.now, now);
    put(this.words, words);
    put(this.note, note);
    this.words.dataset.tone = tone;
    this.key.hidden = series.length === 0;
    // Three short names stay in their columns while their numbers change.
    this.key.toggleAttribute("data-columns", series.length === 3 && series.every((s) => s.name.length < 3));
    while (this.key.children.length > series.length) this.key.lastElementChild?.remove();
    for (const [k, entry] of series.entries()) this.#row(k, entry);
  }

  /** @param {number} k @param {Series} series */
  #row(k, { name, color, dash, value = "" }) {
    if (this.key.children.length <= k) {
      const parts = ["key", "name", "value"].map((kind) => element("span", { class: kind }));
      this.key.append(element("li", {}, ...parts));
    }
    const [mark, label, number] = /** @type {Iterable<HTMLElement>} */ (this.key.children[k].children);
    mark.style.setProperty("--key", `var(${color})`);
    mark.toggleAttribute("data-dash", dash === true);
    put(label, name);
    put(number, value);
  }
}
