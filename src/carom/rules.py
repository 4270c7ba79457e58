"""What happens when two spheres meet: frozen descriptions, one equation each."""

from dataclasses import dataclass
from typing import Self

from carom.checks import number


@dataclass(frozen=True, slots=True)
class Smooth:
    """Smooth spheres: the impulse acts along the line of centres.

    With r = r1 - r2, v = v1 - v2, n = r/|r| and the reduced mass mu = m1 m2/(m1 + m2)::

        J = -(1 + e) mu (v . n) n,    v1 += J/m1,    v2 -= J/m2

    so that after the collision (v . n)' = -e (v . n), momentum is kept, and the energy
    lost is 1/2 mu (1 - e^2) (v . n)^2.

    Parameters
    ----------
    restitution : float
        e, relative speed along n after / before, 0 <= e <= 1. 1 keeps all energy.
    contact_time : float or None
        TC model: a collision is elastic (e = 1) if either partner had its previous
        collision less than this ago. It cures inelastic collapse, in which e < 1 asks for
        infinitely many collisions in a finite time. None: off.

    Raises
    ------
    InputError
        If `restitution` is outside [0, 1], or `contact_time` is not positive.

    References
    ----------
    Impulse: any textbook of mechanics, for instance Goldstein, *Classical Mechanics*, ch. 3.
    TC model: S. Luding, S. McNamara, Granular Matter 1, 113 (1998), section 3,
    doi:10.1007/s100350050017.

    Examples
    --------
    >>> Smooth(restitution=0.9, contact_time=1e-4)
    Smooth(restitution=0.9, contact_time=0.0001)
    """

    restitution: float = 1.0
    contact_time: float | None = None

    def __post_init__(self) -> None:
        e = number("restitution", self.restitution, at_least=0, at_most=1)
        object.__setattr__(self, "restitution", e)
        if self.contact_time is not None:
            object.__setattr__(
                self, "contact_time", number("contact_time", self.contact_time, above=0)
            )

    @classmethod
    def examples(cls) -> list[Self]:
        """One of each kind, for tests that run over all rules."""
        return [cls(), cls(restitution=0.9), cls(restitution=0), cls(0.5, contact_time=1e-3)]
