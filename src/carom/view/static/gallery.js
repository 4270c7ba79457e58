/** A card for every scene of the library. */
import { Dialog } from "./dialog.js";
import { element } from "./dom.js";

const PHASE = /^phase-\d$/; // scenes that follow the paper

export class Gallery {
  /** @param {(name: string) => void} load */
  constructor(load) {
    this.load = load;
    this.grid = element("div", { class: "cards" });
    this.dialog = new Dialog("gallery", "Choose a scene", this.grid);
    /** @type {Promise<Set<string>> | null} */ this.pictures = null;
    /** @type {import("./protocol.js").Entry[]} */ this.entries = [];
    this.stale = true;
  }

  /** @param {import("./protocol.js").Entry[]} entries */
  setCatalogue(entries) {
    this.entries = entries;
    this.stale = true;
  }

  /** @param {string | null} current name of the scene that runs */
  async open(current) {
    this.dialog.open();
    if (this.stale) {
      this.stale = false;
      this.pictures ??= pictureNames();
      const pictures = await this.pictures;
      this.grid.replaceChildren(...this.#cards(pictures));
    }
    for (const card of this.grid.querySelectorAll("button")) {
      const here = card.dataset.name === current;
      if (here) card.setAttribute("aria-current", "true");
      else card.removeAttribute("aria-current");
      if (here) card.focus();
    }
  }

  /** @param {Set<string>} pictures */
  #cards(pictures) {
    const cards = this.entries.map((entry) => this.#card(entry, pictures));
    const first = cards.findIndex(({ dataset }) => PHASE.test(dataset.name ?? ""));
    const heading = element("h3", {}, "The five phases, as in the paper");
    return first < 0 ? cards : [...cards.slice(0, first), heading, ...cards.slice(first)];
  }

  /** @param {import("./protocol.js").Entry} entry @param {Set<string>} pictures */
  #card({ name, title, description }, pictures) {
    // A scene that somebody wrote has no picture: the icon stands for it.
    const src = pictures.has(name) ? `/gallery/${name}.webp` : "/icon.svg";
    const picture = element("img", { src, alt: "", width: "320", height: "200", loading: "lazy" });
    if (!pictures.has(name)) picture.className = "icon";
    const card = element(
      "button",
      { type: "button", "data-name": name },
      picture,
      element("strong", {}, title),
      element("span", {}, description),
    );
    card.addEventListener("click", () => {
      this.dialog.close();
      this.load(name);
    });
    return card;
  }
}

/** Which scenes have a picture: asking for one that is not there would be an error in the console. */
async function pictureNames() {
  try {
    const answer = await fetch("/gallery.json");
    return new Set(answer.ok ? await answer.json() : []);
  } catch {
    return new Set();
  }
}
