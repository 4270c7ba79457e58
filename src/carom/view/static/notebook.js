/**
 * The front end of the notebook's widget: the page in a frame of its own, and a line to the kernel
 * through the widget's messages. Frames share no names, styles or keys, so any number can be open.
 *
 * @typedef {object} Model what anywidget hands over
 * @property {(name: string) => any} get
 * @property {(content: object) => void} send
 * @property {(event: string, act: (content: any, buffers: DataView[]) => void) => void} on
 * @property {(event: string, act: (content: any, buffers: DataView[]) => void) => void} off
 */

/** @param {{model: Model, el: HTMLElement}} host */
function render({ model, el }) {
  const view = crypto.randomUUID?.() ?? String(Math.random()); // one widget can be shown many times
  const frame = document.createElement("iframe");
  /** @type {MessagePort | null} */ let line = null;
  frame.title = model.get("title");
  frame.style.cssText = `display: block; width: 100%; height: ${model.get("height")}px; border: 0; border-radius: 8px`;
  // The page needs nothing of the notebook's.
  frame.setAttribute("sandbox", "allow-scripts allow-downloads");
  frame.allow = "fullscreen; clipboard-write";
  frame.srcdoc = model.get("page");
  // A page asks for its line when it begins, and begins anew whenever the notebook moves the cell.
  const answer = (/** @type {MessageEvent} */ { source, data }) => {
    if (source === null || source !== frame.contentWindow || data !== "carom") return;
    line?.close();
    const { port1, port2 } = new MessageChannel();
    line = port1;
    line.onmessage = ({ data }) => model.send({ view, text: data });
    frame.contentWindow.postMessage("carom", "*", [port2]);
  };
  /** @param {{view: string, text?: string}} content @param {DataView[]} buffers */
  const hear = (content, buffers) => {
    if (content.view !== view) return;
    if (content.text !== undefined) line?.postMessage(content.text);
    for (const { buffer, byteOffset, byteLength } of buffers) {
      const message = buffer.slice(byteOffset, byteOffset + byteLength);
      line?.postMessage(message, [/** @type {ArrayBuffer} */ (message)]);
    }
  };
  if (model.get("live")) {
    addEventListener("message", answer);
    model.on("msg:custom", hear);
  }
  el.append(frame);
  return () => {
    removeEventListener("message", answer);
    model.off("msg:custom", hear);
    line?.close();
    frame.remove();
  };
}

export default { render };
