"""What a collision does: the impulse, and the energy it takes or spares."""

import math
from typing import NamedTuple

from carom.reference.body import Body, Wall
from carom.reference.times import ZERO, Vec, dot, plus, sub


class Outcome(NamedTuple):
    """Result of a collision.

    Attributes
    ----------
    impulse : Vec
        On the first sphere; the other one receives the opposite.
    dissipated : float
        Energy taken; negative if a micro-hop has given some.
    withheld : float
        Energy that the contact-time cure has kept from being taken.
    inelastic : bool
        Whether the watchdog counts it: not if elastic, a micro-hop or a coming to rest.
    rests : bool
        Whether the sphere has come to rest on the wall.
    """

    impulse: Vec
    dissipated: float
    withheld: float
    inelastic: bool
    rests: bool = False


def micro_hop_speed(pressing: float, radius: float, restitution: float) -> float:
    """Slowest rebound allowed under an acceleration `pressing` onto the surface.

    Below it a sphere would bounce infinitely often in finite time. It corresponds to a rise of
    1e-9 radii; 1e-15, which is rounding, where the collision is elastic.
    """
    rise = (1e-9 if restitution < 1.0 else 1e-15) * radius
    return math.sqrt(2.0 * pressing * rise)


def pair_outcome(a: Body, b: Body, r: Vec, restitution: float, *, cured: bool) -> Outcome:
    """Collision of two spheres at separation r (from b to a), both flown to that moment.

    J = -(1+e) mu (b/r^2) r with the *actual* r: with sigma in its place a gap of 1e-10 would
    cost 2e-10 of the energy. `cured` makes e = 1 (Luding and McNamara, Granular Matter 1, 113,
    1998, doi:10.1007/s100350050017). A micro-hop sets the rebound speed instead.
    """
    v = sub(a.velocity, b.velocity)
    mu = 1.0 / (a.inverse_mass + b.inverse_mass)
    length = math.sqrt(dot(r, r))
    approach = -dot(v, r) / length
    pressing = max(0.0, -dot(sub(a.acceleration, b.acceleration), r) / length)
    slowest = micro_hop_speed(pressing, min(a.radius, b.radius), restitution)
    e = 1.0 if cured else restitution
    rebound = e * approach
    hops = rebound < slowest
    if hops:
        rebound = slowest
    changes_energy = hops or e < 1.0
    spared = 0.5 * mu * (1.0 - restitution * restitution) * approach * approach
    return Outcome(
        impulse=plus(ZERO, mu * (approach + rebound) / length, r),
        dissipated=0.5 * mu * (approach**2 - rebound**2) if changes_energy else 0.0,
        withheld=spared if cured and not hops else 0.0,
        inelastic=e < 1.0 and not hops,
    )


def wall_outcome(body: Body, wall: Wall, gravity: Vec, *, cured: bool) -> tuple[Vec, Outcome]:
    """Velocity after hitting a wall, and the rest of it.

    Specular: v_n' = -e v_n. Bounce-back: v' = -e v. Too slow a rebound becomes a rest where
    gravity holds spheres on the wall, and a micro-hop elsewhere.
    """
    before, normal = body.velocity, wall.normal_at(body.position)
    inward = dot(before, normal)
    pressing = max(0.0, -dot(gravity, normal))
    if wall.restitution < 1.0:  # a curved wall presses on what slides along it
        pressing += wall.curvature_acceleration(before, normal, body.radius)
    slowest = micro_hop_speed(pressing, body.radius, wall.restitution)
    e = 1.0 if cured else wall.restitution
    rebound = -e * inward
    too_slow = rebound < slowest
    rests = too_slow and wall.pressing > 0.0
    if too_slow:
        rebound = 0.0 if rests else slowest
    if wall.bounce_back:
        along = plus(before, -inward, normal)
        after = plus(plus(ZERO, -e, along), rebound, normal)
        reversed_speed2 = dot(before, before)
    else:
        after = plus(before, rebound - inward, normal)
        reversed_speed2 = inward * inward
    changes_energy = too_slow or e < 1.0
    lost = 0.5 * body.mass * (dot(before, before) - dot(after, after))
    spared = 0.5 * body.mass * (1.0 - wall.restitution**2) * reversed_speed2
    return after, Outcome(
        impulse=plus(ZERO, body.mass, sub(after, before)),
        dissipated=lost if changes_energy else 0.0,
        withheld=spared if cured and not too_slow else 0.0,
        inelastic=e < 1.0 and not too_slow,
        rests=rests,
    )
