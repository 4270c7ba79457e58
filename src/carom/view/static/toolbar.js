/** The buttons of the hands' tools: every `[data-tool]` of the page, and the switch of arrows. */

import { press } from "./dom.js";

/** @typedef {import("./tools.js").Tool} Tool */

/** @type {Record<Tool, string>} */
const NAMES = {
  add: "Add balls (A)",
  arrows: "Velocity arrows (D)",
  trail: "Trail of the selected sphere (T)",
  follow: "Follow the selected sphere (O)",
};

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
  const arrows = document.getElementById("show-arrows");
  arrows?.addEventListener("change", () => hands.toggle("arrows"));
  hands.listeners.push(() => {
    for (const button of buttons) press(button, hands.isOn(toolOf(button)));
    if (arrows instanceof HTMLInputElement) arrows.checked = hands.isOn("arrows");
  });
}
