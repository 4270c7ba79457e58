/** The numbers of the selected sphere, what can be done with it, and what the next ball is like. */
import { element as make, press, put } from "./dom.js";
import { length } from "./matrix.js";
import { count, short } from "./numbers.js";

const PERIOD = 100; // milliseconds between two readings
const PLACES = 4; // digits after which a scene's size no longer counts

/** @param {HTMLElement} element @param {boolean} hidden */
function hide(element, hidden) {
  if (element.hidden !== hidden) element.hidden = hidden;
}

/**
 * With as many decimals for every number of a kind, so that columns stay in line.
 * @param {number} value @param {number} size what is usual in this scene
 */
export function aligned(value, size) {
  const decimals = PLACES - 1 - Math.floor(Math.log10(size || 1));
  if (!Number.isFinite(value) || decimals > 8 || Math.abs(value) >= 1e7) return short(value, 4);
  const text = Math.abs(value).toFixed(Math.min(6, Math.max(0, decimals)));
  return (value < 0 && Number(text) !== 0 ? "−" : "") + text;
}

const ROWS = /** @type {const} */ ([
  ["speed", "Speed"],
  ["energy", "Kinetic energy"],
  ["mass", "Mass"],
  ["radius", "Radius"],
  ["collisions", "Collisions"],
]);

export class Inspector {
  /** @param {HTMLElement} container @param {import("./tools.js").Hands} hands */
  constructor(container, hands) {
    this.hands = hands;
    this.read = -Infinity; // milliseconds
    this.version = -1;
    this.title = make("p", { class: "sphere-title", role: "status" });
    const previous = this.#button("‹", "Previous sphere (shift J)", () => hands.selectNext(-1));
    const next = this.#button("›", "Next sphere (J)", () => hands.selectNext(1));
    this.hint = make("p", { class: "note" }, "Click a sphere in the picture, or go through them here.");
    /** @type {Record<string, HTMLElement[]>} */ this.cells = {};
    this.numbers = this.#numbers();
    this.follow = this.#button("Follow", "Follow this sphere (O)", () => hands.toggle("follow"));
    this.trail = this.#button("Trail", "Trail of the selected sphere (T)", () => hands.toggle("trail"));
    const remove = this.#button("Delete", "Delete this sphere (Delete)", () => hands.remove());
    remove.classList.add("risky");
    remove.hidden = !hands.changes;
    this.actions = make("div", { class: "sphere-actions" }, this.follow, this.trail, remove);
    this.radius = this.#field("Radius", (value) => (hands.next.radius = value));
    this.mass = this.#field("Mass", (value) => (hands.next.mass = value));
    this.form = make(
      "fieldset",
      { class: "next-ball" },
      make("legend", {}, "The next ball"),
      make("label", {}, "Radius", this.radius),
      make("label", {}, "Mass", this.mass),
      make("p", { class: "note" }, "Press in the picture and drag. Enter puts one in its middle, at rest."),
    );
    container.classList.add("inspector");
    container.append(
      make("div", { class: "sphere-head" }, previous, this.title, next),
      this.hint,
      this.numbers,
      this.actions,
      this.form,
    );
    hands.listeners.push((now) => this.show(now));
    this.show(0);
  }

  /** @param {string} text @param {string} name @param {() => void} action */
  #button(text, name, action) {
    const button = make("button", { type: "button", title: name, "aria-label": name.replace(/ \(.*/, "") }, text);
    button.addEventListener("click", () => {
      action();
      this.show(performance.now(), true);
    });
    return button;
  }

  /** @param {string} name @param {(value: number) => void} take */
  #field(name, take) {
    const input = make("input", { type: "number", min: "0", step: "any", inputmode: "decimal" });
    input.setAttribute("aria-label", `${name} of the next ball`);
    input.addEventListener("input", () => {
      const good = input.valueAsNumber > 0 && Number.isFinite(input.valueAsNumber);
      input.setCustomValidity(good ? "" : `${name} must be a number above 0`);
      if (good) take(input.valueAsNumber);
      else input.reportValidity();
      this.hands.version++;
    });
    return input;
  }

  #numbers() {
    const list = make("dl", { class: "numbers" });
    for (const [key, name] of /** @type {const} */ ([
      ["position", "Position"],
      ["velocity", "Velocity"],
    ])) {
      this.cells[key] = ["x", "y", "z"].map((axis) => make("span", { title: axis }));
      list.append(
        make("div", { class: "vector" }, make("dt", {}, name), make("dd", {}, ...this.cells[key])),
      );
    }
    for (const [key, name] of ROWS) {
      this.cells[key] = [make("dd")];
      list.append(make("div", {}, make("dt", {}, name), ...this.cells[key]));
    }
    return list;
  }

  /** @param {number} now milliseconds @param {boolean} [atOnce] */
  show(now, atOnce = false) {
    const { hands } = this;
    const changed = hands.version !== this.version;
    if (!atOnce && now - this.read < PERIOD && now >= this.read) return;
    this.read = now;
    this.version = hands.version;
    const { selected, scene } = hands;
    const sphere = selected === null ? null : hands.stateOf(selected, hands.side);
    if (selected === null || sphere === null || scene === null) put(this.title, "No sphere selected");
    else {
      const twin = hands.sides.length > 1 && hands.side === 1;
      put(this.title, twin ? `Sphere ${selected}, in ticks` : `Sphere ${selected}`);
      this.#read(selected, sphere, scene);
    }
    // Moving the camera by hand ends following, too.
    press(this.follow, hands.isOn("follow"));
    press(this.trail, hands.isOn("trail"));
    if (!changed && !atOnce) return;
    hide(this.hint, selected !== null);
    hide(this.numbers, selected === null);
    hide(this.actions, selected === null);
    hide(this.form, !hands.isOn("add"));
    for (const [input, value] of /** @type {[HTMLInputElement, number][]} */ ([
      [this.radius, hands.next.radius],
      [this.mass, hands.next.mass],
    ])) {
      if (document.activeElement !== input) input.value = String(value);
    }
  }

  /**
   * @param {number} i
   * @param {{x: import("./matrix.js").Vec3, v: import("./matrix.js").Vec3}} sphere
   * @param {import("./protocol.js").Scene} scene
   */
  #read(i, { x, v }, scene) {
    const { reach, sides, side } = this.hands;
    const mass = scene.mass[i];
    const fixed = !Number.isFinite(mass);
    const speed = length(v);
    const fast = scene.about.full_speed;
    x.forEach((part, k) => put(this.cells.position[k], aligned(part, reach)));
    v.forEach((part, k) => put(this.cells.velocity[k], aligned(part, fast)));
    put(this.cells.speed[0], aligned(speed, fast));
    put(this.cells.energy[0], fixed ? "–" : short(0.5 * mass * speed * speed, 4));
    put(this.cells.mass[0], fixed ? "fixed" : short(mass, 4));
    put(this.cells.radius[0], short(scene.radius[i], 4));
    const counts = (sides[side] ?? sides[0]).second.counts;
    put(this.cells.collisions[0], count(counts[i] & 0x7fffffff));
  }
}
