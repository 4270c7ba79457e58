"""The live plots in a real browser: their numbers against the engine's, and their pixels."""

import dataclasses
import math
import re
import time

import numpy as np
import pytest

import carom
from carom import scenes
from carom.view.pressure import WallPressure

from .png import pixels

ALL = ("Speeds", "Energy", "Momentum", "Collision rate", "Pressure on walls")


@pytest.fixture
def plot(show):
    """Show a simulation with its plots, those with the names given open."""

    def open_plots(sim, *names, **options):
        shown = show(sim, **options)
        if not shown.page.locator("#panel").is_visible():  # a phone
            shown.page.keyboard.press("p")
        shown.js(
            """() => {
              for (const part of document.querySelectorAll("#panel > details"))
                part.open = part.id === "section-plots";
            }"""
        )
        for name in ALL:
            shown.js(
                f"""() => {{
                  for (const {{ details, title }} of carom.plots.sections)
                    if (title === "{name}") details.open = {str(name in names).lower()};
                }}"""
            )
        return shown

    return open_plots


def section(shown, name):
    return shown.page.locator("#plots details").filter(
        has=shown.page.get_by_role("heading", name=name, exact=True)
    )


def says(shown, name, pattern, seconds=10.0):
    """Wait until the words of a section fit a pattern; the match."""
    end = time.perf_counter() + seconds
    while True:
        text = section(shown, name).inner_text().replace("\u202f", "").replace("\u00a0", " ")
        if match := re.search(pattern, text, re.DOTALL):
            return match
        assert time.perf_counter() < end, f"{pattern!r} is not in {text!r}"
        time.sleep(0.05)


def slow(scene):
    """The scene, standing nearly still."""
    return dataclasses.replace(scene, pace=1e-9)


def drawn(shown, name):
    """Pixels of a chart."""
    return pixels(section(shown, name).locator("canvas").screenshot()).astype(float)


def like(picture, color, within=40):
    """Where the picture has about this colour."""
    return np.abs(picture - color).max(axis=2) < within


def paint(shown, name):
    """Red, green, blue of one of the plots' colours."""
    color = shown.js(f"getComputedStyle(carom.plots.container).getPropertyValue('{name}')").strip()
    return np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)])


def test_at_the_start_all_speeds_are_one(plot):
    shown = plot(carom.Simulation(slow(scenes.gas(n=500))), "Speeds")
    says(shown, "Speeds", r"Not yet Maxwell–Boltzmann: χ²/df .* p < 0\.001\..*500 speeds")
    bars = like(drawn(shown, "Speeds"), paint(shown, "--plot-bars"))
    columns = np.flatnonzero(bars.sum(axis=0) > 3)
    assert 4 <= len(columns) <= 14  # one bar


def test_after_a_while_they_agree(plot):
    sim = carom.Simulation(slow(scenes.gas(n=500)))
    sim.run(duration=25)
    shown = plot(sim, "Speeds")
    match = says(shown, "Speeds", r"Agrees with Maxwell–Boltzmann: χ²/df = ([\d.]+), p = (0\.\d+)")
    assert 0.2 < float(match[1]) < 2
    assert 0.01 <= float(match[2]) <= 1
    # The bars are the engine's speeds.
    shown.settle()
    width, bars = shown.js(
        """(() => { const { width, bars } = carom.plots.speeds.histogram(carom.plots.frame);
                   return [width, [...bars]]; })()"""
    )
    speed = np.linalg.norm(sim.velocity, axis=1)
    expected, _ = np.histogram(speed, bins=len(bars), range=(0, width * len(bars)))
    assert np.array(bars) * width * 500 == pytest.approx(expected, abs=1.01)
    assert np.abs(np.array(bars) * width * 500 - expected).sum() <= 4  # f4 on the wire
    assert width * len(bars) == pytest.approx(4.5 * math.sqrt(sim.temperature), rel=1e-6)
    # Bars rise and fall, and the line of theory runs through all of the plot.
    picture = drawn(shown, "Speeds")
    height = like(picture, paint(shown, "--plot-bars")).sum(axis=0)
    assert height.max() > 60
    assert np.argmax(height) < 0.6 * len(height)
    line = like(picture, paint(shown, "--plot-theory")).any(axis=0)
    assert line.mean() > 0.7


def test_few_spheres_are_judged_by_their_own_law(plot):
    scene = dataclasses.replace(scenes.gas(n=6, packing_fraction=0.1), pace=40)
    shown = plot(carom.Simulation(scene), "Speeds")
    says(shown, "Speeds", r"Collecting: \d+ of 40")
    shown.js("carom.connection.send(JSON.stringify({op: 'speed', value: 20}))")
    match = says(
        shown, "Speeds", r"the exact law of 6 spheres: .*p (?:=|<) ([\d.]+).*\n(\d+) speeds", 20
    )
    assert int(match[2]) >= 40
    assert "Maxwell–Boltzmann" in section(shown, "Speeds").inner_text()


def test_an_ideal_gas_keeps_its_speeds(plot):
    scene = dataclasses.replace(scenes.gas(n=100), collide=False)
    shown = plot(carom.Simulation(scene), "Speeds", "Collision rate")
    says(shown, "Speeds", "nothing mixes the speeds")
    says(shown, "Collision rate", "pass through one another")
    assert section(shown, "Collision rate").locator("canvas").is_hidden()


def test_momentum_is_flat_and_the_rate_is_enskogs_in_a_fluid(plot):
    sim = carom.Simulation(scenes.fluid(n=500, packing_fraction=0.1))
    sim.run(duration=20)
    start, before = sim.time, sim.collisions
    shown = plot(sim, "Momentum", "Collision rate")
    shown.wait("carom.plots.rates.trace.length >= 3", 30)
    shown.settle()
    time.sleep(0.4)
    says(shown, "Momentum", r"\|P\| = [\d.]+ × 10⁻.*Conserved: nothing pushes from outside\.")
    rows = np.array(shown.js("[5, 6, 7].map((column) => [...carom.plots.past.column(column)])"))
    assert rows.shape[1] > 5
    assert np.nanmax(np.abs(rows)) < 1e-10
    assert rows[:, -1] == pytest.approx(sim.momentum, abs=1e-12)
    picture = drawn(shown, "Momentum")
    flat = like(picture, paint(shown, "--plot-3")).sum(axis=1)
    assert flat.max() > 0.6 * picture.shape[1]
    assert np.count_nonzero(flat) <= 4  # the rows of one flat line
    # The rate: counted, and by Enskog's theory.
    rate, error = shown.js("Object.values(carom.plots.rates.recent())")
    counted = (sim.collisions - before) / (sim.time - start)
    assert rate == pytest.approx(counted, abs=4 * error)
    match = says(shown, "Collision rate", r"counted\s+([\d.]+) ± ([\d.]+).*Enskog, bulk\s+([\d.]+)")
    assert float(match[1]) == pytest.approx(rate, rel=0.01)
    # ω = 1.765845 at φ = 0.1, with the contact value of the best known equation of state.
    assert float(match[3]) == pytest.approx(500 * 1.765845 / 2, rel=0.005)
    assert rate == pytest.approx(float(match[3]), abs=6 * error + 0.01 * rate)
    line = like(drawn(shown, "Collision rate"), paint(shown, "--plot-1"))
    assert line.any(axis=0).mean() > 0.6


def test_energies_are_the_engines(plot):
    sim = carom.Simulation(scenes.bounce(n=25))
    shown = plot(sim, "Energy")
    shown.wait("carom.plots.past.length > 15")
    shown.settle()
    shown.wait(f"carom.plots.past.end === {sim.time!r}")
    row = shown.js("[1, 2, 3, 4].map((c) => carom.plots.past.at(carom.plots.past.length - 1, c))")
    assert row[:3] == pytest.approx([sim.kinetic_energy, sim.potential_energy, sim.dissipated])
    total = np.array(shown.js("[...carom.plots.past.column(4)]"))
    assert np.ptp(total[np.isfinite(total)]) < 1e-9 * abs(row[2])  # nothing is lost from the books
    time.sleep(0.4)
    text = says(shown, "Energy", r"kinetic\s+(\S+).*potential\s+(\S+).*lost in collisions\s+(\S+)")
    for shown_as, value in zip(text.groups(), row, strict=False):
        assert float(shown_as.replace("−", "-")) == pytest.approx(value, rel=1e-3)
    picture = drawn(shown, "Energy")
    for name, least in (("--plot-1", 0.4), ("--plot-2", 0.4), ("--plot-3", 0.4), ("--plot-4", 0.2)):
        assert like(picture, paint(shown, name)).any(axis=0).mean() > least, name  # 4 is dashed
    label = section(shown, "Energy").locator("canvas").get_attribute("aria-label")
    assert "kinetic" in label
    assert "lost in collisions" in label


def test_a_restart_begins_the_lines_anew(plot):
    shown = plot(carom.Simulation(scenes.phase_4()), "Energy")
    shown.wait("carom.plots.past.length > 8")
    late = shown.js("carom.plots.past.end")
    shown.page.get_by_role("button", name="Restart").click()
    shown.wait("carom.timeline.newest?.epoch === 1")
    shown.wait("carom.plots.past.length > 1")
    times = np.array(shown.js("[...carom.plots.past.column(0)]"))
    assert times[0] < 0.2 * late
    assert (np.diff(times) >= 0).all()


def test_turning_time_round_breaks_the_lines_and_keeps_them(plot):
    sim = carom.Simulation(scenes.bounce(n=25, restitution=1.0))
    shown = plot(sim, "Energy", "Momentum")
    shown.wait("carom.plots.past.length > 10")
    before = shown.js("[carom.plots.past.length, carom.plots.past.start]")
    shown.js("carom.connection.send(JSON.stringify({op: 'reverse'}))")
    shown.wait("carom.timeline.newest?.epoch >= 1")
    shown.wait(f"carom.plots.past.length > {before[0] + 6}")
    shown.settle()
    time.sleep(0.4)
    kinetic, total = np.array(shown.js("[1, 4].map((c) => [...carom.plots.past.column(c)])"))
    assert np.count_nonzero(np.isnan(kinetic)) == 1
    assert np.ptp(total[np.isfinite(total)]) < 1e-9 * np.nanmax(kinetic)
    assert shown.js("carom.plots.past.start") == before[1]
    says(shown, "Energy", "kinetic.*potential.*total")
    picture = drawn(shown, "Energy")
    for name in ("--plot-1", "--plot-2"):
        assert like(picture, paint(shown, name)).any(axis=0).mean() > 0.4, name


def test_pressure_on_each_wall_beside_theory(plot):
    shown = plot(carom.Simulation(slow(scenes.gas(n=50))), "Pressure on walls")
    shown.js(
        """(() => {
          const walls = { pressure: [2, 1, 2, 2, 2, 2], theory: 1.6, duration: 24 };
          carom.plots.walls(walls);
          carom.plots.walls = () => {};  // and nothing newer
        })()"""
    )
    says(shown, "Pressure on walls", r"15 % above theory\..*Averaged over a time of 24")
    bars = like(drawn(shown, "Pressure on walls"), paint(shown, "--plot-bars"), within=12)
    lengths = bars.sum(axis=1)
    lengths = [lengths[2 + 20 * k + 10] for k in range(6)]
    assert lengths[1] / lengths[0] == pytest.approx(0.5, abs=0.03)
    assert np.ptp(np.delete(lengths, 1)) <= 8  # where the line of theory crosses
    theory = like(drawn(shown, "Pressure on walls"), paint(shown, "--plot-theory")).sum(axis=0)
    assert theory.max() > 50
    assert np.count_nonzero(theory) <= 4
    label = section(shown, "Pressure on walls").locator("canvas").get_attribute("aria-label")
    assert "x+" in label


def test_closed_sections_rest_and_keys_open_them(plot):
    shown = plot(carom.Simulation(scenes.gas(n=100)), "Speeds")
    shown.wait("carom.plots.past.length > 5")
    drawn_at = "carom.plots.parts.energy.drawn"
    assert shown.js(f"{drawn_at} === -Infinity")
    assert shown.js("carom.plots.parts.speeds.drawn > 0")
    summary = section(shown, "Energy").locator("summary")
    summary.focus()
    shown.page.keyboard.press("Enter")
    shown.wait(f"{drawn_at} > 0")
    # At most four times a second.
    moments = shown.js(
        f"""new Promise((done) => {{
          const seen = new Set();
          const end = performance.now() + 1500;
          const look = () => {{
            seen.add({drawn_at});
            if (performance.now() < end) requestAnimationFrame(look);
            else done(seen.size);
          }};
          look();
        }})"""
    )
    assert 3 <= moments <= 8
    section(shown, "Energy").locator("summary").press("Enter")
    time.sleep(0.1)
    closed = shown.js(drawn_at)
    time.sleep(0.6)
    assert shown.js(f"({drawn_at}) === ({closed if math.isfinite(closed) else '-Infinity'})")


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_colours_follow_the_theme_and_text_can_be_read(plot, scheme):
    shown = plot(carom.Simulation(scenes.gas(n=300)), "Speeds", color_scheme=scheme)
    shown.wait("carom.plots.parts.speeds.drawn > 0")
    shown.wait(f"carom.plots.container.dataset.theme === '{scheme}'")
    back = np.array([0x10, 0x15, 0x1F]) if scheme == "dark" else np.array([0xEE, 0xF2, 0xF7])
    for name in ("text", "good", "fair"):  # WCAG 1.4.3
        assert contrast(paint(shown, f"--plot-{name}"), back) >= 4.5, name
    for name in ("theory", "1", "2", "3", "4"):  # lines: WCAG 1.4.11
        assert contrast(paint(shown, f"--plot-{name}"), back) >= 3, name


def contrast(a, b):
    """Of two colours, as the Web Content Accessibility Guidelines define it."""
    parts = [np.where(c <= 10, c / 3294.6, ((c / 255 + 0.055) / 1.055) ** 2.4) for c in (a, b)]
    low, high = sorted(float(part @ [0.2126, 0.7152, 0.0722]) for part in parts)
    return (high + 0.05) / (low + 0.05)


def test_a_phone_has_room_for_them(plot):
    shown = plot(carom.Simulation(scenes.gas(n=60)), *ALL, width=390, height=844)
    shown.wait("carom.plots.sections.every((section) => section.drawn > 0)")
    assert shown.js("document.documentElement.scrollWidth") == 390
    for canvas in shown.page.locator("#plots canvas").all():
        if canvas.is_visible():
            assert 180 <= canvas.bounding_box()["width"] <= 390
    for summary in shown.page.locator("#plots summary").all():
        assert summary.bounding_box()["height"] >= 36


def test_pressure_of_a_gas_is_the_engines(plot):
    shown = plot(carom.Simulation(scenes.gas(n=300)), "Pressure on walls")
    shown.js("carom.controls.ask(20)")
    shown.wait("carom.plots.pressure?.duration > 20", 30)
    shown.settle()
    told = shown.js("carom.plots.pressure")
    gauge = WallPressure(shown.sim.world, shown.sim.state)
    assert told["theory"] == pytest.approx(gauge.theory(shown.sim.temperature), rel=1e-12)
    # Some 1 500 hits, whose momenta vary by half: 2 % by chance.
    assert np.mean(told["pressure"]) == pytest.approx(told["theory"], rel=0.1)
    says(shown, "Pressure on walls", r"(above|below|of|with) theory")
