/** Taking it along: a picture, a link, a command, a program, a scene file. */
import { copyText } from "./clipboard.js";
import { Dialog } from "./dialog.js";
import { element } from "./dom.js";
import { saveFile } from "./file.js";
import { titleOf } from "./keys.js";
import { formatLink } from "./link.js";
import { toast } from "./toast.js";

/**
 * @typedef {object} Needs
 * @property {() => Promise<Blob>} picture
 * @property {(() => void) | null} askSource null where there is no program to ask
 * @property {(() => void) | null} keep saves the last minute; null where nothing is kept
 * @property {string} token
 */

const MOST_ROWS = 12; // of a text; longer ones scroll

export class Share {
  /** @param {Needs} needs */
  constructor(needs) {
    this.needs = needs;
    this.title = "carom";
    /** @type {Blob | null} */ this.blob = null;
    this.preview = element("canvas", { class: "preview", role: "img", "aria-label": "Picture as it is now" });
    const save = element("button", { type: "button", class: "primary" }, "Save picture (PNG)");
    save.addEventListener("click", () => this.#save());
    this.link = field("Link", "Opens this scene in another tab while this program runs; it carries the key that lets the tab in.");
    this.command = field("Command", "Runs it anywhere, once carom is installed.");
    this.python = area("Show as Python", "python");
    this.toml = area("Show as TOML", "toml");
    const left = element("div", { class: "picture" }, this.preview, save);
    const { keep } = needs;
    if (keep !== null) {
      left.append(keepButton(() => {
        this.dialog.close(); // what is said about it would lie beneath
        keep();
      }));
    }
    const right = element("div", { class: "texts" }, this.link.place, this.command.place);
    const top = element("div", { class: "share" }, left, right);
    if (needs.askSource === null) {
      right.hidden = this.python.place.hidden = this.toml.place.hidden = true;
      top.classList.add("alone");
    }
    this.dialog = new Dialog("share", "Share", top, this.python.place, this.toml.place);
  }

  /** @param {string} title @param {import("./link.js").Origin | null} origin */
  open(title, origin) {
    this.title = title;
    this.blob = null; // the one from before shows another moment
    this.link.place.hidden = origin === null;
    this.link.text.value = formatLink(location.origin + location.pathname, this.needs.token, origin);
    this.preview.width = innerWidth;
    this.preview.height = innerHeight;
    this.needs.askSource?.();
    this.dialog.open();
    void this.#draw();
  }

  /** @param {{python: string, toml: string, command: string}} source */
  setSource({ python, toml, command }) {
    this.command.text.value = command;
    this.command.place.hidden = command === "";
    this.python.fill(python);
    this.toml.fill(toml);
  }

  async #draw() {
    this.blob = await this.needs.picture();
    // Drawn, not shown as an image: the page's policy knows no images but the server's own.
    const bitmap = await createImageBitmap(this.blob);
    this.preview.width = bitmap.width;
    this.preview.height = bitmap.height;
    this.preview.getContext("2d")?.drawImage(bitmap, 0, 0);
    bitmap.close();
  }

  async #save() {
    this.blob ??= await this.needs.picture();
    saveFile(this.blob, this.title, "png");
  }
}

/** @param {() => void} keep */
function keepButton(keep) {
  const button = element("button", { type: "button", id: "keep", class: "primary", title: titleOf("keep") }, "Save last minute (replay)");
  button.addEventListener("click", keep);
  return button;
}

/** One line with a button that copies it. @param {string} name @param {string} note */
function field(name, note) {
  const text = element("input", { type: "text", readonly: "", "aria-label": name });
  text.addEventListener("focus", () => text.select());
  const line = element("div", { class: "line" }, text, copyButton(name, text));
  const place = element("div", { class: "field" }, element("h3", {}, name), line, element("p", { class: "note" }, note));
  return { place, text };
}

/** A text that unfolds. @param {string} name @param {string} kind */
function area(name, kind) {
  const text = element("textarea", { readonly: "", spellcheck: "false", wrap: "off", "aria-label": kind });
  const place = element("details", { class: "area" }, element("summary", {}, name), text, copyButton(kind, text));
  /** @param {string} lines */
  const fill = (lines) => {
    text.value = lines;
    text.rows = Math.min(MOST_ROWS, lines.trimEnd().split("\n").length);
  };
  return { place, text, fill };
}

/** @param {string} name @param {HTMLInputElement | HTMLTextAreaElement} source */
function copyButton(name, source) {
  const button = element("button", { type: "button", class: "copy", "aria-label": `Copy ${name.toLowerCase()}` }, "Copy");
  button.addEventListener("click", async () => {
    const done = await copyText(source.value);
    button.textContent = done ? "Copied" : "Press Ctrl-C";
    if (!done) source.select();
    setTimeout(() => (button.textContent = "Copy"), 2000);
    if (!done) toast("This browser does not let pages copy: press Ctrl-C.");
  });
  return button;
}
