/**
 * Keeps the last minute of what was seen, in bounded memory, and saves it as a replay.
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./protocol.js").Scene} Scene
 */
import { saveFile } from "./file.js";
import { encodeReel } from "./reel.js";
import { toast } from "./toast.js";
import { FRAME_HEADER_BYTES, SPHERE_BYTES } from "./wire.js";

const MINUTE = 60; // seconds
const [FEWEST, MOST] = [10, 30]; // keyframes per second that are kept
const MEMORY = 64 * 2 ** 20; // bytes that keyframes may take
const TEMPLATE = "/replay.html";
const DATA_END = "</script><!-- data ends -->"; // as in carom/view/bundle.py
const CHUNK = 2 ** 15; // letters written at once

export class Recorder {
  constructor() {
    /** @type {Scene | null} */ this.scene = null;
    /** @type {Keyframe[]} */ this.keyframes = [];
    this.most = 2; // keyframes
    this.gap = 0; // seconds between two
  }

  /** @param {Scene} scene */
  setScene(scene) {
    const { scene: before } = this;
    const same =
      before !== null &&
      before.n === scene.n &&
      before.about.key === scene.about.key &&
      before.radius.every((radius, i) => radius === scene.radius[i]);
    this.scene = scene;
    if (same) return;
    this.keyframes = [];
    const room = Math.floor(MEMORY / (FRAME_HEADER_BYTES + SPHERE_BYTES * scene.n));
    const rate = Math.min(MOST, Math.max(FEWEST, room / MINUTE));
    this.most = Math.max(2, Math.min(room, rate * MINUTE));
    this.gap = 1 / rate;
  }

  /** @param {Keyframe} frame */
  push(frame) {
    const { keyframes } = this;
    // A step back or a restart takes back what came after; a push at rest replaces its moment.
    while (keyframes.length > 0 && keyframes[keyframes.length - 1].t >= frame.t) keyframes.pop();
    const last = keyframes[keyframes.length - 1];
    if (last !== undefined && frame.playing && frame.clock - last.clock < this.gap - 0.004) return;
    keyframes.push(frame);
    if (keyframes.length > this.most) keyframes.shift();
  }

  /** Save what there is as a file. @param {string} title */
  async save(title) {
    const { scene, keyframes } = this;
    if (scene === null || keyframes.length < 2) {
      toast("There is nothing to save yet: let time run first.");
      return;
    }
    const frames = [...keyframes];
    try {
      const answer = await fetch(TEMPLATE);
      if (!answer.ok) throw new Error("the program has no template");
      const template = await answer.text();
      const { speed } = frames[frames.length - 1];
      const data = letters(await encodeReel({ scene, keyframes: frames, speed }));
      const place = template.lastIndexOf(DATA_END);
      const page = new Blob([template.slice(0, place), data, template.slice(place)], { type: "text/html" });
      saveFile(page, title, "html");
      const time = frames[frames.length - 1].t - frames[0].t;
      toast(`Saved ${time.toPrecision(3)} of time in ${frames.length} frames.`);
    } catch (error) {
      toast(`The replay was not saved: ${/** @type {Error} */ (error).message}.`);
    }
  }
}

/** Bytes in base64. @param {Uint8Array} bytes */
function letters(bytes) {
  let text = "";
  for (let k = 0; k < bytes.length; k += CHUNK) text += String.fromCharCode(...bytes.subarray(k, k + CHUNK));
  return btoa(text);
}
