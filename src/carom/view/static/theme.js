/** Dark or light: as the system says, or as was chosen here. */
import { recall, remember } from "./store.js";

/** @typedef {"auto" | "dark" | "light"} Choice */

/** @type {Choice[]} */
const CHOICES = ["auto", "dark", "light"];
const LIGHT = matchMedia("(prefers-color-scheme: light)");

/** @returns {"dark" | "light"} what the system wants */
const ask = () => (LIGHT.matches ? "light" : "dark");

export class Theme {
  /** @param {() => void} changed */
  constructor(changed) {
    const kept = /** @type {Choice} */ (recall("theme"));
    /** @type {Choice} */ this.choice = CHOICES.includes(kept) ? kept : "auto";
    this.changed = changed;
    this.system = ask();
    // Asked nowhere else: Chromium tells no change to a list that was read after it.
    LIGHT.addEventListener("change", () => {
      this.system = ask();
      this.#apply();
    });
    this.#apply();
  }

  /** What is shown. @returns {"dark" | "light"} */
  get name() {
    return this.choice === "auto" ? this.system : this.choice;
  }

  /** The next choice: first the one that looks different from now. */
  next() {
    const other = this.name === "dark" ? "light" : "dark";
    // auto → the other → the system's own, fixed → auto
    if (this.choice === "auto") this.choice = other;
    else this.choice = this.choice === this.system ? "auto" : this.system;
    remember("theme", this.choice);
    this.#apply();
  }

  #apply() {
    document.documentElement.dataset.theme = this.name;
    this.changed();
  }
}
