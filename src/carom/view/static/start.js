/** How pages begin, each with its own share of the elements. */
import { at } from "./dom.js";
import { offered } from "./keys.js";

/** Take away what this page has no use for. @param {import("./keys.js").Mode} mode */
export function showOnly(mode) {
  document.body.dataset.mode = mode;
  for (const place of document.querySelectorAll("[data-only]")) {
    const { only } = /** @type {HTMLElement} */ (place).dataset;
    /** @type {HTMLElement} */ (place).hidden = !offered(only, mode);
  }
  // Elsewhere the title opens no gallery.
  /** @type {HTMLButtonElement} */ (at("title-button")).disabled = mode !== "live";
}

/** Start a page, or say on it why it cannot start. @param {() => object | Promise<object>} make */
export async function startPage(make) {
  try {
    // For the browser's console: everything on the page hangs on this one name.
    /** @type {any} */ (globalThis).carom = await make();
  } catch (error) {
    const place = at("connection");
    place.textContent = `The view cannot start: ${/** @type {Error} */ (error).message}.`;
    place.hidden = false;
    throw error;
  }
}
