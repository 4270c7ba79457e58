"""Two balls meet."""

from typing import Annotated

from carom.checks import number
from carom.rules import Smooth
from carom.scene import Scene, Spheres
from carom.scenes.registry import Slider, scene
from carom.walls import Box, Open


@scene
def two_balls(
    offset: Annotated[float, Slider(-1.5, 1.5)] = 0.4,
    mass_ratio: Annotated[float, Slider(0.1, 10, log=True)] = 2.0,
    restitution: Annotated[float, Slider(0, 1)] = 1.0,
    box: bool = True,
) -> Scene:
    """Two balls of different mass meet off centre.

    Parameters
    ----------
    offset : float
        Distance of the second ball's centre from the first one's path.
    mass_ratio : float
        Mass of the second ball over that of the first.
    restitution : float
        0 to 1.
    box : bool
        Walls around them, so that they meet again; without, they part for ever.
    """
    number("offset", offset, at_least=-3, at_most=3)
    spheres = Spheres.of(
        position=[(-3, -offset / 2, 0), (3, offset / 2, 0)],
        velocity=[(1.5, 0, 0), (0, 0, 0)],
        radius=(0.5, 0.7),
        mass=(1, number("mass_ratio", mass_ratio, above=0)),
        color=("#e5533d", "#4c9be8"),
    )
    return Scene(
        spheres,
        walls=(Box(10, 6, 6),) if box else (Open(),),
        rule=Smooth(restitution),
        pace=1.5,
        color="own",
        title="Two balls",
    )
