/** The sheet of keys, mouse and touch. */
import { Dialog } from "./dialog.js";
import { element } from "./dom.js";
import { KEYS, offered, printed } from "./keys.js";

/** What pointers do: name, mouse, touch. */
const POINTING = [
  ["Turn", "drag", "one finger"],
  ["Move", "shift-drag", "two fingers"],
  ["Zoom", "wheel", "pinch"],
  ["Select a sphere", "click", "tap"],
  ["Show everything", "double click", "double tap"],
];

export class Help {
  /** @param {import("./keys.js").Mode} mode */
  constructor(mode) {
    const rows = KEYS.filter(({ only }) => offered(only, mode));
    const groups = [...new Set(rows.map(({ group }) => group))];
    const sheets = groups.map((group) =>
      sheet(
        group,
        rows.filter((row) => row.group === group).map(({ keys, name }) => [
          name,
          ...keys.map((key) => element("kbd", {}, printed(key))),
        ]),
      ),
    );
    const pointing = sheet(
      "Mouse and touch",
      POINTING.map(([name, mouse, touch]) => [name, `${mouse} · ${touch}`]),
    );
    const keys = element("div", { class: "sheets" }, ...sheets, pointing);
    const foot = element(
      "p",
      { class: "note" },
      "Collisions are solved, not stepped over: every one happens at its own moment, in slow motion too.",
    );
    this.dialog = new Dialog("help", "Keys, mouse and touch", keys, foot);
  }

  open() {
    this.dialog.open();
  }
}

/** @param {string} title @param {(string | Node)[][]} rows name first */
function sheet(title, rows) {
  const list = element("dl", { class: "keys" });
  for (const [name, ...what] of rows) {
    const keys = what.flatMap((part, k) => (k > 0 ? [" ", part] : [part]));
    list.append(element("div", {}, element("dt", {}, name), element("dd", {}, ...keys)));
  }
  return element("section", {}, element("h3", {}, title), list);
}
