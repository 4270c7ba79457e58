"""Measuring while time runs: numbers with error bars, beside what theory says of them.

Give observables to `carom.Simulation.run` with ``observe=``; ask each for its `result`.

Examples
--------
>>> import carom
>>> from carom import observe, theory
>>> sim = carom.Simulation(carom.scenes.fluid(n=500, packing_fraction=0.45, seed=1))
>>> sim.run(collisions=100 * len(sim))
>>> z = observe.Compressibility()
>>> sim.run(collisions=200_000, observe=z)
>>> abs(z.result().deviation(theory.carnahan_starling(0.45))) < 4
True
"""

from carom.observe.batch import Batch, Moment, Twin
from carom.observe.blocking import Settling, blocking, settling
from carom.observe.chaos import Lyapunov
from carom.observe.energy import Energy, MaxOverlap, Temperature
from carom.observe.estimate import Estimate
from carom.observe.flights import FreePath, FreeTime
from carom.observe.lags import MSD, VACF, Diffusion
from carom.observe.observable import Observable
from carom.observe.order import Steinhardt
from carom.observe.own import observable
from carom.observe.pressure import Compressibility, PressureTensor, WallPressure
from carom.observe.radial import RDF
from carom.observe.rates import CollisionRate, CollisionsPerSphere
from carom.observe.space import DensityProfile, TemperatureProfile
from carom.observe.speeds import HFunction, SpeedDistribution
from carom.observe.structure import StructureFactor
from carom.observe.table import Table
from carom.observe.transport import (
    BulkViscosity,
    MutualDiffusion,
    ShearViscosity,
    ThermalConductivity,
)

#: All that can be measured, as ``carom run --observe`` calls it.
OBSERVABLES: dict[str, type[Observable]] = {
    "bulk-viscosity": BulkViscosity,
    "collision-rate": CollisionRate,
    "collisions-per-sphere": CollisionsPerSphere,
    "compressibility": Compressibility,
    "density-profile": DensityProfile,
    "diffusion": Diffusion,
    "energy": Energy,
    "free-path": FreePath,
    "free-time": FreeTime,
    "h-function": HFunction,
    "lyapunov": Lyapunov,
    "max-overlap": MaxOverlap,
    "msd": MSD,
    "mutual-diffusion": MutualDiffusion,
    "pressure-tensor": PressureTensor,
    "rdf": RDF,
    "shear-viscosity": ShearViscosity,
    "speed-distribution": SpeedDistribution,
    "steinhardt": Steinhardt,
    "structure-factor": StructureFactor,
    "temperature": Temperature,
    "temperature-profile": TemperatureProfile,
    "thermal-conductivity": ThermalConductivity,
    "vacf": VACF,
    "wall-pressure": WallPressure,
}

__all__ = [
    "MSD",
    "OBSERVABLES",
    "RDF",
    "VACF",
    "Batch",
    "BulkViscosity",
    "CollisionRate",
    "CollisionsPerSphere",
    "Compressibility",
    "DensityProfile",
    "Diffusion",
    "Energy",
    "Estimate",
    "FreePath",
    "FreeTime",
    "HFunction",
    "Lyapunov",
    "MaxOverlap",
    "Moment",
    "MutualDiffusion",
    "Observable",
    "PressureTensor",
    "Settling",
    "ShearViscosity",
    "SpeedDistribution",
    "Steinhardt",
    "StructureFactor",
    "Table",
    "Temperature",
    "TemperatureProfile",
    "ThermalConductivity",
    "Twin",
    "WallPressure",
    "blocking",
    "observable",
    "settling",
]
