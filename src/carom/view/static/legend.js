/** Says what the colours mean, with numbers. */
import { SPECIES, SPEED_SCALE, css, saturated, unpack } from "./colors.js";
import { short } from "./numbers.js";

const HUES = 5; // rows of the energy scale: a sphere keeps its own hue

/**
 * @param {HTMLElement} place
 * @param {import("./renderer.js").ColorMode} mode
 * @param {import("./protocol.js").Scene} scene
 */
export function drawLegend(place, mode, scene) {
  place.replaceChildren(...parts(mode, scene));
}

/** @param {string} tag @param {string} kind @param {string} [text] */
function element(tag, kind, text = "") {
  const made = document.createElement(tag);
  made.className = kind;
  made.textContent = text;
  return made;
}

/** @param {import("./renderer.js").ColorMode} mode @param {import("./protocol.js").Scene} scene */
function parts(mode, scene) {
  const { full_energy, full_speed } = scene.about;
  if (mode === "energy") {
    const rows = someColors(scene).map((own) => bar([saturated(own, 0), saturated(own, 1)]));
    const note = "pale: slow · strong: full of energy";
    return [...rows, scale(full_energy, "kinetic energy"), element("p", "note", note)];
  }
  if (mode === "speed") return [bar(SPEED_SCALE), scale(full_speed, "speed")];
  if (mode === "species") return species(scene);
  return [element("p", "note", "each sphere in its own colour")];
}

/** @param {import("./colors.js").Rgb[]} stops */
function bar(stops) {
  const made = element("div", "bar");
  made.style.setProperty("--scale", `linear-gradient(90deg, ${stops.map(css).join(", ")})`);
  return made;
}

/** @param {number} full @param {string} name */
function scale(full, name) {
  const made = element("div", "scale");
  made.append(
    element("span", "", "0"),
    element("span", "name", name),
    element("span", "", `${short(full)} +`),
  );
  return made;
}

/** Some of the colours in the scene, far apart in the list. @param {import("./protocol.js").Scene} scene */
function someColors(scene) {
  const all = [...new Set(scene.color.slice(0, 4096))];
  const rows = Math.min(HUES, all.length);
  return Array.from({ length: rows }, (_, k) => unpack(all[Math.floor((k * all.length) / rows)]));
}

/** @param {import("./protocol.js").Scene} scene */
function species(scene) {
  /** @type {Map<number, number>} */
  const counts = new Map();
  for (const kind of scene.species) counts.set(kind, (counts.get(kind) ?? 0) + 1);
  const kinds = [...counts.keys()].sort((a, b) => a - b).slice(0, SPECIES.length);
  return kinds.map((kind) => {
    const row = element("div", "species");
    const dot = element("span", "dot");
    dot.style.setProperty("--scale", css(SPECIES[kind % SPECIES.length]));
    row.append(dot, element("span", "", `species ${kind}`));
    row.append(element("span", "count", String(counts.get(kind))));
    return row;
  });
}
