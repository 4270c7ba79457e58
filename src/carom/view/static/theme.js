/** Dark or light: as the system says, or as was chosen here. */
import { recall, remember } from "./store.js";

/** @typedef {"auto" | "dark" | "light"} Choice */

/** @type {Choice[]} */
const CHOICES = ["auto", "dark", "light"];
const LIGHT = matchMedia("(prefers-color-scheme: light)");

export class Theme {
  /** @param {() => void} changed */
  constructor(changed) {
    const kept = /** @type {Choice} */ (recall("theme"));
    /** @type {Choice} */ this.choice = CHOICES.includes(kept) ? kept : "auto";
    this.changed = changed;
    LIGHT.addEventListener("change", () => this.#apply());
    this.#apply();
  }

  /** What is shown. @returns {"dark" | "light"} */
  get name() {
    if (this.choice === "auto") return LIGHT.matches ? "light" : "dark";
    return this.choice;
  }

  /** The next choice: first the one that looks different from now. */
  next() {
    const other = this.name === "dark" ? "light" : "dark";
    const system = LIGHT.matches ? "light" : "dark";
    // auto → the other → the system's own, fixed → auto
    if (this.choice === "auto") this.choice = other;
    else this.choice = this.choice === system ? "auto" : system;
    remember("theme", this.choice);
    this.#apply();
  }

  #apply() {
    document.documentElement.dataset.theme = this.name;
    this.changed();
  }
}
