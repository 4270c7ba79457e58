/** The line to the server: says who we are, hands over what comes, and calls again when cut. */
import { decode, say } from "./protocol.js";
import { MAX_CREDITS, SOCKET_PATH, WRONG_TOKEN } from "./wire.js";

const IN_FLIGHT = 2; // frames the server may send ahead: one on its way, one being drawn
const PATIENCE = [250, 500, 1000, 2000]; // milliseconds between calls
/** Milliseconds without a word, after a call or while time runs, after which a line is dead. */
const SILENCE = 15_000;
const BUSY = 100; // milliseconds between two pictures; what goes beyond is no silence
const KEY = "carom-token";

/**
 * Take the token out of the address, so that it stays in no history and no screenshot.
 * A reload finds it in the tab's own storage.
 */
export function takeToken() {
  const found = new URLSearchParams(location.hash.slice(1)).get("token");
  if (found !== null) history.replaceState(null, "", location.pathname);
  try {
    if (found !== null) sessionStorage.setItem(KEY, found);
    return found ?? sessionStorage.getItem(KEY) ?? "";
  } catch {
    return found ?? ""; // a browser that stores nothing: a reload needs the address once more
  }
}

/**
 * @template [F=import("./protocol.js").Keyframe]
 * @typedef {object} Listener
 * @property {(scene: import("./protocol.js").Scene) => void} scene
 * @property {(frame: F) => void} frame
 * @property {<K extends keyof Notes>(key: K, value: Notes[K]) => void} note
 * @property {(state: "open" | "waiting" | "refused", sentence: string) => void} state
 * @typedef {import("./protocol.js").Notes} Notes
 */

/**
 * @template F
 * @typedef {{kind: "scene", scene: import("./protocol.js").Scene}
 *   | {kind: "frame", frame: F, moving?: boolean}} Message
 */

const SERVER = {
  call: () => new WebSocket(`ws://${location.host}${SOCKET_PATH}`),
  lost: "The simulation has ended. Waiting for it to return …",
};

/** @template {{playing: boolean, twin?: boolean}} [F=import("./protocol.js").Keyframe] */
export class Connection {
  /**
   * @param {string} token @param {Listener<F>} listener
   * @param {(buffer: ArrayBuffer) => Message<F>} read what binary messages mean
   * @param {{call: () => WebSocket, lost: string}} line how to call, and what to say when it is cut
   */
  constructor(token, listener, read = /** @type {any} */ (decode), line = SERVER) {
    this.token = token;
    this.listener = listener;
    this.read = read;
    this.line = line;
    this.failed = 0; // calls in a row
    this.answered = false; // the server has said something on this line
    this.silence = 0; // milliseconds of drawing since something came last
    this.drawn = 0; // when the page drew last
    this.moving = false; // frames should be coming
    this.taken = 0; // frames that came since credit was last returned
    /** Until the next call, or until a call without an answer is given up. @type {number | undefined} */
    this.timer = undefined;
    /** null between two calls. @type {WebSocket | null} */ this.socket = null;
    // A computer that wakes up need not wait for the next try.
    for (const sign of ["online", "pageshow", "visibilitychange"]) {
      addEventListener(sign, () => this.#hurry());
    }
    this.call();
  }

  call() {
    const socket = this.line.call();
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      socket.send(say.hello(this.token));
      socket.send(say.credit(IN_FLIGHT));
      this.taken = 0;
    };
    socket.onmessage = ({ data }) => this.#hear(data);
    socket.onclose = ({ code, reason }) => this.#lost(code, reason);
    this.socket = socket;
    this.answered = false;
    this.silence = 0;
    this.#wait(() => this.#hangUp(), SILENCE);
  }

  /** @param {string} message one of `say` */
  send(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(message);
  }

  /** To be called once per drawn picture: lets the server send as many frames as have come. */
  returnCredit() {
    if (this.taken > 0) {
      this.send(say.credit(Math.min(this.taken, MAX_CREDITS)));
      this.taken = 0;
    }
    // After a sleep a line may be dead without a word. A page that was busy, hidden or asleep
    // itself has heard nothing either: that time does not count.
    const now = performance.now();
    this.silence += Math.min(now - this.drawn, BUSY);
    this.drawn = now;
    if (this.moving && this.silence > SILENCE) this.#hangUp();
  }

  /** @param {ArrayBuffer | string} data */
  #hear(data) {
    this.silence = 0;
    if (!this.answered) {
      this.answered = true;
      this.failed = 0;
      this.#wait(null);
      this.listener.state("open", "");
    }
    if (typeof data === "string") {
      for (const [key, value] of Object.entries(JSON.parse(data))) {
        this.listener.note(/** @type {keyof Notes} */ (key), value);
      }
      return;
    }
    const message = this.read(data);
    if (message.kind === "scene") this.listener.scene(message.scene);
    else {
      // The ticks beside come with the frame before them, for the same credit.
      if (!message.frame.twin) this.taken++;
      this.moving = message.moving ?? message.frame.playing;
      this.listener.frame(message.frame);
    }
  }

  /** @param {number} code @param {string} reason */
  #lost(code, reason) {
    this.#wait(null);
    this.socket = null;
    this.moving = false;
    if (code === WRONG_TOKEN) {
      this.listener.state(
        "refused",
        "This page belongs to another run. Open the address that the program printed.",
      );
      return;
    }
    this.listener.state(
      "waiting",
      reason ? `Not connected: ${reason}.` : this.line.lost,
    );
    this.#wait(() => this.call(), PATIENCE[Math.min(this.failed, PATIENCE.length - 1)]);
    this.failed++;
  }

  /** Do one thing later, instead of what was to be done. @param {(() => void) | null} act @param {number} [ms] */
  #wait(act, ms) {
    clearTimeout(this.timer);
    this.timer = act === null ? undefined : setTimeout(act, ms);
  }

  /** If the next call is only waited for, make it now. */
  #hurry() {
    if (this.socket === null && this.timer !== undefined && !document.hidden) this.call();
  }

  #hangUp() {
    const socket = /** @type {WebSocket} */ (this.socket);
    socket.onclose = socket.onmessage = null; // closing a dead line can take a minute
    socket.close();
    this.#lost(0, "");
  }
}
