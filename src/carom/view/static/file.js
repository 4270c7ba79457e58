/** Hands people a file. */
import { element } from "./dom.js";

/** @param {Blob} blob @param {string} title of which its name is made @param {string} kind "png" */
export function saveFile(blob, title, kind) {
  const name = title.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "");
  const address = URL.createObjectURL(blob);
  element("a", { href: address, download: `${name || "carom"}.${kind}` }).click();
  // The browser has begun to read it once the click was handled.
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
