"""What the live view uses of a simulation, which it does not know by name."""

from collections.abc import Callable
from typing import Any, Protocol, Self

from numpy.typing import NDArray

from carom.rules import Smooth
from carom.scene import Scene
from carom.state import State
from carom.view.protocol import Moment
from carom.world import World


class Instant(Moment, Protocol):
    """What is shown of a moment: of a `carom.Frame`, or of a simulation as it is now."""

    @property
    def walls(self) -> Any:
        """Descriptions of the walls."""

    @property
    def state(self) -> State:
        """The spheres."""

    @property
    def world(self) -> World:
        """Everything but the spheres."""

    @property
    def kinetic_energy(self) -> float:
        """Of all free spheres."""

    @property
    def potential_energy(self) -> float:
        """Of all free spheres."""

    @property
    def dissipated(self) -> float:
        """Energy taken by inelastic collisions."""

    @property
    def energy_drift(self) -> float:
        """Relative error of the energy."""

    @property
    def momentum(self) -> Any:
        """Of all free spheres."""

    @property
    def temperature(self) -> float:
        """Of all free spheres."""


class Viewable(Instant, Protocol):
    """The part of `carom.Simulation` that is driven and shown; see there for what it means."""

    velocity: Any
    walls: Any
    gravity: Any
    rule: Smooth

    def __getitem__(self, index: int) -> Any:
        """One sphere, whose velocity can be assigned."""

    @property
    def scene(self) -> Scene | None:
        """Where it started from."""

    @property
    def events(self) -> NDArray[Any]:
        """Records of the last run."""

    @property
    def method(self) -> Any:
        """How contacts are found."""

    @property
    def tick(self) -> float:
        """Length of a step, where there are steps."""

    @property
    def pace(self) -> float:
        """Simulated time per second at speed 1."""

    @property
    def missed(self) -> int:
        """Collisions that ticks did not see."""

    @property
    def max_overlap(self) -> float:
        """Deepest overlap so far."""

    def run(
        self,
        *,
        until: float | None = None,
        duration: float | None = None,
        collisions: float | None = None,
        events: float | None = None,
        progress: Callable[[Any], object] | None = None,
    ) -> None:
        """Let time run; `progress` is called now and then and may raise to end the run."""

    def reset(self, scene: Scene | None = None) -> None:
        """Go back to the start, or to the start of another scene."""

    @property
    def add(self) -> Callable[..., Any]:
        """Add a sphere."""

    def remove(self, index: int) -> None:
        """Take a sphere away."""

    def bookmark(self) -> Any:
        """Mark now, to return to."""

    def return_to(self, bookmark: Any) -> None:
        """Go back to a bookmark's moment."""

    def in_ticks(self) -> Self:
        """The same start by the method of fixed steps."""

    def as_python(self) -> str:
        """Itself as a program."""

    def as_toml(self) -> str:
        """Itself as a scene file."""

    def as_command(self) -> str:
        """Itself on the command line."""
