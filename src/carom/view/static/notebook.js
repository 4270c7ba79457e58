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
  const { port1: line, port2: end } = new MessageChannel();
  frame.title = model.get("title");
  frame.style.cssText = `display: block; width: 100%; height: ${model.get("height")}px; border: 0; border-radius: 8px`;
  // The page needs nothing of the notebook's.
  frame.setAttribute("sandbox", "allow-scripts allow-downloads");
  frame.allow = "fullscreen; clipboard-write";
  frame.srcdoc = model.get("page");
  const live = model.get("live");
  frame.onload = () => frame.contentWindow?.postMessage("carom", "*", [end]);
  line.onmessage = ({ data }) => model.send({ view, text: data });
  /** @param {{view: string, text?: string}} content @param {DataView[]} buffers */
  const hear = (content, buffers) => {
    if (content.view !== view) return;
    if (content.text !== undefined) line.postMessage(content.text);
    for (const { buffer, byteOffset, byteLength } of buffers) {
      const message = buffer.slice(byteOffset, byteOffset + byteLength);
      line.postMessage(message, [/** @type {ArrayBuffer} */ (message)]);
    }
  };
  if (live) model.on("msg:custom", hear);
  el.append(frame);
  return () => {
    model.off("msg:custom", hear);
    line.close();
    frame.remove();
  };
}

export default { render };
