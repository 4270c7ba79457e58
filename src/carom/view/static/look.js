/**
 * How spheres look: coloured by what, solid or wire; and the legend that explains it.
 * @typedef {import("./protocol.js").ColorMode} ColorMode
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./protocol.js").Scene} Scene
 */
import { at } from "./dom.js";
import { drawLegend, fullOf } from "./legend.js";

/** @type {ColorMode[]} */
const COLORS = ["energy", "speed", "collisions", "own", "species"];

export class Look {
  /** @param {() => void} changed */
  constructor(changed) {
    this.changed = changed;
    /** @type {ColorMode} */ this.color = "energy";
    this.full = 1; // energy, speed or collisions at the end of the scale
    this.wire = false;
    /** @type {Scene | null} */ this.scene = null;
    /** @type {Keyframe | undefined} */ this.frame = undefined;
    for (const input of document.querySelectorAll("input[name=color], input[name=look]")) {
      input.addEventListener("change", () => {
        const { name, value } = /** @type {HTMLInputElement} */ (input);
        if (name === "color") this.setColor(/** @type {ColorMode} */ (value));
        else this.setWire(value === "wire");
      });
    }
  }

  /** @param {Scene} scene @param {boolean} other whether it is another one, with its own look */
  setScene(scene, other) {
    this.scene = scene;
    this.frame = undefined;
    const several = new Set(scene.species).size > 1;
    at("choose-species").hidden = !several;
    if (other) this.setWire(scene.about.wire);
    const kept = this.color === "species" && !several ? scene.about.color : this.color;
    this.setColor(other ? scene.about.color : kept);
  }

  /** @param {ColorMode} mode */
  setColor(mode) {
    this.color = mode;
    mark("color", mode);
    if (this.scene !== null) {
      this.full = fullOf(mode, this.scene, this.frame);
      drawLegend(at("legend"), mode, this.full, this.scene);
    }
    this.changed();
  }

  nextColor() {
    const offered = COLORS.filter((each) => each !== "species" || !at("choose-species").hidden);
    this.setColor(offered[(offered.indexOf(this.color) + 1) % offered.length]);
  }

  /** @param {boolean} wire */
  setWire(wire) {
    this.wire = wire;
    mark("look", wire ? "wire" : "solid");
    this.changed();
  }

  /** Let the scale follow the motion. @param {Keyframe} frame the newest */
  watch(frame) {
    this.frame = frame;
    if (this.scene === null) return;
    if (fullOf(this.color, this.scene, frame) !== this.full) this.setColor(this.color);
  }
}

/** @param {string} name @param {string} value */
function mark(name, value) {
  /** @type {HTMLInputElement | null} */
  const input = document.querySelector(`input[name=${name}][value=${value}]`);
  if (input !== null) input.checked = true;
}
