"""Viscosity, conduction of heat and mutual diffusion, by Helfand's moments."""

import math

import numpy as np

from carom import mechanics, theory
from carom.errors import InputError
from carom.observe.batch import Moment
from carom.observe.fluid import UP_TO, Fluid, in_range, is_gas
from carom.observe.helfand import Helfand, Kinetic
from carom.observe.kinds import one_kind
from carom.state import Floats, State

ENSKOG = f"Enskog, {UP_TO}"
#: From xx, yy, zz, xy, xz, yz to five equivalent components without trace.
SHEAR = np.zeros((6, 5))
SHEAR[[3, 4, 5], [0, 1, 2]] = 1
SHEAR[:3, 3] = np.array([1, -1, 0]) / 2
SHEAR[:3, 4] = np.array([-1, -1, 2]) / math.sqrt(12)


class ShearViscosity(Helfand):
    """Shear viscosity eta of a periodic fluid, of one or several kinds.

    ::

        G_ab = integral of sum m v_a v_b dt + sum over collisions of r_a J_b
        eta = d<[G_ab(t) - G_ab(0)]^2>/dt / (2 V kT)

    r = sigma J/|J| points from one centre to the other and J is the impulse; velocities are about
    the motion of the whole. The mean is over xy, xz, yz, (xx - yy)/2 and (2 zz - xx - yy)/sqrt(12).
    Theory, for one kind: `carom.theory.shear_viscosity`. Result: `Table`, mass/(length time).

    Parameters
    ----------
    between : (float, float), optional
        The two lags; 5 and 20 mean free times if left out. The earlier is moved to the nearest
        24th of the later.

    References
    ----------
    B. J. Alder, D. M. Gass, T. E. Wainwright, J. Chem. Phys. 53, 3813 (1970),
    doi:10.1063/1.1673845, after E. Helfand, Phys. Rev. 119, 1 (1960),
    doi:10.1103/PhysRev.119.1; in a periodic box: S. Viscardy, P. Gaspard, Phys. Rev. E 68, 041204
    (2003), doi:10.1103/PhysRevE.68.041204; the five components: P. J. Daivis, D. J. Evans,
    J. Chem. Phys. 100, 541 (1994), doi:10.1063/1.466970.
    """

    _title, _unit, _lag_unit = "Shear viscosity", "mass/(length time)", "mass/length"

    def _components(self, moments: Floats) -> Floats:
        found: Floats = moments[:, :6] @ SHEAR
        return found

    def _known(self, fluid: Fluid) -> Kinetic:
        # Without memory: what crosses between centres when spheres meet, 3/5 of the bulk viscosity.
        instant = 0.6 * float(theory.bulk_viscosity(*fluid))
        dilute = float(theory.shear_viscosity(0, *fluid[1:]))
        memory = dilute / (_density(fluid) * _contact(fluid) * fluid.temperature)
        whole = float(theory.shear_viscosity(*fluid))
        return Kinetic(instant, whole - instant, memory, ENSKOG)


class BulkViscosity(Helfand):
    """Bulk viscosity kappa of a periodic fluid, of one or several kinds.

    ::

        kappa = d<[G(t) - G(0) - <P> V t]^2>/dt / (2 V kT),  G = (G_xx + G_yy + G_zz)/3

    with G_ab of `ShearViscosity`. Energy is constant here, so the mean pressure is all that has
    to be taken off; where energy fluctuates its part of the pressure would have to go too. The
    mean is that of the run. Theory, for one kind: `carom.theory.bulk_viscosity`. Result: `Table`,
    mass/(length time).

    Parameters
    ----------
    between
        As of `ShearViscosity`.

    References
    ----------
    As of `ShearViscosity`; the mean: R. Zwanzig, Annu. Rev. Phys. Chem. 16, 67 (1965),
    doi:10.1146/annurev.pc.16.100165.000435.
    """

    _title, _unit, _lag_unit = "Bulk viscosity", "mass/(length time)", "mass/length"
    _has_mean = True

    def _components(self, moments: Floats) -> Floats:
        found: Floats = moments[:, :3].sum(axis=1, keepdims=True) / 3
        return found

    def _known(self, fluid: Fluid) -> Kinetic:
        return Kinetic(float(theory.bulk_viscosity(*fluid)), 0.0, 0.0, ENSKOG)


class ThermalConductivity(Helfand):
    """Thermal conductivity lambda of a periodic fluid of one kind, with Boltzmann's constant 1.

    ::

        G_a = integral of sum m v^2 v_a/2 dt + sum over collisions of r_a (energy transferred)
        lambda = d<[G_a(t) - G_a(0)]^2>/dt / (2 V (kT)^2)

    with r of `ShearViscosity` and velocities about the motion of the whole, so that no enthalpy
    goes along. The mean is over x, y and z. Theory: `carom.theory.thermal_conductivity`. Result:
    `Table`, 1/(length time).

    Parameters
    ----------
    between
        As of `ShearViscosity`; 10 and 30 mean free times if left out.

    References
    ----------
    As of `ShearViscosity`.
    """

    _title, _unit, _lag_unit = "Thermal conductivity", "1/(length time)", "1/length"
    _natural_lags = (10.0, 30.0)

    def begin(self, moment: Moment) -> None:
        """Refuse mixtures, in which heat also goes along with diffusion."""
        one_kind(moment.state, self.name)
        super().begin(moment)

    def _components(self, moments: Floats) -> Floats:
        return moments[:, 6:9]

    def _scale(self) -> float:
        return 1 / (2 * self._volume * self._kT**2)

    def _known(self, fluid: Fluid) -> Kinetic:
        instant = 1.5 * float(theory.bulk_viscosity(*fluid)) / fluid.mass
        dilute = float(theory.thermal_conductivity(0, *fluid[1:])) * fluid.mass
        memory = dilute / (2.5 * _density(fluid) * _contact(fluid) * fluid.temperature)
        whole = float(theory.thermal_conductivity(*fluid))
        return Kinetic(instant, whole - instant, memory, ENSKOG)


class MutualDiffusion(Helfand):
    """Coefficient of Maxwell and Stefan of the mutual diffusion of two kinds of spheres.

    Kinds differ by species, radius or mass. With the numbers N_1 and N_2, the mole fractions x
    and the mean positions R_1 and R_2 of each kind, unwrapped ::

        D_12 = N x_1 x_2 d<|R_1(t) - R_2(t) - R_1(0) + R_2(0)|^2>/6 dt

    Onsager's coefficient about the centre of mass is Lambda_11 = (x_1/x_2) w_2^2 D_12 with the
    mass fraction w. Fick's coefficient is D_12 times the thermodynamic factor, 1 for spheres of
    one size. Spheres that differ in species alone have the D_12 of self-diffusion, that of
    `Diffusion` in this box. No size correction. Theory: `carom.theory.mutual_diffusion`. Result:
    `Table`, length^2/time.

    Parameters
    ----------
    between : (float, float), optional
        The two lags; 10 and 40 times that in which R_1 - R_2 forgets how fast it grew, if left
        out. The earlier is moved to the nearest 24th of the later.

    References
    ----------
    X. Liu et al., Int. J. Thermophys. 34, 1169 (2013), doi:10.1007/s10765-013-1482-3; the size of
    the box: S. H. Jamali et al., J. Chem. Theory Comput. 14, 2667 (2018),
    doi:10.1021/acs.jctc.8b00170.
    """

    _title, _unit, _lag_unit = "Mutual diffusion", "length^2/time", "length^2"

    def _charge(self, state: State) -> Floats:
        kinds = np.column_stack([state.species, state.radius, state.mass])
        found, of, count = np.unique(kinds, axis=0, return_inverse=True, return_counts=True)
        if len(found) != 2:
            kind = "kind" if len(found) == 1 else "kinds"
            msg = (
                f"{self.name} is of two kinds of spheres that differ by species, radius or mass, "
                f"and here {'is' if len(found) == 1 else 'are'} {len(found)} {kind}"
            )
            raise InputError(msg)
        self._count, self._radius, self._mass = count, found[:, 1], found[:, 2]
        charge: Floats = np.array([1, -1])[of.ravel()] / count[of.ravel()]
        return charge

    def _enskog(self, moment: Moment) -> Kinetic | None:
        if not is_gas(moment.state, moment.world):
            return None
        kinds = self._radius, self._volume, self._count, self._mass, self._kT
        value = in_range(theory.mutual_diffusion, *kinds)
        if value is None:
            return None
        share = self._count / self._count.sum()
        memory = value * float(self._mass.prod() / (share @ self._mass)) / self._kT
        return Kinetic(0.0, value, memory, f"Enskog, first order, {UP_TO}")

    def _natural(self, moment: Moment) -> tuple[float, float]:
        if self._kinetic is None:
            phi = mechanics.packing_fraction(moment.state, moment.world)
            msg = (
                f"{self.name} takes its lags from theory, which ends at a packing fraction of "
                f"{theory.FREEZING}, and here it is {phi:.4g}; give between="
            )
            raise InputError(msg)
        return 10 * self._kinetic.memory, 40 * self._kinetic.memory

    def _components(self, moments: Floats) -> Floats:
        return moments[:, 9:]

    def _scale(self) -> float:
        return float(self._count.prod() / self._count.sum()) / 2


def _density(fluid: Fluid) -> float:
    return fluid.packing_fraction / (4 / 3 * math.pi * fluid.radius**3)


def _contact(fluid: Fluid) -> float:
    return float(theory.contact_value(fluid.packing_fraction))
