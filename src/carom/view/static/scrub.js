/** The bar under a replay: where in the film time stands, and a hand on it. */
import { at, put } from "./dom.js";

export class Scrub {
  /** @param {import("./film.js").Film} film */
  constructor(film) {
    this.film = film;
    this.slider = /** @type {HTMLInputElement} */ (at("scrub"));
    this.slider.max = String(film.keyframes.length - 1);
    this.slider.addEventListener("input", () => film.seek(this.slider.valueAsNumber));
    film.moved = () => this.show();
  }

  show() {
    const { k, t, start, end } = this.film;
    const digits = end - start < 1000 ? 2 : 0;
    const [now, all] = [t - start, end - start].map((time) => time.toFixed(digits));
    const value = String(k);
    if (this.slider.value !== value) this.slider.value = value;
    this.slider.setAttribute("aria-valuetext", `${now} of ${all}`);
    put(at("place"), `${now} / ${all}`);
  }
}
