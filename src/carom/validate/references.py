"""Numbers from literature and from other programs, each with its source.

Where a formula of `carom.theory` gives the reference, it is not here. Units: the diameter, the
mass and kT are 1, kT = sum m v^2/(3 N - 3).
"""

import csv
from importlib.resources import files
from typing import NamedTuple

EDMD = "EDMD, F. Smallenburg, Eur. Phys. J. E 45, 22 (2022), run for this"
DYNAMO = "DynamO, M. N. Bannerman et al., J. Comput. Chem. 32, 3329 (2011), run for this"
ETOMICA = "etomica's fit to molecular dynamics (HardSphereSolid)"
CLOSED = "closed form"
DIGITS = "closed form, to 60 digits"


class Known(NamedTuple):
    """A number and its standard error."""

    value: float
    error: float


#: N (Z_N - Z) of the fluid by packing fraction: -(rho/2) d ln[d(rho Z)/d rho]/d rho, from the
#: equation of state. N spheres of fixed energy and momentum press that much less.
FLUID_SIZE = {
    0.05: -0.1958,
    0.1: -0.3861,
    0.2: -0.7689,
    0.3: -1.1879,
    0.4: -1.6935,
    0.45: -2.0029,
    0.47: -2.1567,
    0.49: -2.3608,
}

#: Z of the fluid, by (N, packing fraction): EDMD, 1e7 to 6e7 collisions.
EDMD_Z = {
    (500, 0.3): Known(3.982090, 0.000543),
    (500, 0.45): Known(9.401065, 0.001475),
    (4000, 0.1): Known(1.521596, 0.000097),
}

#: Mean free time by density n sigma^3: DynamO, N = 1372, 6e6 collisions and more.
DYNAMO_FREE_TIME = {0.5: Known(0.130267, 0.000064), 0.8: Known(0.0436102, 0.000023)}

#: Z of the face-centred crystal by density; fits by different hands scatter by 3e-4 of it.
CRYSTAL_Z = {1.06: 11.81025, 1.1: 13.26706, 1.2: 19.46844, 1.3: 36.75241}
CRYSTAL_SCATTER = 3e-4

#: Of equal numbers of spheres of diameter 1 and 1/2, mass 1 and 1/8, at packing fraction 0.3:
#: Z, and pairs that meet per volume and time. EDMD, N = 4000.
MIXTURE_Z = Known(3.51616, 0.00148)
MIXTURE_PAIRS = {
    "big-big": Known(2.42598, 0.00249),
    "big-small": Known(4.76863, 0.00411),
    "small-small": Known(1.28296, 0.00211),
}
#: Mean free time of 1 heavy sphere among 39 of diameter 1/2 and mass 1/1000, density 1.4.
COLLOID_FREE_TIME = Known(0.0093850, 0.0000060)

#: By density: DynamO, N = 1372; displacements between lags 5 and 30, the rest by Einstein-Helfand.
DYNAMO_DIFFUSION = {0.5: Known(0.2490, 0.0024), 0.8: Known(0.0664, 0.0008)}
DYNAMO_SHEAR = {0.5: Known(0.538, 0.008), 0.8: Known(2.18, 0.07)}
#: At 0.8 it gave 1.89(7); Enskog says 2.04 and the spread of the pressure of carom's runs 2.2.
DYNAMO_BULK = {0.5: Known(0.410, 0.007)}
DYNAMO_HEAT = {0.5: Known(2.44, 0.10), 0.8: Known(7.99, 0.35)}

#: d ln T/dC of a cooling gas, e = 0.9, packing fraction 0.05: EDMD, N = 4000.
EDMD_COOLING = Known(-0.06287, 0.0003)
#: a2 of a cooling gas by e: simulation of the Boltzmann equation, made for this.
DSMC = "simulation of the Boltzmann equation (DSMC), made for this"
DSMC_A2 = {0.9: Known(-0.0150, 0.0005)}

#: Of the gas of Boltzmann, in mean free times: P(tau > 1, 2) and <tau^2>/<tau>^2; Tait's
#: free path from a moment on, n sigma^2 <v/nu>. Exact quadratures.
QUADRATURE = "exact quadrature of the Boltzmann gas"
SURVIVAL = {1: 0.3609538586, 2: 0.1356627221}
TAU_SQUARED = 2.0761308045
TAIT = 0.2156429269


def table(name: str) -> list[dict[str, str]]:
    """Rows of a table of this package, without the lines that begin with #."""
    text = files("carom.validate").joinpath("data", f"{name}.csv").read_text("utf-8")
    return list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
