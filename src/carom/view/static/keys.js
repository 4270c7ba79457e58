/**
 * Every key of the page, once: the help sheet prints this table, tooltips quote it, and the
 * dispatcher obeys it, so none of them can be wrong.
 *
 * @typedef {object} Row
 * @property {string} group
 * @property {string[]} keys as `KeyboardEvent.key` in small letters
 * @property {string} name what it does
 * @property {string[]} [also] keys of neighbours, which do the same and are not printed
 * @property {string} action a name in `Actions`; "hands" and "camera" pass the event on
 * @property {string} [only] pages that have it, all if left out
 *
 * @typedef {"live" | "widget" | "replay"} Mode
 *
 * @typedef {Record<string, () => void>} Actions
 */

/** @type {Row[]} */
export const KEYS = [
  { group: "Time", keys: [" "], name: "Pause or play", action: "toggle" },
  { group: "Time", keys: ["n", "]"], name: "On to the next collision", action: "step" },
  { group: "Time", keys: ["b", "["], name: "Back one collision", action: "back" },
  { group: "Time", keys: ["r"], name: "Restart", action: "restart" },
  { group: "Time", keys: ["v"], name: "Reverse time", action: "reverse" },
  { group: "Time", keys: ["e"], name: "On to the next frame", action: "later", only: "replay" },
  { group: "Time", keys: ["q"], name: "Back one frame", action: "earlier", only: "replay" },
  { group: "Time", keys: [","], name: "Slower", action: "slower" },
  { group: "Time", keys: ["."], name: "Faster", action: "faster" },
  { group: "Time", keys: ["1"], name: "Normal speed", action: "normal" },
  { group: "Spheres", keys: ["j"], name: "Next ball; with shift, previous", action: "hands" },
  { group: "Spheres", keys: ["a"], name: "Add a ball", action: "hands", only: "live widget" },
  { group: "Spheres", keys: ["delete"], also: ["backspace"], name: "Delete the selected ball", action: "hands", only: "live widget" },
  { group: "Spheres", keys: ["d"], name: "Velocity arrows", action: "hands" },
  { group: "Spheres", keys: ["t"], name: "Trail of the selected ball", action: "hands" },
  { group: "Spheres", keys: ["o"], name: "Follow the selected ball", action: "hands" },
  { group: "Spheres", keys: ["w"], name: "Solid or wire", action: "wire" },
  { group: "Spheres", keys: ["c"], name: "Next colour scale", action: "nextColor" },
  { group: "View", keys: ["arrowleft", "arrowright", "arrowup", "arrowdown"], name: "Turn; with shift, move", action: "camera" },
  { group: "View", keys: ["+"], also: ["="], name: "Closer", action: "camera" },
  { group: "View", keys: ["-"], also: ["_"], name: "Farther", action: "camera" },
  { group: "View", keys: ["f"], also: ["home"], name: "Show everything", action: "fit" },
  { group: "View", keys: ["x"], name: "Exact against ticks", action: "compare", only: "live widget" },
  { group: "View", keys: ["m"], name: "Full screen", action: "fullscreen" },
  { group: "Page", keys: ["g"], name: "Choose a scene", action: "gallery", only: "live" },
  { group: "Page", keys: ["p"], name: "Numbers and settings", action: "panel" },
  { group: "Page", keys: ["s"], name: "Change a setting", action: "settings", only: "live widget" },
  { group: "Page", keys: ["l"], name: "Share", action: "share" },
  { group: "Page", keys: ["y"], name: "Save the last minute as a replay", action: "keep", only: "live" },
  { group: "Page", keys: ["k"], name: "Dark or light", action: "theme" },
  { group: "Page", keys: ["?"], name: "Help", action: "help" },
  { group: "Page", keys: ["escape"], name: "Unselect, or leave", action: "hands" },
];

/** @type {Record<string, string>} */
const PRINTED = {
  " ": "space",
  arrowleft: "←",
  arrowright: "→",
  arrowup: "↑",
  arrowdown: "↓",
  delete: "delete",
  escape: "esc",
};

/** How a key is printed. @param {string} key */
export const printed = (key) => PRINTED[key] ?? key.toUpperCase();

/** The row of a key, if it has one. @param {string} key @returns {Row | undefined} */
export const rowOf = (key) => KEYS.find(({ keys, also = [] }) => [...keys, ...also].includes(key.toLowerCase()));

/** Does a page have what is only for some? @param {string | undefined} only @param {string} mode */
export const offered = (only, mode) => only === undefined || only.split(" ").includes(mode);

/** "Restart (R)" for the action `restart`. @param {string} action @param {string} [name] */
export function titleOf(action, name) {
  const row = KEYS.find((each) => each.action === action);
  if (row === undefined) return name ?? action;
  return `${name ?? row.name} (${printed(row.keys[0])})`;
}

/**
 * Keys that an element with the focus uses itself.
 * @param {{tag: string, type: string, role: string}} focus
 * @param {string} key in small letters
 */
export function ownKey({ tag, type, role }, key) {
  if (tag === "textarea" || tag === "select") return true;
  if (tag === "input" && !["range", "radio", "checkbox"].includes(type)) return true;
  const arrow = key.startsWith("arrow");
  if (type === "range") return arrow || ["home", "end", "pageup", "pagedown"].includes(key);
  if (type === "radio") return arrow || key === " ";
  if (type === "checkbox" || role === "switch") return key === " ";
  if (tag === "button" || tag === "summary" || tag === "a") return key === " " || key === "enter";
  return false;
}

/**
 * Listen for keys.
 * @param {Mode} mode
 * @param {Actions} actions
 * @param {(event: KeyboardEvent) => boolean} hands what the tools do with a key; true if anything
 * @param {(event: KeyboardEvent) => boolean} camera the same for the camera
 */
export function listen(mode, actions, hands, camera) {
  let pointing = false; // the focus came by mouse or finger: space still means pause
  addEventListener("pointerdown", () => (pointing = true), true);
  addEventListener("keydown", (event) => {
    if (event.key === "Tab") pointing = false;
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (document.querySelector("dialog[open]") !== null) return;
    const key = event.key.toLowerCase();
    const focus = document.activeElement;
    if (focus instanceof HTMLElement && focus !== document.body) {
      const own = ownKey(
        {
          tag: focus.tagName.toLowerCase(),
          type: focus.getAttribute("type") ?? "",
          role: focus.getAttribute("role") ?? "",
        },
        key,
      );
      if (own && !(pointing && focus instanceof HTMLButtonElement && key === " ")) return;
      // Else the browser would press the button as well when the space bar comes up.
      if (own) focus.blur();
    }
    const row = rowOf(key);
    if (row === undefined || !offered(row.only, mode)) return;
    if (row.action === "camera") camera(event);
    else if (row.action !== "hands") actions[row.action]();
    else if (!hands(event)) {
      if (key === "escape") actions.leave();
      return;
    }
    event.preventDefault();
  });
}
