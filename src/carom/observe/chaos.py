"""How fast two runs that began almost alike part: the largest Lyapunov exponent."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from carom import fit
from carom.checks import number
from carom.errors import InputError
from carom.observe.batch import Moment, Twin
from carom.observe.estimate import Estimate
from carom.observe.kinds import is_elastic, mean_free_time
from carom.observe.observable import Observable, every
from carom.observe.series import Series
from carom.random_numbers import Random
from carom.state import Floats, State
from carom.world import World

APART = 1e-9  #: separation at the beginning of each stretch, if not told
LINEAR = 1e-2  #: of more, growth is no longer that of small separations
GROWTH = 11.0  #: the logarithm of what a stretch makes of a separation, at most
SETTLING = 8  #: first stretches that do not count: the separation has yet to turn
FEW = 0.01  #: share of stretches that may be lost without a word


class Lyapunov(Observable):
    """Largest Lyapunov exponent: the rate at which two runs part that began almost alike.

    A twin starts a tiny step away from the run and goes on beside it. After each stretch of time
    their separation ::

        d^2 = sum over spheres of |dr|^2/sigma^2 + |dv|^2/u^2

    (nearest images; sigma the mean diameter, u^2 the mean of v^2 at the beginning) is measured
    and the twin brought back along it to where d was. The exponent is the mean of ln(d/d0) over the
    time, its error by blocking. Which units d has changes no exponent. The first step has a
    random direction, and the first eight stretches do not count.

    If at the end of a stretch a sphere has had a collision that its twin has not, or the other
    way round, the stretch goes on to the next: in such a moment velocities differ by all of a
    collision. If d reaches 0.01 so, the stretch is lost, and `note` says so of more than one in
    a hundred; take `every` shorter then. Where twins overlap, by 1e-9 diameters or so, spheres
    that part go on, and spheres that approach collide at once.

    A twin doubles the work, and starting it anew takes as long again or longer: see what it costs
    in docs/observe.md. Result: `Estimate` in 1/time.

    Parameters
    ----------
    every : float, optional
        The stretch: simulated time in which the separation grows a thousandfold or so, if left
        out.
    separation : float
        d0, 1e-12 to 1e-4.
    seed : int
        Of the first step.

    References
    ----------
    G. Benettin, L. Galgani, J.-M. Strelcyn, Phys. Rev. A 14, 2338 (1976),
    doi:10.1103/PhysRevA.14.2338; hard spheres: C. Dellago, H. A. Posch, Physica A 240, 68 (1997),
    doi:10.1016/S0378-4371(97)00131-3.
    """

    def __init__(
        self, every: float | None = None, separation: float = APART, seed: int = 1
    ) -> None:
        self._interval = None if every is None else number("every", every, above=0)
        self._apart = number("separation", separation, at_least=1e-12, at_most=1e-4)
        self._seed = int(number("seed", seed, at_least=0))

    def begin(self, moment: Moment) -> None:
        """Start the twin."""
        state, world = moment.state, moment.world
        if not is_elastic(world):
            msg = f"{self.name} is of runs that keep their energy; take restitution 1 everywhere"
            raise InputError(msg)
        free = ~state.fixed
        square = float((state.velocity[free] ** 2).sum(axis=1).mean()) if free.any() else 0.0
        if not square > 0:
            msg = f"{self.name} is of spheres that move; give them velocities"
            raise InputError(msg)
        self._length = 2 * float(state.radius[free].mean())
        self._speed = math.sqrt(square)
        self.schedule = every(self._interval or self._natural(state, world))
        self._series = Series(2)
        self._stretches, self._lost = 0, 0
        self._step = self._random_step(free)
        self._start_twin(moment)

    def _natural(self, state: State, world: World) -> float:
        """A time in which separations grow e^11-fold at most.

        Each collision multiplies that of velocities by about the free path over the diameter, and
        the fastest chain of collisions has four in a mean free time (van Zon, van Beijeren and
        Dellago, Phys. Rev. Lett. 80, 2035 (1998)). Measured are 0.5 to 0.8 of that.
        """
        time = mean_free_time(state, world)
        return time * GROWTH / (0.4 + 4 * math.log1p(self._speed * time / self._length))

    def _random_step(self, free: NDArray[np.bool_]) -> Floats:
        """A direction in the space of positions and velocities, (2, N, 3)."""
        n = len(free)
        step = Random(self._seed).normal(6 * n).reshape(2, n, 3) * free[:, None]
        return step / math.sqrt(float((step**2).sum()))

    def _start_twin(self, moment: Moment) -> None:
        state, world = moment.state, moment.world
        position = state.position + self._step[0] * (self._apart * self._length)
        position, boxes = fit.wrap(position, world.period)
        velocity = state.velocity + self._step[1] * (self._apart * self._speed)
        there = replace(state, position=position, velocity=velocity, image=state.image + boxes)
        self._since = moment.time
        self._twin: Twin = moment.going_on(there)

    def sample(self, moment: Moment) -> None:
        """Compare with the twin, and bring it back."""
        twin = going_to(self._twin, moment.time)
        apart, state = self._separation(twin, moment), moment.state
        size = math.sqrt(float((apart**2).sum()))
        near = 0 < size < LINEAR
        if near and (twin.collision_count == state.collision_count).all():
            self._stretches += 1
            if self._stretches > SETTLING:
                row = [math.log(size / self._apart), moment.time - self._since]
                self._series.add(np.array([row]))
            self._step = apart / size
        elif near:
            return
        else:
            self._lost += 1
        self._start_twin(moment)

    def _separation(self, twin: State, moment: Moment) -> Floats:
        """The twin's step away from the run, in units of sigma and u, (2, N, 3)."""
        state, world = moment.state, moment.world
        apart = twin.position - state.position
        periodic = np.flatnonzero(world.period)
        length = world.period[periodic]
        apart[:, periodic] -= length * np.rint(apart[:, periodic] / length)
        return np.stack([apart / self._length, (twin.velocity - state.velocity) / self._speed])

    def result(self) -> Estimate:
        """The exponent so far."""
        self.over_samples()
        counted = self._stretches - SETTLING
        if counted < 1:
            msg = (
                f"{self.name} counts from stretch {SETTLING + 1} on, and has seen "
                f"{self._stretches}; run longer"
            )
            raise InputError(msg)
        found = self._series.ratio(0, 1)
        if self._lost > FEW * (self._stretches + self._lost):
            share = 100 * self._lost / (self._stretches + self._lost)
            note = f"too low: {share:.0f} % of the stretches were lost; take every= shorter"
            return replace(found, note=note)
        return found


def going_to(twin: Twin, time: float) -> State:
    """The twin's spheres at a later time."""
    while twin.time < time:
        twin.advance(time)
    return twin.state()
