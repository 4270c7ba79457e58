/** Copying text, also where the browser offers its clipboard to https pages only. */
import { element } from "./dom.js";

/** @param {string} text @returns {Promise<boolean>} whether it was copied */
export async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copyBySelection(text);
  }
}

/** A page on a plain http address of the network has no `navigator.clipboard`. @param {string} text */
function copyBySelection(text) {
  const field = element("textarea", { class: "hidden", readonly: "" });
  field.value = text;
  // Inside an open dialog everything else is inert and cannot be selected.
  const place = document.querySelector("dialog[open]") ?? document.body;
  const focused = document.activeElement;
  place.append(field);
  field.select();
  const done = document.execCommand("copy");
  field.remove();
  if (focused instanceof HTMLElement) focused.focus();
  return done;
}
