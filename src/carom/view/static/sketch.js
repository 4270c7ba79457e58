/** The page of a sketch: its picture, what it prints, and the controls. */
import { Connection, takeToken } from "./connection.js";
import { say } from "./protocol.js";
import { SketchCamera, attachPointer, cameraKey } from "./sketch_camera.js";
import { decodeSketch } from "./sketch_protocol.js";
import { SketchRenderer } from "./sketch_renderer.js";

const FINEST = 2; // pixels of the picture per pixel of the page
const BORDER = 12; // pixels of the desk that stay around the sheet

/** @typedef {import("./sketch_protocol.js").Sheet} Sheet */

/** @param {string} id */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

class SketchPage {
  constructor() {
    this.canvas = /** @type {HTMLCanvasElement} */ (at("sheet"));
    this.renderer = new SketchRenderer(this.canvas);
    this.camera = new SketchCamera();
    /** @type {Sheet | null} */ this.sheet = null; // the newest
    /** @type {Sheet | null} */ this.drawn = null;
    this.drawnView = -1;
    this.connection = new Connection(
      takeToken(),
      {
        scene: () => {},
        frame: (sheet) => this.#take(sheet),
        note: (key, value) => this.#note(key, value),
        state: (state, sentence) => {
          document.body.dataset.connection = state;
          this.#banner("connection", sentence.replace("The simulation", "The program"));
        },
      },
      decodeSketch,
    );
    attachPointer(this.canvas, this.camera);
    this.#attachControls();
    new ResizeObserver(() => this.#resize()).observe(at("stage"));
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => location.reload());
    requestAnimationFrame(() => this.#tick());
  }

  #attachControls() {
    const actions = {
      restart: () => this.connection.send(say.restart()),
      play: () => this.connection.send(this.sheet?.playing ? say.pause() : say.play()),
      step: () => this.connection.send(say.step()),
      front: () => this.camera.reset(),
      picture: () => this.#save(),
      full: () => this.#fullScreen(),
    };
    const keys = /** @type {Record<string, keyof typeof actions>} */ ({
      r: "restart",
      " ": "play",
      n: "step",
      "]": "step",
      f: "front",
      s: "picture",
      m: "full",
    });
    for (const [id, action] of Object.entries(actions)) at(id).addEventListener("click", action);
    addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const { target } = event;
      // A focused button or text keeps the keys that work it.
      if (target instanceof HTMLButtonElement && [" ", "Enter"].includes(event.key)) return;
      const typed = target === at("printed");
      const action = keys[event.key.toLowerCase()];
      if (action !== undefined) actions[action]();
      else if (typed || !cameraKey(event, this.camera)) return;
      event.preventDefault();
    });
  }

  /** @param {Sheet} sheet */
  #take(sheet) {
    const before = this.sheet;
    this.sheet = sheet;
    if (before?.width !== sheet.width || before.height !== sheet.height) this.#resize();
    at("frame").textContent = String(sheet.frame);
    at("rate").textContent =
      sheet.playing && sheet.reached > 0 ? `· ${Math.round(sheet.reached)} per second` : "";
    const play = at("play");
    const label = sheet.playing ? "Pause" : "Play";
    play.dataset.playing = String(sheet.playing);
    play.setAttribute("aria-label", label);
    play.title = `${label} (space)`;
    for (const id of ["play", "step"]) {
      /** @type {HTMLButtonElement} */ (at(id)).disabled = sheet.failed;
    }
  }

  /** @param {string} key @param {unknown} value */
  #note(key, value) {
    const text = String(value);
    if (key === "failure" || key === "refused") this.#banner("failure", text);
    else if (key === "title") {
      at("title").textContent = text;
      document.title = `${text} · carom`;
      this.canvas.setAttribute("aria-label", `The picture that ${text} draws`);
    } else if (key === "printed") this.#print(text);
  }

  /** @param {string} text */
  #print(text) {
    const place = at("printed");
    // Stay at the end, unless somebody reads further up.
    const atEnd = place.scrollHeight - place.scrollTop - place.clientHeight < 30;
    place.textContent = text;
    at("console").hidden = text === "";
    if (atEnd) place.scrollTop = place.scrollHeight;
  }

  /** @param {string} id @param {string} sentence */
  #banner(id, sentence) {
    at(id).textContent = sentence;
    at(id).hidden = sentence === "";
  }

  /** Make the sheet as large as fits, in its own proportions. */
  #resize() {
    if (this.sheet === null) return;
    const { clientWidth, clientHeight } = at("stage");
    const { width, height } = this.sheet;
    const room = [clientWidth - 2 * BORDER, clientHeight - 2 * BORDER];
    const factor = Math.max(0.01, Math.min(room[0] / width, room[1] / height));
    const [w, h] = [Math.floor(width * factor), Math.floor(height * factor)];
    const ratio = Math.min(devicePixelRatio, FINEST);
    this.canvas.style.setProperty("width", `${w}px`);
    this.canvas.style.setProperty("height", `${h}px`);
    this.canvas.width = Math.max(1, Math.round(w * ratio));
    this.canvas.height = Math.max(1, Math.round(h * ratio));
    this.drawn = null;
  }

  #fullScreen() {
    if (document.fullscreenElement === null) void document.documentElement.requestFullscreen();
    else void document.exitFullscreen();
  }

  /** Save the picture as a file. */
  #save() {
    if (this.sheet === null) return;
    const { frame } = this.sheet;
    this.#draw(); // what is on the screen may be gone from the buffer
    this.canvas.toBlob((blob) => {
      if (blob === null) return;
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = `${(at("title").textContent ?? "sketch").replace(/\.py$/, "")}-${frame}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
  }

  #draw() {
    if (this.sheet === null) return;
    this.renderer.draw(this.sheet, this.camera.matrices(this.sheet));
    this.drawn = this.sheet;
    this.drawnView = this.camera.version;
  }

  #tick() {
    try {
      this.#show();
    } catch (error) {
      // Once, not in every picture from now on.
      this.#banner("connection", `The page cannot draw: ${/** @type {Error} */ (error).message}.`);
      throw error;
    }
    requestAnimationFrame(() => this.#tick());
  }

  /** Draw the newest frame, if there is something new to see. */
  #show() {
    this.connection.returnCredit();
    const { version } = this.camera;
    if (this.sheet === this.drawn && version === this.drawnView) return;
    /** @type {HTMLButtonElement} */ (at("front")).disabled = this.camera.isFront;
    this.#draw();
  }
}

try {
  // For the browser's console: everything on the page hangs on this one name.
  /** @type {any} */ (globalThis).carom = new SketchPage();
} catch (error) {
  at("connection").textContent = `The sketch cannot start: ${/** @type {Error} */ (error).message}.`;
  at("connection").hidden = false;
  throw error;
}
