/** One plot: a heading that opens and closes it, a canvas, its key, and what it says in words. */

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

/** @param {string} tag @param {string} kind */
function element(tag, kind) {
  const made = document.createElement(tag);
  made.className = kind;
  return made;
}

/** @param {HTMLElement} place @param {string} text */
function put(place, text) {
  if (place.textContent !== text) place.textContent = text;
  place.hidden = text === "";
}

export class Section {
  /** @param {string} title @param {boolean} open @param {(section: Section) => void} render */
  constructor(title, open, render) {
    this.title = title;
    this.render = render;
    this.drawn = -Infinity; // when, in milliseconds
    this.changed = true; // something is not on the screen yet
    this.details = /** @type {HTMLDetailsElement} */ (element("details", "plot"));
    this.details.open = open;
    this.canvas = /** @type {HTMLCanvasElement} */ (document.createElement("canvas"));
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", title);
    const heading = document.createElement("h3");
    heading.textContent = title;
    this.now = element("span", "now");
    this.key = element("ul", "series");
    this.words = element("p", "words");
    this.note = element("p", "note");
    const summary = document.createElement("summary");
    summary.append(heading, this.now);
    const content = element("div", "content");
    content.append(this.canvas, this.key, this.words, this.note);
    this.details.append(summary, content);
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
      const made = document.createElement("li");
      made.append(element("span", "key"), element("span", "name"), element("span", "value"));
      this.key.append(made);
    }
    const [mark, label, number] = /** @type {Iterable<HTMLElement>} */ (this.key.children[k].children);
    mark.style.setProperty("--key", `var(${color})`);
    mark.toggleAttribute("data-dash", dash === true);
    put(label, name);
    put(number, value);
  }
}
