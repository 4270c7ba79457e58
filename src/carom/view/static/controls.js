/** Buttons, sliders and keys of the page. */
import { cameraKey } from "./gestures.js";
import { multiple } from "./numbers.js";
import { FASTEST, SLOWEST } from "./wire.js";

const STEPS = 50; // of the speed slider, per power of ten
const NOTCH = 3; // steps around 1× in which the slider catches

/**
 * @typedef {object} Wishes what controls ask of the page
 * @property {() => void} toggle play or pause
 * @property {() => void} restart
 * @property {(speed: number) => void} speed
 * @property {(mode: string) => void} color
 * @property {(wire: boolean) => void} wire
 * @property {() => void} fit
 * @property {(open: boolean) => void} panel
 */

/** @template {HTMLElement} T @param {string} id @returns {T} */
const at = (id) => /** @type {T} */ (document.getElementById(id));

export class Controls {
  /** @param {Wishes} wishes @param {import("./camera.js").Camera} camera */
  constructor(wishes, camera) {
    this.wishes = wishes;
    this.speed = 1;
    this.slider = /** @type {HTMLInputElement} */ (at("speed"));
    this.slider.min = String(STEPS * Math.log10(SLOWEST));
    this.slider.max = String(STEPS * Math.log10(FASTEST));
    this.slider.addEventListener("input", () => {
      const steps = this.slider.valueAsNumber;
      this.#ask(Math.abs(steps) <= NOTCH ? 1 : 10 ** (steps / STEPS));
    });
    at("speed-value").addEventListener("click", () => this.#ask(1));
    at("play").addEventListener("click", wishes.toggle);
    at("restart").addEventListener("click", wishes.restart);
    at("fit").addEventListener("click", wishes.fit);
    at("panel-toggle").addEventListener("click", () => this.openPanel(at("panel").hidden));
    for (const input of document.querySelectorAll("input[name=color], input[name=look]")) {
      input.addEventListener("change", () => {
        const { name, value } = /** @type {HTMLInputElement} */ (input);
        if (name === "color") wishes.color(value);
        else wishes.wire(value === "wire");
      });
    }
    addEventListener("keydown", (event) => this.#key(event, camera));
  }

  /** @param {boolean} open */
  openPanel(open) {
    at("panel").hidden = !open;
    at("panel-toggle").setAttribute("aria-expanded", String(open));
    this.wishes.panel(open);
  }

  /** Show whether time runs and how fast, as the server says. @param {import("./protocol.js").Keyframe} frame */
  follow(frame) {
    const play = at("play");
    const name = frame.playing ? "Pause" : "Play";
    if (play.getAttribute("aria-label") !== name) {
      play.setAttribute("aria-label", name);
      play.title = `${name} (space)`;
      play.dataset.playing = String(frame.playing);
    }
    if (document.activeElement !== this.slider) this.#show(frame.speed);
  }

  /** @param {string} mode */
  markColor(mode) {
    const input = document.querySelector(`input[name=color][value=${mode}]`);
    if (input !== null) /** @type {HTMLInputElement} */ (input).checked = true;
  }

  /** @param {boolean} wire */
  markWire(wire) {
    const input = document.querySelector(`input[name=look][value=${wire ? "wire" : "solid"}]`);
    if (input !== null) /** @type {HTMLInputElement} */ (input).checked = true;
  }

  /** @param {number} speed */
  #ask(speed) {
    const limited = Math.min(FASTEST, Math.max(SLOWEST, speed));
    this.#show(limited);
    this.wishes.speed(limited);
  }

  /** @param {number} speed */
  #show(speed) {
    if (speed === this.speed && this.slider.dataset.shown) return;
    this.speed = speed;
    this.slider.dataset.shown = "yes";
    this.slider.valueAsNumber = STEPS * Math.log10(speed);
    this.slider.setAttribute("aria-valuetext", `${multiple(speed)} speed`);
    at("speed-value").textContent = multiple(speed);
  }

  /** @param {KeyboardEvent} event @param {import("./camera.js").Camera} camera */
  #key(event, camera) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const focus = document.activeElement;
    const typing = focus instanceof HTMLInputElement;
    // Arrow keys and space belong to whatever has the focus, if it uses them.
    if (typing && (event.key.startsWith("Arrow") || (event.key === " " && focus !== this.slider))) {
      return;
    }
    if (focus instanceof HTMLButtonElement && (event.key === " " || event.key === "Enter")) return;
    if (this.#command(event.key) || cameraKey(event, camera)) event.preventDefault();
  }

  /** @param {string} key */
  #command(key) {
    const look = document.querySelector("input[name=look]:checked");
    const wire = look !== null && /** @type {HTMLInputElement} */ (look).value === "wire";
    const shift = 10 ** (10 / STEPS);
    switch (key.toLowerCase()) {
      case " ":
        this.wishes.toggle();
        return true;
      case "r":
        this.wishes.restart();
        return true;
      case "f":
      case "home":
        this.wishes.fit();
        return true;
      case "w":
        this.wishes.wire(!wire);
        return true;
      case "p":
        this.openPanel(at("panel").hidden);
        return true;
      case "1":
        this.#ask(1);
        return true;
      case ",":
        this.#ask(this.speed / shift);
        return true;
      case ".":
        this.#ask(this.speed * shift);
        return true;
      default:
        return false;
    }
  }
}
