/** What all dialogs share: a title, a button that closes, and closing by a click beside them. */
import { at, element } from "./dom.js";

export class Dialog {
  /** @param {string} id of a <dialog> @param {string} title @param {...Node} content */
  constructor(id, title, ...content) {
    /** @type {HTMLDialogElement} */ this.place = at(id);
    const close = element("button", { type: "button", class: "close", "aria-label": "Close" }, "×");
    close.title = "Close (Esc)";
    close.addEventListener("click", () => this.close());
    const name = element("h2", { id: `${id}-title` }, title);
    const body = element("div", { class: "body" }, ...content);
    this.place.append(element("header", {}, name, close), body);
    // The dialog itself is hit only outside its content, that is on the backdrop.
    this.place.addEventListener("click", (event) => {
      if (event.target === this.place) this.close();
    });
  }

  open() {
    // showModal keeps the focus inside, makes Escape close it, and gives the focus back.
    if (!this.place.open) this.place.showModal();
  }

  close() {
    this.place.close();
  }
}
