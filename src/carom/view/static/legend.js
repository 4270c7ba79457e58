/**
 * Says what the colours mean, with numbers.
 * @typedef {import("./protocol.js").ColorMode} ColorMode
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./protocol.js").Scene} Scene
 */
import { SCALES, SPECIES, css, saturated, unpack } from "./colors.js";
import { element } from "./dom.js";
import { count, short } from "./numbers.js";
import { roundUp } from "./scales.js";
import { STILL } from "./wire.js";

const HUES = 5; // rows of the energy scale: a sphere keeps its own hue
const FEWEST = 5; // collisions at the end of the scale, at least: one step must not look like all

/**
 * The number at the end of the colour scale.
 * @param {ColorMode} mode @param {Scene} scene @param {Keyframe | undefined} frame the newest, if there is one
 */
export function fullOf(mode, scene, frame) {
  if (mode === "speed") return frame?.fullSpeed ?? scene.about.full_speed;
  if (mode !== "collisions") return frame?.fullEnergy ?? scene.about.full_energy;
  let most = FEWEST;
  for (const each of frame?.counts ?? []) most = Math.max(most, each & ~STILL);
  return roundUp(most);
}

/** @param {HTMLElement} place @param {ColorMode} mode @param {number} full @param {Scene} scene */
export function drawLegend(place, mode, full, scene) {
  place.replaceChildren(...parts(mode, full, scene));
}

/** @param {ColorMode} mode @param {number} full @param {Scene} scene @returns {Node[]} */
function parts(mode, full, scene) {
  if (mode === "energy") {
    const rows = someColors(scene).map((own) => bar([saturated(own, 0), saturated(own, 1)]));
    const note = "Pale: little energy. Strong: much.";
    return [...rows, scale(`${short(full)} +`, "kinetic energy"), element("p", { class: "note" }, note)];
  }
  if (mode === "speed") return [bar(SCALES.speed), scale(`${short(full)} +`, "speed")];
  if (mode === "collisions") return [bar(SCALES.collisions), scale(count(full), "collisions so far")];
  if (mode === "species") return species(scene);
  return [element("p", { class: "note" }, "Each sphere in its own colour.")];
}

/** @param {import("./colors.js").Rgb[]} stops */
function bar(stops) {
  const made = element("div", { class: "bar" });
  made.style.setProperty("--scale", `linear-gradient(90deg, ${stops.map(css).join(", ")})`);
  return made;
}

/** @param {string} end @param {string} name */
function scale(end, name) {
  return element(
    "div",
    { class: "scale" },
    element("span", {}, "0"),
    element("span", { class: "name" }, name),
    element("span", {}, end),
  );
}

/** Some of the colours in the scene, far apart in the list. @param {Scene} scene */
function someColors(scene) {
  const all = [...new Set(scene.color.slice(0, 4096))];
  const rows = Math.min(HUES, all.length);
  return Array.from({ length: rows }, (_, k) => unpack(all[Math.floor((k * all.length) / rows)]));
}

/** @param {Scene} scene */
function species(scene) {
  /** @type {Map<number, number>} */
  const counts = new Map();
  for (const kind of scene.species) counts.set(kind, (counts.get(kind) ?? 0) + 1);
  const kinds = [...counts.keys()].sort((a, b) => a - b).slice(0, SPECIES.length);
  return kinds.map((kind) => {
    const dot = element("span", { class: "dot" });
    dot.style.setProperty("--scale", css(SPECIES[kind % SPECIES.length]));
    const many = element("span", { class: "count" }, count(counts.get(kind) ?? 0));
    return element("div", { class: "species" }, dot, element("span", {}, `species ${kind}`), many);
  });
}
