"""What theory says of hard spheres, to hold measured numbers against.

Each formula is a function of numbers or arrays, in any consistent units with Boltzmann's constant
1. Where it does not hold it refuses, with the limit; `extrapolate=True`, where there is such an
argument, goes on a little. `about` tells the range and the source of any of them, `formulas` their
names; ``docs/theory.md`` is the table of all.

>>> from carom import theory
>>> theory.kolafa_labik_malijevsky([0.1, 0.2]).round(4)
array([1.5216, 2.4094])
"""

from carom.theory.collisions import (
    collision_rate,
    collision_rate_at_speed,
    mean_free_path,
    mean_free_time,
)
from carom.theory.equations_of_state import (
    CLOSE_PACKING,
    VIRIAL,
    carnahan_starling,
    contact_value,
    kolafa_labik_malijevsky,
    speedy_fcc,
    virial_series,
)
from carom.theory.formula import FREEZING, Formula, Range, about, formulas
from carom.theory.free_flight import free_path_cdf, free_path_pdf, free_time_cdf, free_time_pdf
from carom.theory.granular import haff_temperature, haff_temperature_by_collisions, sonine_a2
from carom.theory.granular_mixture import granular_temperature_ratio, temperature_rates
from carom.theory.gravity import barometric_density, mean_height
from carom.theory.mixtures import (
    Moments,
    bmcsl,
    bmcsl_contact,
    mutual_diffusion,
    pair_rates,
    thermodynamic_factor,
)
from carom.theory.rods import rod_collision_rate, rod_force, rod_wall_rate
from carom.theory.rough import rough_ratio, rough_temperatures
from carom.theory.speeds import (
    few_speed_cdf,
    few_speed_pdf,
    maxwell_component_cdf,
    maxwell_component_pdf,
    maxwell_speed_cdf,
    maxwell_speed_pdf,
)
from carom.theory.structure import percus_yevick
from carom.theory.transport import (
    bulk_viscosity,
    finite_size_diffusion,
    self_diffusion,
    shear_viscosity,
    thermal_conductivity,
)
from carom.theory.wall import wall_pressure, wall_tension

__all__ = [
    "CLOSE_PACKING",
    "FREEZING",
    "VIRIAL",
    "Formula",
    "Moments",
    "Range",
    "about",
    "barometric_density",
    "bmcsl",
    "bmcsl_contact",
    "bulk_viscosity",
    "carnahan_starling",
    "collision_rate",
    "collision_rate_at_speed",
    "contact_value",
    "few_speed_cdf",
    "few_speed_pdf",
    "finite_size_diffusion",
    "formulas",
    "free_path_cdf",
    "free_path_pdf",
    "free_time_cdf",
    "free_time_pdf",
    "granular_temperature_ratio",
    "haff_temperature",
    "haff_temperature_by_collisions",
    "kolafa_labik_malijevsky",
    "maxwell_component_cdf",
    "maxwell_component_pdf",
    "maxwell_speed_cdf",
    "maxwell_speed_pdf",
    "mean_free_path",
    "mean_free_time",
    "mean_height",
    "mutual_diffusion",
    "pair_rates",
    "percus_yevick",
    "rod_collision_rate",
    "rod_force",
    "rod_wall_rate",
    "rough_ratio",
    "rough_temperatures",
    "self_diffusion",
    "shear_viscosity",
    "sonine_a2",
    "speedy_fcc",
    "temperature_rates",
    "thermal_conductivity",
    "thermodynamic_factor",
    "virial_series",
    "wall_pressure",
    "wall_tension",
]
