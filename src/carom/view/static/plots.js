/** The live plots beside the picture: speeds, energy, momentum, collisions, pressure. */
import { barsHeight, drawBars, drawChart, span } from "./chart.js";
import { count, short } from "./numbers.js";
import { Section } from "./section.js";
import { Speeds, freeAxes, verdict } from "./speeds.js";
import { Jumps, RateMeter, Trace, enskog } from "./traces.js";

const EVERY = 250; // milliseconds between drawings of one plot
const FRESH = 0.08; // seconds between rows: new energies come about ten times a second
const STALE = 0.25; // seconds after which the same ones are written down again
const MOST_WALLS = 8; // with a bar of their own
const TINY = 1e-12; // of the whole: less is rounding, and no line or number of its own

/** Columns of the past. */
const [TIME, KINETIC, POTENTIAL, LOST, TOTAL, MOMENTUM] = [0, 1, 2, 3, 4, 5];
const AXES = ["x", "y", "z"];
/** @type {Record<string, string>} */ const TONES = { agrees: "good", doubtful: "fair", not: "fair" };

/**
 * @typedef {import("./protocol.js").Keyframe} Keyframe
 * @typedef {import("./protocol.js").Scene} Scene
 * @typedef {import("./protocol.js").Notes["walls"]} Walls
 * @typedef {import("./section.js").Series} Series
 */

export class Plots {
  /** @param {HTMLElement} container @param {boolean} [pressed] whether pressures will be told */
  constructor(container, pressed = true) {
    this.pressed = pressed;
    this.container = container;
    this.speeds = new Speeds();
    this.past = new Trace(8);
    this.rates = new RateMeter();
    this.jumps = new Jumps();
    /** @type {Scene | null} */ this.scene = null;
    /** @type {Keyframe | null} */ this.frame = null;
    /** @type {Walls | null} */ this.pressure = null;
    this.written = { clock: -Infinity, t: NaN, kinetic: NaN };
    this.enskog = NaN;
    this.parts = {
      speeds: new Section("Speeds", true, (section) => this.#drawSpeeds(section)),
      energy: new Section("Energy", false, (section) => this.#drawEnergy(section)),
      momentum: new Section("Momentum", false, (section) => this.#drawMomentum(section)),
      rate: new Section("Collision rate", false, (section) => this.#drawRate(section)),
      pressure: new Section("Pressure on walls", false, (section) => this.#drawPressure(section)),
    };
    this.sections = Object.values(this.parts);
    container.classList.add("plots");
    container.replaceChildren(...this.sections.map(({ details }) => details));
  }

  /** @param {Scene} scene @param {boolean} fresh whether it is another one, not the same with other spheres */
  setScene(scene, fresh) {
    if (scene.n !== this.scene?.n) this.frame = null;
    this.scene = scene;
    this.speeds.setScene(scene);
    this.enskog = enskog(scene);
    this.parts.pressure.details.hidden = !this.pressed || scene.about.walls.length === 0;
    if (fresh) this.clear();
    this.pressure = null;
  }

  clear() {
    this.past.clear();
    this.rates.clear();
    this.speeds.clear();
    this.jumps = new Jumps();
    this.frame = null;
    this.pressure = null;
    this.written = { clock: -Infinity, t: NaN, kinetic: NaN };
    this.#change();
  }

  /** Take note of a keyframe. @param {Keyframe} frame @param {string} theme "dark" or "light" */
  push(frame, theme) {
    if (this.container.dataset.theme !== theme) {
      this.container.dataset.theme = theme;
      this.#change();
    }
    // The tick side of a split screen has numbers of its own, which are not the physics.
    if (frame.twin || frame.scene !== this.scene?.number) return;
    const jump = this.jumps.happened(frame);
    if (jump) {
      this.past.forget(frame.t);
      this.past.cut();
      this.rates.jump(frame.t);
    }
    this.frame = frame;
    if (this.parts.speeds.open) this.speeds.offer(frame);
    const falls = frame.gravity.some((part) => part !== 0);
    this.rates.push(frame, falls ? NaN : this.enskog * Math.sqrt(frame.temperature));
    this.#write(frame, jump);
    this.#change();
  }

  /** @param {Keyframe} frame @param {boolean} jump */
  #write(frame, jump) {
    const { t, clock, kinetic, potential, dissipated } = frame;
    const waited = clock - this.written.clock;
    const fresh = waited >= FRESH && (kinetic !== this.written.kinetic || waited >= STALE);
    if (t === this.written.t || !(fresh || jump || !frame.playing)) return;
    this.past.push(t, kinetic, potential, dissipated, kinetic + potential + dissipated, ...frame.momentum);
    this.written = { clock, t, kinetic };
  }

  /** Take the pressures. @param {Walls} message */
  walls(message) {
    this.pressure = message;
    this.parts.pressure.changed = true;
  }

  /** Draw what is due: one plot at a time, so that no picture waits for all. @param {number} now milliseconds */
  show(now) {
    const due = this.sections.filter((section) => section.due(now - EVERY));
    due.sort((a, b) => a.drawn - b.drawn)[0]?.draw(now);
  }

  #change() {
    for (const section of this.sections) section.changed = true;
  }

  /** @param {Section} section */
  #drawSpeeds(section) {
    if (this.frame === null) return section.empty("No spheres yet.");
    const histogram = this.speeds.histogram(this.frame);
    const { width, bars, law, maxwell } = histogram;
    const { free } = this.speeds;
    const lines = [];
    /** @type {Series[]} */ const series = [];
    if (maxwell) {
      lines.push({ ...maxwell, color: "--plot-quiet", dash: [4, 3], width: 1.5 });
      series.push({ name: "Maxwell–Boltzmann", color: "--plot-quiet", dash: true });
    }
    if (law) {
      lines.push({ ...law, color: "--plot-theory", width: 2 });
      const name = maxwell ? `exact, ${free.length} spheres` : "Maxwell–Boltzmann";
      series.unshift({ name, color: "--plot-theory" });
    }
    const label = histogram.scaled ? "speed × √(m/kT)" : "speed";
    // The law of very few spheres may rise without limit at its end.
    const most = 10 / (width * bars.length);
    const peaks = lines.map(({ y }) => y.filter((part) => part < most));
    drawChart(section.canvas, {
      x: { low: 0, high: width * bars.length, label },
      y: { ...span([bars, ...peaks], { zero: true }), label: "probability density" },
      bars: { width, heights: bars, color: "--plot-bars" },
      lines,
    });
    const said = verdict(histogram, free.length);
    const note = histogram.samples > 0 ? `${count(histogram.samples)} speeds` : "";
    section.say({ series, words: said, tone: TONES[histogram.opinion], note, now: histogram.fit ? said.split(" ")[0] : "" });
    section.describe(`Histogram of ${note} with the line of theory. ${said}`);
  }

  /** @param {Section} section */
  #drawEnergy(section) {
    const { past } = this;
    const last = this.frame;
    if (last === null) return section.empty("Nothing measured yet.");
    const size = Math.max(past.largest(KINETIC), past.largest(TOTAL));
    const there = (/** @type {number} */ column) => past.largest(column) > TINY * size;
    const all = [
      { column: KINETIC, name: "kinetic", color: "--plot-1", value: last.kinetic, shown: true },
      { column: POTENTIAL, name: "potential", color: "--plot-2", value: last.potential, shown: there(POTENTIAL) },
      { column: LOST, name: "lost in collisions", color: "--plot-3", value: last.dissipated, shown: there(LOST) },
    ];
    const parts = all.filter(({ shown }) => shown);
    const sum = last.kinetic + last.potential + last.dissipated;
    const whole = { column: TOTAL, name: "total", color: "--plot-4", value: sum, dash: true };
    const rows = parts.length > 1 ? [...parts, whole] : parts;
    this.#drawPast(section, rows, "energy", { zero: true });
    section.say({
      series: rows.map(({ value, ...row }) => ({ ...row, value: short(value, 4) })),
      now: short(sum, 4),
    });
    section.describe(`Energy over time. ${rows.map((r) => `${r.name} ${short(r.value, 4)}`).join(", ")}`);
  }

  /** @param {Section} section */
  #drawMomentum(section) {
    const { frame, scene } = this;
    if (frame === null || scene === null) return section.empty("Nothing measured yet.");
    const free = freeAxes(scene.about).map((k) => AXES[k]);
    // What all spheres would have if they flew the same way is the scale: a thousandth is flat.
    const most = Math.sqrt(2 * Math.max(frame.kinetic, this.past.largest(KINETIC)) * this.speeds.total);
    const rows = AXES.map((name, k) => ({
      column: MOMENTUM + k,
      name,
      color: `--plot-${k + 1}`,
      value: Math.abs(frame.momentum[k]) < TINY * most ? "0" : short(frame.momentum[k]),
      // So that all three are seen where they lie on one another.
      width: free.length === 3 ? 4 - 1.2 * k : undefined,
    }));
    this.#drawPast(section, rows, "momentum", { least: most / 500 });
    const length = `|P| = ${short(Math.hypot(...frame.momentum))}`;
    const words =
      free.length === 3
        ? "Conserved: nothing pushes from outside."
        : free.length > 0
          ? `Conserved along ${free.join(" and ")}.`
          : `Not conserved: ${pushers(scene)}.`;
    section.say({ series: rows, now: length, words });
    section.describe(`Momentum over time. ${length}. ${words}`);
  }

  /**
   * @param {Section} section
   * @param {{column: number, color: string, dash?: boolean, width?: number}[]} rows
   * @param {string} label @param {{zero?: boolean, least?: number}} more
   */
  #drawPast(section, rows, label, more) {
    const x = this.past.column(TIME);
    const lines = rows.map(({ column, color, dash, width }) => ({
      x,
      y: this.past.column(column),
      color,
      dash: dash ? [5, 4] : [],
      width,
    }));
    drawChart(section.canvas, {
      x: { ...stretch(this.past), label: "time" },
      y: { ...span(lines.map(({ y }) => y), more), label },
      lines,
    });
  }

  /** @param {Section} section */
  #drawRate(section) {
    const { trace } = this.rates;
    if (this.scene?.about.collide === false) {
      return section.empty("In an ideal gas spheres pass through one another.");
    }
    const [x, y, error, theory] = [0, 1, 2, 3].map((column) => trace.column(column));
    if (trace.length === 0) return section.empty("Counting: a rate needs 25 collisions or more.");
    const above = y.map((value, k) => value + error[k]);
    drawChart(section.canvas, {
      x: { ...stretch(trace), label: "time" },
      y: { ...span([above, theory], { zero: true }), label: "collisions per time" },
      lines: [
        { x, y, error, color: "--plot-1" },
        { x, y: theory, color: "--plot-theory", dash: [5, 3], width: 2 },
      ],
    });
    const mean = this.rates.recent();
    if (mean === null) return section.say({ words: "Counting anew." });
    const now = measured(mean.rate, mean.error);
    /** @type {Series[]} */ const series = [{ name: "counted", color: "--plot-1", value: now }];
    const expected = theory.at(-1) ?? NaN;
    let [words, note] = ["", ""];
    if (expected > 0) {
      series.push({ name: "Enskog, bulk", color: "--plot-theory", dash: true, value: short(expected) });
      words = `${apart(mean.rate, expected, mean.error)} Enskog’s theory.`;
      if ((this.scene?.about.walls.length ?? 0) > 0) {
        note = "The theory is of an endless gas; walls crowd the spheres between them.";
      }
    }
    section.say({ series, words, note, now });
    section.describe(`Collisions per unit of time: ${now}. ${words}`);
  }

  /** @param {Section} section */
  #drawPressure(section) {
    const walls = this.scene?.about.walls ?? [];
    const { pressure, theory, duration } = this.pressure ?? { pressure: [], theory: null, duration: 0 };
    const names = briefly(walls.map(({ name }) => name));
    const all = pressure.flatMap((value, k) => (value === null ? [] : [{ name: names[k], value }]));
    if (pressure.length !== walls.length || !all.some(({ value }) => value > 0)) {
      return section.empty("Waiting for spheres to meet walls that have an end.");
    }
    const bars = all.slice(0, MOST_WALLS);
    section.canvas.style.setProperty("height", barsHeight(bars.length));
    drawBars(section.canvas, bars, { color: "--plot-bars", label: "pressure", theory });
    const mean = all.reduce((sum, { value }) => sum + value, 0) / all.length;
    /** @type {Series[]} */ const series = [{ name: "mean", color: "--plot-bars", value: short(mean) }];
    if (theory !== null) {
      series.push({ name: "theory", color: "--plot-theory", dash: true, value: short(theory) });
    }
    const words = theory === null ? "" : `${apart(mean, theory)} theory.`;
    const more = all.length > bars.length ? ` ${all.length - bars.length} more walls are not drawn.` : "";
    const note = `Averaged over a time of ${short(duration)}.${more}`;
    section.say({ series, words, note, now: short(mean) });
    const list = bars.map(({ name, value }) => `${name} ${short(value)}`).join(", ");
    section.describe(`Pressure on each wall: ${list}. ${words}`);
  }
}

/** Who changes the momentum. @param {Scene} scene */
function pushers({ about, mass }) {
  const all = [];
  if (about.walls.length > 0) all.push("walls");
  if (mass.some((part) => !Number.isFinite(part))) all.push("fixed spheres");
  const falls = about.gravity.some((part) => part !== 0);
  if (all.length === 0) return falls ? "gravity pulls" : "something pushes";
  return falls ? `${all.join(" and ")} push and gravity pulls` : `${all.join(" and ")} push`;
}

/** The axis of time; before there are two moments, some time to come. @param {Trace} trace */
function stretch({ start, end }) {
  return { low: start, high: end > start ? end : start + 1 };
}

/** Names without the words that all of them end with: x−, not "x- wall of the Box". @param {string[]} names */
export function briefly(names) {
  const split = names.map((name) => name.split(" "));
  const ends = (/** @type {number} */ k) =>
    names.length > 1 && split.every((words) => words.length > k && words.at(-k) === split[0].at(-k));
  let same = 0;
  while (ends(same + 1)) same++;
  const brief = split.map((words) => words.slice(0, words.length - same).join(" ").replace(/-$/, "−"));
  const once = (/** @type {string} */ name) => brief.indexOf(name) === brief.lastIndexOf(name);
  return brief.map((name, k) => (once(name) ? name : `${name} ${k + 1}`));
}

/** A number with the digits its error leaves: 47.3 ± 0.9. @param {number} value @param {number} error */
export function measured(value, error) {
  if (!(error > 0)) return short(value);
  const digits = Math.floor(Math.log10(value)) - Math.floor(Math.log10(error)) + 1;
  return `${short(value, Math.min(6, Math.max(2, digits)))} ± ${short(error, 1)}`;
}

/** How far a number is from theory, in words. @param {number} value @param {number} theory @param {number} [error] */
export function apart(value, theory, error = 0) {
  const percent = (100 * Math.abs(value - theory)) / theory;
  if (Math.abs(value - theory) <= 2 * error) return "Agrees with";
  if (percent < 0.5) return "Within 0.5 % of";
  return `${percent < 10 ? percent.toFixed(1) : percent.toFixed(0)} % ${value > theory ? "above" : "below"}`;
}
