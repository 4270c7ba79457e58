"""One and two spheres, where every answer has a closed form."""

import math

import numpy as np

from carom import place
from carom.errors import RunError
from carom.observe import Estimate
from carom.random_numbers import Random
from carom.rules import Smooth
from carom.simulation import Simulation
from carom.state import Floats
from carom.validate.references import CLOSED, DIGITS, table
from carom.validate.row import Check, Found
from carom.validate.runs import columns, mean_of, of_blocks
from carom.walls import Box, Periodic, Plane, Sphere

EPS = float(np.finfo(float).eps)


def two_bodies(size: float) -> list[Found]:
    """Sixty-four pairs: generic, boosted, far out, grazing, of unlike mass, missing."""
    rows = table("two_body")
    lateness, turned, met = 0.0, 0.0, 0
    for row in rows:
        places = np.array([columns(row, *(f"{axis}{k}" for axis in "xyz")) for k in "12"])
        speeds = np.array([columns(row, *(f"v{axis}{k}" for axis in "xyz")) for k in "12"])
        radius, contact = columns(row, "r1", "r2"), float(row["t"])
        sim = Simulation(rule=Smooth(float(row["e"])))
        sim.add_many(places, velocity=speeds, radius=radius, mass=columns(row, "m1", "m2"))
        try:
            sim.run(collisions=1)
        except RunError:
            continue
        met += 1
        if math.isnan(contact):
            continue
        after = np.array([columns(row, *(f"u{axis}{k}" for axis in "xyz")) for k in "12"])
        late, swerve = _rounding(places, speeds, radius, contact)
        lateness = max(lateness, abs(sim.time - contact) / late)
        turned = max(turned, float(np.abs(sim.velocity - after).max()) / swerve)
    found = Found("64 pairs of spheres", 2, met)
    expected = sum(not math.isnan(float(row["t"])) for row in rows)
    found.exact("pairs-met", "pairs that meet", met, expected, 0.5, DIGITS)
    note = "over what rounding can do"
    found.exact("pairs-time", "worst error of a time", lateness, 0.0, 1.0, DIGITS, note)
    found.exact("pairs-velocity", "worst error of a velocity", turned, 0.0, 1.0, DIGITS, note)
    return [found]


def _rounding(
    places: Floats, speeds: Floats, radius: Floats, contact: float
) -> tuple[float, float]:
    """How far rounding alone can move the time of contact, and the velocities after it.

    The error of |r x v|^2, about eps sigma |r| v^2, moves the root by eps |r|/v_n; the normal
    turns by the error of places at the contact.
    """
    r, v = places[0] - places[1], speeds[0] - speeds[1]
    normal = r + v * contact
    approach = abs(v @ normal) / np.linalg.norm(normal)
    late = 20 * EPS * (contact + np.linalg.norm(r) / approach)
    reach = np.abs(places + speeds * contact).max()
    turn = (20 * EPS * reach + np.linalg.norm(v) * late) / radius.sum()
    swerve = 20 * EPS * np.abs(speeds).max() + 4 * np.linalg.norm(v) * turn
    return float(late), float(swerve)


def bouncing_ball(size: float) -> list[Found]:
    """A ball of mass 3 dropped on a floor: bounces, heights, energy, rest."""
    height, e, g, mass = 2.5, 0.8, 2.0, 3.0
    sim = Simulation(walls=Plane((0, 0, 1), 0, restitution=e), gravity=(0, 0, -g))
    sim.add(position=(0, 0, height + 0.5), mass=mass)
    fall = math.sqrt(2 * height / g)
    source = f"{CLOSED} (geometric series)"
    energy = sim.potential_energy - mass * g * 0.5
    sim.run(until=fall * (1 + e))  # the first peak
    peak = float(sim.position[0, 2]) - 0.5
    sim.run(until=1.001 * fall * (1 + e) / (1 - e))
    times = sim.events["time"]  # of bounce 2 and later
    found = Found(f"ball on a floor, e = {e:g}", 1, 1 + len(times))
    found.exact("ball-peak", "height of the first peak", peak, e * e * height, 1e-12, source)
    tenth = fall * (1 + 2 * sum(e**k for k in range(1, 10)))
    seen = times[8] if len(times) > 8 else math.nan
    found.exact("ball-tenth", "time of bounce 10", seen, tenth, 1e-12 * tenth, source)
    rest = fall * (1 + e) / (1 - e)
    last = times[-1] if len(times) else math.nan
    # It is at rest when it would rise by less than 1e-9 of its radius.
    left = 2 * math.sqrt(2 * g * 0.5e-9) / (g * (1 - e))
    found.exact("ball-rest", "time of rest", last, rest, left, source, "rise below 1e-9 R")
    found.exact("ball-energy", "m g h at the start", energy, mass * g * height, 1e-12, CLOSED)
    lost = sim.dissipated
    found.exact("ball-lost", "energy dissipated", lost, mass * g * height, 1e-8, CLOSED)
    return [found]


def ball_on_ball(size: float) -> list[Found]:
    """A ball dropped on the top of a fixed one, off which it bounces straight up."""
    height, g, below, own, bounces = 1.7, 3.0, 2.0, 0.25, 20
    sim = Simulation(gravity=(0, 0, -g))
    sim.add(position=(0, 0, 0), radius=below, fixed=True)
    sim.add(position=(0, 0, below + own + height), radius=own)
    sim.run(collisions=bounces)
    fall = math.sqrt(2 * height / g)
    found = Found("ball dropped on a fixed ball", 2, bounces)
    source, last = CLOSED, (2 * bounces - 1) * fall
    found.exact("top-time", f"time of bounce {bounces}", sim.time, last, 1e-11 * last, source)
    sim.run(duration=fall)
    peak = float(sim.position[1, 2]) - below - own
    found.exact("top-peak", f"height after bounce {bounces}", peak, height, 1e-11, source)
    return [found]


def in_a_box(size: float) -> list[Found]:
    """One ball in a box: its path is a straight line, folded."""
    sides, start, v = np.array([4.0, 5.0, 6.0]), np.array([0.3, -0.9, 1.7]), (1.1, -0.7, 0.45)
    sim = Simulation(walls=Box(*sides), keep_events=0)
    sim.add(position=start, velocity=v, radius=0.25)
    sim.run(until=12345.0)
    free = sides - 0.5
    walked = start + free / 2 + np.array(v) * 12345.0
    folded = free / 2 - np.abs(walked % (2 * free) - free)
    found = Found("ball in a box", 1, sim.wall_collisions)
    off = float(np.abs(sim.position[0] - folded).max())
    found.exact("box-place", "error of its place", off, 0.0, 1e-9, CLOSED)
    hits = int(np.abs(np.floor(walked / free)).sum())
    found.exact("box-hits", "hits of walls", sim.wall_collisions, hits, 0.5, CLOSED)
    return [found]


def in_a_sphere(size: float) -> list[Found]:
    """One ball in a hollow sphere, to bounce 1000: equal chords."""
    rows = [row for row in table("sphere_container_single") if row["n"] == "1000"]
    place, time = 0.0, 0.0
    for row in rows:
        radius, own = columns(row, "R", "a")
        sim = Simulation(walls=Sphere(radius), keep_events=0)
        sim.add(position=columns(row, *"xyz"), velocity=columns(row, "vx", "vy", "vz"), radius=own)
        sim.run(events=1000)
        speed = float(np.linalg.norm(sim.velocity[0]))
        end = columns(row, "X_n", "Y_n", "Z_n")
        place = max(place, float(np.abs(sim.position[0] - end).max()) / radius)
        time = max(time, abs(sim.time - float(row["t_n"])) * speed / radius)
    found = Found("ball in a hollow sphere", 1, 1000)
    note = f"worst of {len(rows)} starts; rounding walks as n^1.5"
    found.exact("hollow-place", "error of place 1000, in R", place, 0.0, 1e-10, DIGITS, note)
    found.exact("hollow-time", "error of way 1000, in R", time, 0.0, 1e-10, DIGITS, note)
    return [found]


def sinai(size: float) -> list[Found]:
    """Two spheres in a periodic cube, the Sinai billiard in three dimensions."""
    length, starts, each = 2.5, 25, int(4000 * size)
    paths, approaches = [], []
    for seed in range(1, starts + 1):
        random = Random(seed)
        sim = Simulation(walls=Periodic(length, length, length))
        places = place.random_positions(random, np.full(2, 0.5), np.full(3, length), (True,) * 3)
        sim.add_many(places, velocity=random.normal(2, 3))
        speed = float(np.linalg.norm(sim.velocity[0] - sim.velocity[1]))
        sim.run(collisions=each)
        paths.append(speed * sim.time / each)
        approaches.append(float(mean_of(sim.events).mean()) / speed)  # J = v_n m/2 2
    found = Found("2 spheres in a cube of 2.5", 2, starts * each)
    path = (length**3 - 4 * math.pi / 3) / math.pi
    source = "Sinai's billiard: free volume/(π σ²)"
    measured: Estimate = of_blocks(paths)
    found.against("sinai-path", "relative way between collisions", measured, path, source)
    source = "Sinai's billiard: 2/3 of the relative speed"
    found.against("sinai-approach", "speed of approach", of_blocks(approaches), 2 / 3, source)
    return [found]


def checks() -> list[Check]:
    """All of this file."""
    return [
        Check("pairs", "pairs", two_bodies, 0.5),
        Check("ball", "ball", bouncing_ball, 0.1),
        Check("top", "ball", ball_on_ball, 0.1),
        Check("box", "ball", in_a_box, 0.1),
        Check("hollow", "ball", in_a_sphere, 0.2),
        Check("sinai", "sinai", sinai, 2.2, 4),
    ]
