/** The folding sections of the panel stay as they were left. */
import { recall, remember } from "./store.js";

/** @param {HTMLElement} panel */
export function keepSections(panel) {
  for (const section of panel.querySelectorAll("details")) {
    if (!section.id) continue;
    const kept = recall(section.id);
    if (kept !== null) section.open = kept === "open";
    section.addEventListener("toggle", () => remember(section.id, section.open ? "open" : "closed"));
  }
}
