/** The bar and the buttons of the page; `keys.js` has the keys. */
import { at, put } from "./dom.js";
import { KEYS, printed, titleOf } from "./keys.js";
import { multiple } from "./numbers.js";
import { FASTEST, SLOWEST } from "./wire.js";

const STEPS = 50; // of the speed slider, per power of ten
const NOTCH = 3; // steps around 1× in which the slider catches
const HOLDS = 800; // milliseconds after a wish during which the speed from before may still come

/**
 * @typedef {object} Wishes what controls ask of the page, beside the actions of the keys
 * @property {(speed: number) => void} speed
 * @property {() => void} layout the panel opened or closed
 */

export class Controls {
  /** @param {import("./keys.js").Actions} actions @param {Wishes} wishes */
  constructor(actions, wishes) {
    this.wishes = wishes;
    this.speed = 1;
    this.asked = -Infinity; // when, in milliseconds
    this.slider = /** @type {HTMLInputElement} */ (at("speed"));
    this.slider.min = String(STEPS * Math.log10(SLOWEST));
    this.slider.max = String(STEPS * Math.log10(FASTEST));
    this.slider.addEventListener("input", () => {
      const steps = this.slider.valueAsNumber;
      this.ask(Math.abs(steps) <= NOTCH ? 1 : 10 ** (steps / STEPS));
    });
    for (const button of document.querySelectorAll("button[data-action]")) {
      const { action } = /** @type {HTMLElement & {dataset: {action: string}}} */ (button).dataset;
      name(button, titleOf(action));
      button.addEventListener("click", () => actions[action]());
    }
  }

  /** @param {boolean} open */
  openPanel(open) {
    at("panel").hidden = !open;
    at("panel-toggle").setAttribute("aria-expanded", String(open));
    this.wishes.layout();
  }

  /** Show what time does, as the server says. @param {import("./protocol.js").Keyframe} frame */
  follow(frame) {
    const play = at("play");
    const doing = frame.playing ? "Pause" : "Play";
    if (play.getAttribute("aria-label") !== doing) {
      const known = play.dataset.known === "yes";
      play.dataset.known = "yes";
      play.dataset.playing = String(frame.playing);
      play.setAttribute("aria-label", doing);
      play.title = `${doing} (${printed(KEYS[0].keys[0])})`;
      if (known) announce(frame.playing ? "Playing" : `Paused at ${frame.t.toFixed(2)}`);
    }
    const backwards = String(frame.reversed);
    if (at("reverse").getAttribute("aria-pressed") !== backwards) {
      at("reverse").setAttribute("aria-pressed", backwards);
      at("reversed").hidden = !frame.reversed;
      document.body.dataset.reversed = backwards;
      announce(frame.reversed ? "Time runs backwards" : "Time runs forwards");
      this.wishes.layout();
    }
    if (performance.now() - this.asked > HOLDS) this.#show(frame.speed);
  }

  /** Ask for a speed. @param {number} speed */
  ask(speed) {
    const limited = Math.min(FASTEST, Math.max(SLOWEST, speed));
    this.asked = performance.now();
    this.#show(limited);
    this.wishes.speed(limited);
  }

  /** By steps of a fifth of a power of ten. @param {number} steps */
  shift(steps) {
    this.ask(this.speed * 10 ** (steps / 5));
  }

  /** @param {number} speed */
  #show(speed) {
    if (speed === this.speed && this.slider.dataset.shown) return;
    this.speed = speed;
    this.slider.dataset.shown = "yes";
    this.slider.valueAsNumber = STEPS * Math.log10(speed);
    this.slider.setAttribute("aria-valuetext", `${multiple(speed)} speed`);
    put(at("speed-value"), multiple(speed));
  }
}

/** Tell a screen reader. @param {string} sentence */
export function announce(sentence) {
  at("state").textContent = sentence;
}

/** @param {Element} button @param {string} title with the key in brackets */
function name(button, title) {
  /** @type {HTMLElement} */ (button).title = title;
  // The scene's title is a button too, and must be read as what it says.
  if (button.id !== "title-button") {
    button.setAttribute("aria-label", title.replace(/ \([^)]*\)$/, ""));
  }
}
