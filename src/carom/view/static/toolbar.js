/** The buttons of the hands' tools: every `[data-tool]` of the page. */

import { press } from "./dom.js";

/** @typedef {import("./tools.js").Tool} Tool */

/** @type {Record<Tool, string>} */
const NAMES = {
  add: "Add balls (A)",
  arrows: "Velocity arrows (D)",
  trail: "Trail of the selected sphere (T)",
  follow: "Follow the selected sphere (O)",
};

/** What concerns the selected sphere alone. @type {Tool[]} */
const ONE = ["trail", "follow"];

/** @param {import("./tools.js").Hands} hands */
export function attachToolbar(hands) {
  /** @type {NodeListOf<HTMLButtonElement>} */
  const buttons = document.querySelectorAll("button[data-tool]");
  const toolOf = (/** @type {HTMLButtonElement} */ button) => /** @type {Tool} */ (button.dataset.tool);
  for (const button of buttons) {
    button.setAttribute("aria-label", NAMES[toolOf(button)]);
    button.title = NAMES[toolOf(button)];
    button.addEventListener("click", () => hands.toggle(toolOf(button)));
  }
  hands.listeners.push(() => {
    for (const button of buttons) {
      const tool = toolOf(button);
      // Without a selected sphere there is nothing to follow, and no trail to see.
      button.classList.toggle("idle", ONE.includes(tool) && hands.selected === null);
      press(button, hands.isOn(tool));
    }
  });
}
