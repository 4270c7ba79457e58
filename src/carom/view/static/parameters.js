/**
 * The options of a scene of the library: number of balls, sizes, seed. Changing one makes the
 * scene anew.
 * @typedef {import("./protocol.js").Entry} Entry
 * @typedef {import("./protocol.js").SceneOption} SceneOption
 * @typedef {import("./link.js").Value} Value
 * @typedef {import("./link.js").Origin} Origin
 */
import { at, element } from "./dom.js";
import { settled } from "./later.js";
import { Slider } from "./slider.js";

const WAIT = 250; // milliseconds of rest before a scene is made anew
const SEEDS = 1_000_000;

/** @type {Record<string, string>} */
const LABELS = { n: "Number of spheres" };

/** `packing_fraction` as people write it. @param {string} name */
export function labelOf(name) {
  const words = name.replaceAll("_", " ");
  return LABELS[name] ?? words.charAt(0).toUpperCase() + words.slice(1);
}

/** A control of one option. @typedef {{name: string, place: HTMLElement, show: (value: Value, force: boolean) => void}} Row */

export class Parameters {
  /** @param {(name: string, options: Record<string, Value>) => void} make */
  constructor(make) {
    this.place = at("parameters");
    /** @type {Entry[]} */ this.catalogue = [];
    /** @type {Origin | null} */ this.origin = null;
    /** @type {Record<string, Value>} */ this.values = {};
    /** Changed, but not asked for yet. @type {Record<string, Value>} */ this.wishes = {};
    /** @type {Row[]} */ this.rows = [];
    this.built = "";
    this.ask = settled((/** @type {string} */ name) => {
      if (name !== this.built) return; // another scene has come meanwhile
      Object.assign(this.values, this.wishes);
      this.wishes = {};
      make(name, this.values);
    }, WAIT);
  }

  /** @param {Entry[]} catalogue */
  setCatalogue(catalogue) {
    this.catalogue = catalogue;
    this.built = "";
    this.setOrigin(this.origin);
  }

  /** @param {Origin | null} origin what runs now */
  setOrigin(origin) {
    this.origin = origin;
    const entry = this.catalogue.find(({ name }) => name === origin?.name);
    const section = at("section-scene");
    section.hidden = entry === undefined || entry.options.length === 0;
    if (entry === undefined || origin === null) {
      this.built = "";
      return;
    }
    if (this.built !== entry.name) this.#build(entry);
    this.#show(false);
  }

  /** Back to what runs: a wish was refused. */
  revert() {
    this.wishes = {};
    this.#show(true);
  }

  /** @param {boolean} force */
  #show(force) {
    if (this.origin === null) return;
    const entry = this.catalogue.find(({ name }) => name === this.origin?.name);
    for (const option of entry?.options ?? []) {
      this.values[option.name] = this.origin.options[option.name] ?? option.default;
      const value = this.wishes[option.name] ?? this.values[option.name];
      this.rows.find(({ name }) => name === option.name)?.show(value, force);
    }
  }

  /** @param {Entry} entry */
  #build(entry) {
    this.built = entry.name;
    this.values = {};
    this.wishes = {};
    this.rows = entry.options.map((option) => this.#row(option));
    this.place.replaceChildren(...this.rows.map(({ place }) => place));
  }

  /** @param {SceneOption} option @returns {Row} */
  #row(option) {
    const { name, type } = option;
    const take = (/** @type {Value} */ value) => {
      this.wishes[name] = value;
      this.ask(this.built);
    };
    if (type === "bool") return switchRow(option, take);
    if (type === "str") return textRow(option, take);
    const { low, high } = option;
    const whole = type === "int";
    const range = low !== null && high !== null ? { low, high, log: option.log, whole } : null;
    const slider = new Slider({ name: labelOf(name), help: option.help, range, whole, changed: take });
    if (name === "seed") addDice(slider);
    return {
      name,
      place: slider.place,
      show: (value, force) => (force ? slider.force(Number(value)) : slider.show(Number(value))),
    };
  }
}

/** A button that draws another seed. @param {Slider} slider */
function addDice(slider) {
  const dice = element("button", { type: "button", class: "dice", "aria-label": "Another seed" }, "⚄");
  dice.title = "Another seed: the same scene with other random numbers";
  dice.addEventListener("click", () => {
    const value = 1 + Math.floor(Math.random() * SEEDS);
    slider.force(value);
    slider.changed(value);
  });
  slider.top.append(dice);
}

/** @param {SceneOption} option @param {(value: boolean) => void} take @returns {Row} */
function switchRow({ name, help }, take) {
  const box = element("input", { type: "checkbox", role: "switch" });
  const place = element("label", { class: "switch", title: help }, element("span", {}, labelOf(name)), box);
  box.addEventListener("change", () => take(box.checked));
  return { name, place, show: (value) => (box.checked = Boolean(value)) };
}

/** @param {SceneOption} option @param {(value: string) => void} take @returns {Row} */
function textRow({ name, help }, take) {
  const field = element("input", { type: "text" });
  const place = element("label", { class: "switch", title: help }, element("span", {}, labelOf(name)), field);
  field.addEventListener("change", () => take(field.value));
  return {
    name,
    place,
    show: (value, force) => {
      if (force || document.activeElement !== field) field.value = String(value);
    },
  };
}
