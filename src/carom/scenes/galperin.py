"""Galperin's billiard: collisions that count the digits of pi."""

from typing import Annotated

from carom.checks import number
from carom.scene import Scene, Spheres
from carom.scenes.registry import Slider, scene
from carom.walls import Plane


@scene
def galperin(digits: Annotated[int, Slider(1, 6)] = 3) -> Scene:
    """Galperin's billiard: two balls and a wall whose collisions count the digits of pi.

    A light ball rests between a wall and a ball 100^(digits - 1) times as heavy that comes
    in. All their collisions, wall included, number 3, 31, 314, 3141 ...

    G. Galperin, Regular and Chaotic Dynamics 8, 375 (2003),
    doi:10.1070/RD2003v008n04ABEH000252.

    Parameters
    ----------
    digits : int
        How many digits of pi to count, 1 to 9.
    """
    number("digits", digits, at_least=1, at_most=9)
    heavy = 0.5 + 0.125 * (digits - 1)
    spheres = Spheres.of(
        position=[(2, 0, 0), (4 + heavy, 0, 0)],
        velocity=[(0, 0, 0), (-1, 0, 0)],
        radius=(0.5, heavy),
        mass=(1, 100 ** (digits - 1)),
        color=("orange", "#4c9be8"),
    )
    return Scene(
        spheres,
        walls=(Plane((1, 0, 0), 0),),
        pace=1.0,
        color="own",
        title=f"Galperin's billiard: {digits} digits of pi",
    )
