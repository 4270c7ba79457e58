/** The line to the server: says who we are, hands over what comes, and calls again when cut. */
import { MAX_CREDITS, WRONG_TOKEN, decode, say } from "./protocol.js";

const IN_FLIGHT = 2; // frames the server may send ahead: one on its way, one being drawn
const PATIENCE = [250, 500, 1000, 2000]; // milliseconds between calls
const KEY = "carom-token";

/**
 * Take the token out of the address, so that it stays in no history and no screenshot.
 * A reload finds it in the tab's own storage.
 */
export function takeToken() {
  const found = new URLSearchParams(location.hash.slice(1)).get("token");
  if (found !== null) {
    sessionStorage.setItem(KEY, found);
    history.replaceState(null, "", location.pathname);
  }
  return sessionStorage.getItem(KEY) ?? "";
}

/**
 * @typedef {object} Listener
 * @property {(scene: import("./protocol.js").Scene) => void} scene
 * @property {(frame: import("./protocol.js").Keyframe) => void} frame
 * @property {(sentence: string) => void} failure "" when all is well again
 * @property {(state: "open" | "waiting" | "refused", sentence: string) => void} state
 */

export class Connection {
  /** @param {string} token @param {Listener} listener */
  constructor(token, listener) {
    this.token = token;
    this.listener = listener;
    this.calls = 0;
    this.taken = 0; // frames that came since credit was last returned
    /** @type {WebSocket | null} */ this.socket = null;
    this.call();
  }

  call() {
    const socket = new WebSocket(`ws://${location.host}/live`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      socket.send(say.hello(this.token));
      socket.send(say.credit(IN_FLIGHT));
      this.taken = 0;
    };
    socket.onmessage = ({ data }) => this.#hear(data);
    socket.onclose = ({ code, reason }) => this.#lost(code, reason);
    this.socket = socket;
  }

  /** @param {string} message one of `say` */
  send(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(message);
  }

  /** To be called once per drawn picture: lets the server send as many frames as have come. */
  returnCredit() {
    if (this.taken === 0) return;
    this.send(say.credit(Math.min(this.taken, MAX_CREDITS)));
    this.taken = 0;
  }

  /** @param {ArrayBuffer | string} data */
  #hear(data) {
    if (this.calls !== -1) this.listener.state("open", "");
    this.calls = -1;
    if (typeof data === "string") {
      this.listener.failure(JSON.parse(data).failure);
      return;
    }
    const message = decode(data);
    if (message.kind === "scene") this.listener.scene(message.scene);
    else {
      this.taken++;
      this.listener.frame(message.frame);
    }
  }

  /** @param {number} code @param {string} reason */
  #lost(code, reason) {
    if (code === WRONG_TOKEN) {
      this.listener.state(
        "refused",
        "This page belongs to another run. Open the address that the program printed.",
      );
      return;
    }
    this.listener.state(
      "waiting",
      reason ? `Not connected: ${reason}.` : "The simulation has ended. Waiting for it to return …",
    );
    this.calls = Math.max(0, this.calls) + 1;
    setTimeout(() => this.call(), PATIENCE[Math.min(this.calls, PATIENCE.length) - 1]);
  }
}
