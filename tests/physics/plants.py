"""Errors to plant, mostly a factor of 2, and the checks that must turn red.

What the compiled core would do wrong is planted in what it is handed and in what it returns;
other errors where they would be made, in the formula or the observable.
"""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from carom import mechanics, observe, theory
from carom.engine import FastEngine
from carom.observe import Estimate
from carom.observe.lags import Lagged
from carom.observe.pressure import WallPressure as Walls

Patch = Callable[[object, str, object], None]


@dataclass(frozen=True)
class Plant:
    """An error.

    Attributes
    ----------
    what : str
        For the reader of the report.
    plant : callable
        Is handed ``monkeypatch.setattr``.
    checks : tuple of str
        Names of checks, of which at least one row must turn red.
    """

    what: str
    plant: Callable[[Patch], None]
    checks: tuple[str, ...]


def handed(change):
    """The engine is built from something else than what was described."""

    def plant(patch):
        build = FastEngine.__init__

        def wrong(self, state, world, **options):
            build(self, *change(state, world), **options)

        patch(FastEngine, "__init__", wrong)

    return plant


def formula(name, wrong):
    """A formula of `carom.theory` gives something else: wrong(right, *arguments)."""

    def plant(patch):
        right = getattr(theory, name)
        patch(theory, name, lambda *args, **options: wrong(right, *args, **options))

    return plant


def doubled(right, *args, **options):
    return 2 * np.asarray(right(*args, **options))


def method(cls, name, change):
    """A method returns something else."""

    def plant(patch):
        right = getattr(cls, name)

        def wrong(self, *args, **options):
            return change(right(self, *args, **options))

        patch(cls, name, wrong)

    return plant


def twice(estimate):
    return Estimate(2 * estimate.value, 2 * estimate.error, estimate.n_independent)


def column(name, factor):
    """A table with one column wrong, and its error."""

    def change(table):
        columns = dict(table.columns)
        for one in (name, f"{name}_error"):
            columns[one] = columns[one] * factor
        return dataclasses.replace(table, columns=columns)

    return change


def heavier(state, world):
    state = replace(state, mass=np.where(np.arange(len(state)) == 0, 2, 1) * state.mass)
    return state, world


def thinner(state, world):
    return replace(state, radius=state.radius / 2), world


def heavy_gravity(state, world):
    return state, replace(world, gravity=2 * world.gravity)


def lossy(state, world):
    """Twice the share of energy is lost that 1 - e^2 says."""
    return state, replace(world, restitution=np.sqrt(max(0.0, 2 * world.restitution**2 - 1)))


def lossy_walls(state, world):
    walls = world.walls.copy()
    walls["restitution"] /= 2
    return state, replace(world, walls=walls)


def wide(state, world):
    """Periods of twice the length: half of a period was meant."""
    return state, replace(world, period=2 * world.period)


def strong_impulses(patch):
    take = FastEngine.take_events

    def wrong(self):
        events = take(self).copy()
        events["impulse"] *= 2
        return events

    patch(FastEngine, "take_events", wrong)


def pushed_walls(patch):
    """Walls count half the impulse: m v and not 2 m v."""
    take = FastEngine.take_events

    def wrong(self):
        events = take(self).copy()
        events["impulse"][events["j"] < 0] /= 2
        return events

    patch(FastEngine, "take_events", wrong)


def late_clock(patch):
    take = FastEngine.take_events

    def wrong(self):
        events = take(self).copy()
        events["time"] *= 2
        return events

    patch(FastEngine, "take_events", wrong)


def function(module, name):
    def plant(patch):
        right = getattr(module, name)
        patch(module, name, lambda *args: 2 * right(*args))

    return plant


def half_areas(patch):
    begin = Walls.begin

    def wrong(self, moment):
        begin(self, moment)
        self._areas = self._areas / 2

    patch(Walls, "begin", wrong)


def excess_doubled(right, *args, **options):
    """1 + 2 (Z - 1)."""
    return 2 * np.asarray(right(*args, **options)) - 1


def squared(right, *args, **options):
    """Twice the exponent."""
    return np.asarray(right(*args, **options)) ** 2


def warm(right, height, column, gravity, temperature):
    """The exponent of Boltzmann's factor halved."""
    return right(height, column, gravity, 2 * temperature)


def warm_speeds(right, speed, temperature=1.0, mass=1.0):
    return right(speed, 2 * temperature, mass)


def hot_few(right, speed, n, energy, mass=1.0):
    """Twice as many spheres at the same temperature: the exponent 3n - 4 in place of 3n/2 - 4."""
    return right(speed, 2 * n, energy * (2 * n - 1) / (n - 1), mass)


SINGLE = {
    "the engine": [
        ("twice the gravity", handed(heavy_gravity), ("ball", "ideal")),
        ("radius and diameter confused: spheres half as large", handed(thinner), ("rods", "sinai")),
        ("one of two masses doubled", handed(heavier), ("pairs", "galperin-4")),
        ("twice the energy lost: 1 − e²", handed(lossy), ("pairs",)),
        ("half the restitution of walls", handed(lossy_walls), ("ball", "box")),
        ("periods of twice the length", handed(wide), ("sinai", "fluid-0.3")),
        ("impulses of collisions doubled", strong_impulses, ("fluid-0.3", "fluid-0.1")),
        ("walls take m v, not 2 m v", pushed_walls, ("rods", "ideal", "walls")),
        ("times of events doubled", late_clock, ("ball",)),
    ],
    "mechanics and observables": [
        ("temperature doubled: kT = 4K/f", function(mechanics, "temperature"), ("fluid-0.3",)),
        ("kinetic energy m v²", function(mechanics, "kinetic_energy"), ("ideal", "column")),
        ("potential energy doubled", function(mechanics, "potential_energy"), ("ball", "ideal")),
        ("virial doubled", method(observe.Compressibility, "result", twice), ("fluid-0.3",)),
        ("a collision counted once, not for both",
         method(observe.CollisionRate, "result", column("rate", 0.5)),
         ("fluid-0.3", "md-free-time-0.5")),
        ("pressure tensor doubled",
         method(observe.PressureTensor, "result", column("pressure", 2)), ("fluid-structure",)),
        ("area of walls halved", half_areas, ("walls", "ideal")),
        ("D = ⟨r²⟩/(3 t)", method(observe.Diffusion, "result", column("value", 2)),
         ("diffusion-gas",)),
        ("free times doubled", method(observe.FreeTime, "mean", twice), ("flights",)),
        ("velocities of a memory doubled", method(Lagged, "_means", lambda x: [*map(twice, x)]),
         ("fluid-structure",)),
        ("Helfand's moments without their 2",
         method(observe.ShearViscosity, "result", column("value", 2)), ("transport-0.5",)),
        ("g(r) halved: each pair counted once",
         method(observe.RDF, "result", lambda t: dataclasses.replace(
             t, columns={**t.columns, "g": t["g"] / 2})), ("fluid-structure",)),
        ("temperature of a kind doubled",
         method(observe.Temperature, "result", column("temperature", 2)), ("mixture-half",)),
    ],
    "theory": [
        ("Z − 1 doubled", formula("kolafa_labik_malijevsky", excess_doubled), ("fluid-0.3",)),
        ("Z of the crystal doubled", formula("speedy_fcc", doubled), ("crystal-1.2",)),
        ("rate of collisions doubled", formula("collision_rate", doubled), ("fluid-0.3",)),
        ("contact value doubled", formula("contact_value", doubled), ("flights",)),
        ("mean free time doubled", formula("mean_free_time", doubled), ("flights",)),
        ("share of shorter flights halved",
         formula("free_time_cdf", lambda right, *args: right(*args) / 2), ("flights",)),
        ("virial coefficients: Z − 1 doubled", formula("virial_series", excess_doubled),
         ("fluid-0.1",)),
        ("Carnahan and Starling: Z − 1 doubled", formula("carnahan_starling", excess_doubled),
         ("fluid-0.3",)),
        ("mean free path doubled", formula("mean_free_path", doubled), ("flights",)),
        ("Z − 1 of a mixture doubled", formula("bmcsl", excess_doubled), ("mixture-half",)),
        ("rates of pairs doubled", formula("pair_rates", doubled), ("mixture-half",)),
        ("self-diffusion doubled", formula("self_diffusion", doubled), ("diffusion-gas",)),
        ("shear viscosity doubled", formula("shear_viscosity", doubled), ("transport-0.5",)),
        ("bulk viscosity doubled", formula("bulk_viscosity", doubled), ("transport-0.5",)),
        ("thermal conductivity doubled", formula("thermal_conductivity", doubled),
         ("transport-0.5",)),
        ("correction for size doubled", formula("finite_size_diffusion", doubled),
         ("diffusion-size",)),
        ("cooling by collisions: exponent doubled",
         formula("haff_temperature_by_collisions", squared), ("cooling-0.9",)),
        ("cooling in time: 1/(1 + t/tc)⁴", formula("haff_temperature", squared),
         ("cooling-0.9",)),
        ("a2 doubled", formula("sonine_a2", doubled), ("cooling-0.9",)),
        ("T₁/T₂ − 1 doubled", formula("granular_temperature_ratio", excess_doubled),
         ("two-kinds-0.25-0.8",)),
        ("exponent of Boltzmann's factor halved", formula("barometric_density", warm),
         ("column",)),
        ("mean height doubled", formula("mean_height", doubled), ("column",)),
        ("Maxwell's law: m v²/(4 kT)", formula("maxwell_speed_pdf", warm_speeds), ("maxwell",)),
        ("few speeds: twice as many squares", formula("few_speed_pdf", hot_few), ("few",)),
        ("rate of rods doubled", formula("rod_collision_rate", doubled), ("rods",)),
        ("hits of rods doubled", formula("rod_wall_rate", doubled), ("rods",)),
        ("force of rods doubled", formula("rod_force", doubled), ("rods",)),
        ("pressure on walls doubled", formula("wall_pressure", doubled), ("walls",)),
    ],
}  # fmt: skip

PLANTS = {group: [Plant(*one) for one in plants] for group, plants in SINGLE.items()}
