/** The page in a notebook: a frame that speaks to the kernel through the port it is handed. */
import { Connection } from "./connection.js";
import { Page } from "./page.js";
import { decode } from "./protocol.js";
import { startPage } from "./start.js";

/** By what the notebook's author wants spheres to be coloured, or "". */
const color = document.getElementById("data")?.textContent ?? "";
const BUSY = "The notebook is busy or its kernel has ended. The view goes on when it answers.";

/** As much of a `WebSocket` as `Connection` uses. */
class PortSocket {
  /** @param {MessagePort} port */
  constructor(port) {
    this.port = port;
    this.binaryType = "arraybuffer";
    /** @type {number} */ this.readyState = WebSocket.OPEN;
    /** @type {() => void} */ this.onopen = () => {};
    /** @type {((event: MessageEvent) => void) | null} */ this.onmessage = null;
    /** @type {((event: CloseEvent) => void) | null} */ this.onclose = null;
    port.onmessage = (event) => this.onmessage?.(event);
    queueMicrotask(() => this.onopen());
  }

  /** @param {string} message */
  send(message) {
    if (this.readyState === WebSocket.OPEN) this.port.postMessage(message);
  }

  close() {
    this.readyState = WebSocket.CLOSED;
  }
}

/** The port comes with the first message from the notebook, which is asked for it below. */
addEventListener("message", ({ data, ports: [port] }) => {
  if (data !== "carom" || port === undefined) return;
  const call = () => /** @type {any} */ (new PortSocket(port));
  void startPage(() => new Page({
    mode: "widget",
    connect: (listener) => {
      const scene = (/** @type {import("./protocol.js").Scene} */ told) => {
        if (color !== "") told.about.color = /** @type {import("./protocol.js").ColorMode} */ (color);
        listener.scene(told);
      };
      return new Connection("", { ...listener, scene }, /** @type {any} */ (decode), { call, lost: BUSY });
    },
  }));
}, { once: true });
parent.postMessage("carom", "*");
