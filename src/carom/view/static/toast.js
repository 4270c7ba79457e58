/** Short messages that come and go by themselves. */
import { at, element } from "./dom.js";

const LASTS = 7000; // milliseconds: time to read one sentence twice
const MOST = 3;

/** @param {string} sentence */
export function toast(sentence) {
  const place = at("toasts");
  for (const old of place.children) if (old.firstChild?.textContent === sentence) old.remove();
  while (place.children.length >= MOST) place.firstElementChild?.remove();
  const close = element("button", { type: "button", "aria-label": "Close" }, "×");
  const made = element("p", { class: "toast" }, element("span", {}, sentence), close);
  close.addEventListener("click", () => made.remove());
  place.append(made);
  setTimeout(() => made.remove(), LASTS);
}
