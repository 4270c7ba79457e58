/**
 * Links to a scene of the library with its options: `#scene=gas&n=200&seed=3`.
 * @typedef {number | boolean | string} Value
 * @typedef {{name: string, options: Record<string, Value>}} Origin
 */

/** What the part of an address after `#` asks for; null if no scene. @param {string} hash @returns {Origin | null} */
export function readLink(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const name = given.get("scene");
  if (!name) return null;
  /** @type {Record<string, Value>} */
  const options = {};
  for (const [key, text] of given) if (key !== "scene" && key !== "token") options[key] = read(text);
  return { name, options };
}

/** @param {string} text @returns {Value} */
function read(text) {
  if (text === "true") return true;
  if (text === "false") return false;
  return text.trim() !== "" && Number.isFinite(Number(text)) ? Number(text) : text;
}

/**
 * @param {string} address of the page, without hash
 * @param {string} token lets another tab in while this program runs
 * @param {Origin | null} origin
 */
export function formatLink(address, token, origin) {
  const parts = new URLSearchParams();
  if (token) parts.set("token", token);
  if (origin !== null) {
    parts.set("scene", origin.name);
    for (const [key, value] of Object.entries(origin.options)) parts.set(key, String(value));
  }
  return `${address}#${parts}`;
}

/** Is this scene, with these options among its own, what runs already? @param {Origin} wanted @param {Origin | null} running */
export function runsAlready(wanted, running) {
  return (
    running !== null &&
    running.name === wanted.name &&
    Object.entries(wanted.options).every(([key, value]) => running.options[key] === value)
  );
}
