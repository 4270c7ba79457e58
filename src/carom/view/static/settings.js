/**
 * The laws that people can change: restitution of spheres and of walls, gravity.
 * @typedef {import("./protocol.js").Settings} Settings
 */
import { at, element, put } from "./dom.js";
import { GravityPad } from "./gravitypad.js";
import { spaced } from "./later.js";
import { short } from "./numbers.js";
import { say } from "./protocol.js";
import { Slider } from "./slider.js";

const EVERY = 80; // milliseconds between messages while a slider moves
const UNIT = { low: 0, high: 1 };

export class SettingsPanel {
  /** @param {(message: string) => void} send @param {import("./camera.js").Camera} camera */
  constructor(send, camera) {
    /** @type {Settings | null} */ this.last = null;
    this.spheres = new Slider({
      name: "Restitution of spheres",
      help: "1: no energy is lost when spheres collide; 0: they do not bounce at all",
      range: UNIT,
      changed: spaced((e) => send(say.rule(e)), EVERY),
    });
    this.walls = new Slider({
      name: "Restitution of walls",
      help: "1: spheres leave a wall as fast as they came",
      range: UNIT,
      changed: spaced((e) => send(say.walls(e)), EVERY),
    });
    this.gravity = new GravityPad(camera, spaced((g) => send(say.gravity(g)), EVERY));
    this.cure = element("p", { class: "note" });
    at("settings").append(this.spheres.place, this.cure, this.walls.place, this.gravity.place);
  }

  /** @param {import("./protocol.js").Scene} scene @param {boolean} fresh whether the camera stood up anew */
  setScene(scene, fresh) {
    this.gravity.setScene(scene.about, fresh);
    if (this.last !== null) this.#write(this.last, fresh);
  }

  /** What the server says holds now. @param {Settings} settings */
  show(settings) {
    this.last = settings;
    this.#write(settings, false);
  }

  /** Back to what holds: a wish was refused. */
  revert() {
    if (this.last !== null) this.#write(this.last, true);
  }

  /** @param {Settings} settings @param {boolean} force even what somebody is changing */
  #write({ restitution, wall_restitution, contact_time, gravity }, force) {
    const set = (/** @type {Slider} */ slider, /** @type {number} */ value) =>
      force ? slider.force(value) : slider.show(value);
    set(this.spheres, restitution);
    this.walls.place.hidden = wall_restitution === null;
    if (wall_restitution !== null) set(this.walls, wall_restitution);
    this.gravity.show(gravity, force);
    this.cure.hidden = !contact_time;
    if (!contact_time) return;
    const rule = `Collisions of a sphere less than ${short(contact_time)} apart are elastic.`;
    put(this.cure, `${rule} Without this, balls that lose energy could collide without end.`);
  }
}
