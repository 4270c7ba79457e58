/**
 * Plays a reel: what a page of a replay has in place of the server's line and of its timeline.
 * Time stands between two keyframes of the reel, wherever people put it, and runs both ways.
 *
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./connection.js").Listener} Listener
 */
import { collisionsBetween } from "./collisions.js";

export class Film {
  /** @param {import("./reel.js").Reel} reel */
  constructor({ scene, keyframes, speed }) {
    this.scene = scene;
    this.keyframes = keyframes;
    this.t = keyframes[0].t;
    this.speed = speed;
    this.playing = keyframes.length > 1;
    this.way = 1; // −1: time runs backwards
    this.k = 0; // the last keyframe that is not after t
    this.epoch = 0; // counts jumps
    this.told = false; // the listener knows how things stand
    this.#mark();
    /** @type {Listener | null} */ this.listener = null;
    /** Told when the place in the film has changed. @type {() => void} */ this.moved = () => {};
  }

  /** @param {Listener} listener */
  attach(listener) {
    this.listener = listener;
    listener.state("open", "");
    listener.note("role", "control");
    listener.scene(this.scene);
    return this;
  }

  /** The keyframe that was passed last. */
  get newest() {
    return this.keyframes[this.k];
  }

  get start() {
    return this.keyframes[0].t;
  }

  get end() {
    return this.keyframes[this.keyframes.length - 1].t;
  }

  // What a line to a server offers, and a timeline that it fills: here there is nothing to wait for.
  returnCredit() {}
  push() {}
  clear() {}

  /** Do what the page asks for. @param {string} message one of `say` */
  send(message) {
    const { op, value } = JSON.parse(message);
    if (op === "play") this.#play();
    else if (op === "pause") this.playing = false;
    else if (op === "speed") this.speed = value;
    else if (op === "reverse") {
      this.way = -this.way;
      if (this.#ended) this.playing = false;
    } else if (op === "restart") {
      this.way = 1;
      this.playing = true;
      this.#jump(this.start);
    } else if (op === "step") this.#toCollision(1);
    else if (op === "back") this.#toCollision(-1);
    this.#tell();
  }

  get #ended() {
    return this.t === (this.way > 0 ? this.end : this.start);
  }

  #play() {
    if (this.#ended) this.#jump(this.way > 0 ? this.start : this.end);
    this.playing = true;
  }

  /** Stand at keyframe k. @param {number} k */
  seek(k) {
    this.playing = false;
    this.#jump(this.keyframes[Math.min(Math.max(k, 0), this.keyframes.length - 1)].t);
  }

  /** Stand at the next keyframe, or the one before. @param {1 | -1} way */
  shift(way) {
    const between = this.t > this.newest.t;
    this.seek(way > 0 || !between ? this.k + way : this.k);
  }

  /** @param {number} t */
  #jump(t) {
    this.t = t;
    this.epoch++;
    this.told = false;
    this.#find();
    this.moved();
  }

  /** Bring k to t. */
  #find() {
    const { keyframes } = this;
    while (this.k > 0 && keyframes[this.k].t > this.t) this.k--;
    while (this.k + 1 < keyframes.length && keyframes[this.k + 1].t <= this.t) this.k++;
  }

  /** Stand at the next collision that the keyframes tell of, or the one before. @param {1 | -1} way */
  #toCollision(way) {
    this.playing = false;
    const { keyframes, scene, t } = this;
    for (let k = this.k; k >= 0 && k + 1 < keyframes.length; k += way) {
      const [first, second] = [keyframes[k], keyframes[k + 1]];
      if (first.collisions + first.wallCollisions === second.collisions + second.wallCollisions) continue;
      const found = collisionsBetween(first, second, scene).filter((each) => way * (each.t - t) > 0);
      if (found.length === 0) continue;
      const event = found[way > 0 ? 0 : found.length - 1];
      this.#jump(event.t);
      this.listener?.note("event", { ...event, serial: this.epoch });
      return;
    }
    this.#jump(way > 0 ? this.end : this.start);
  }

  /**
   * Let the clock run, and say between which keyframes it stands.
   * @param {number} seconds since the last call
   * @returns {[Keyframe, Keyframe]}
   */
  advance(seconds) {
    if (this.playing) {
      const t = this.t + this.way * this.speed * this.scene.about.pace * seconds;
      const before = this.k;
      this.t = Math.min(this.end, Math.max(this.start, t));
      this.#find();
      if (this.#ended) this.playing = this.told = false;
      if (this.k !== before) this.told = false;
      this.moved();
    }
    if (!this.told) this.#tell();
    return [this.newest, this.keyframes[Math.min(this.k + 1, this.keyframes.length - 1)]];
  }

  #tell() {
    this.told = true;
    this.#mark();
    this.listener?.frame(this.newest);
  }

  /** Write how things stand into the keyframes around now, as a server would. */
  #mark() {
    const { playing, speed, epoch } = this;
    const state = { playing, speed, epoch, reached: speed, reversed: this.way < 0 };
    for (const keyframe of this.keyframes.slice(this.k, this.k + 2)) Object.assign(keyframe, state);
  }
}
