"""A simulation written down: as a Python program, as a scene file, as a command.

A scene of the library whose spheres nobody touched is written as such, at its start, with what
was changed around them. Everything else is written as it is now, sphere by sphere.
"""

import shlex
from dataclasses import dataclass, fields, replace
from typing import Any, Self

from carom import scenes
from carom.errors import InputError
from carom.literals import call, literal, many_spheres, one_sphere
from carom.methods import TICKS_PER_SECOND
from carom.motion import Motion
from carom.scene import Scene, Spheres

#: Spheres that get a line of their own, fit into a program, and fit into a file for the eye.
LINES, PYTHON, TOML = 30, 2_000, 20_000
AROUND = ("walls", "rule", "gravity", "collide")
LOOKS = ("seed", "pace", "camera", "color", "title", "wire")


@dataclass(frozen=True)
class Listing:
    """What is to be written.

    Attributes
    ----------
    scene : Scene
        With what is around the spheres now.
    options : dict or None
        Of a scene of the library: those that are not the default. None for other spheres.
    bare : bool
        The simulation has no scene: its spheres were added one by one.
    method : str or None
        None for an engine of one's own.
    tick : float
    """

    scene: Scene
    options: dict[str, Any] | None
    bare: bool
    method: str | None
    tick: float

    @classmethod
    def of(cls, scene: Scene | None, motion: Motion, method: object, tick: float) -> Self:
        """See what there is to write of a simulation."""
        around = {name: getattr(motion.surroundings, name) for name in AROUND}
        named = method if isinstance(method, str) else None
        if scene is not None and not motion.edited and _is_of_the_library(scene):
            assert scene.origin is not None
            defaults = {o.name: o.default for o in scenes.options(scene.origin.name)}
            given = {k: v for k, v in scene.origin.options.items() if v != defaults[k]}
            return cls(replace(scene, **around), given, False, named, tick)
        state = motion.state
        spheres = Spheres(**{f.name: getattr(state, f.name) for f in fields(Spheres)})
        # The seed of a scene says nothing about the spheres of another moment.
        base = Scene(spheres, color="own") if scene is None else replace(scene, seed=None)
        now = replace(base, spheres=spheres, origin=None, **around)
        if len(spheres):
            now.build()  # ticks may have left an overlap, from which no program could start
        return cls(now, None, scene is None, named, tick)

    # As a program.

    def python(self) -> str:
        """Write it as a Python program."""
        other = self.method not in ("exact", None)
        method = [f"method={literal(self.method)}"] if other else []
        if self.method == "tick":
            method.append(f"tick={literal(self.tick)}")
        if self.options is not None:
            lines = self._library_scene(self.options, method)
        elif len(self.scene.spheres) > PYTHON:
            raise _too_many(self.scene, PYTHON, "a program", "write them with as_toml()")
        elif self.bare:
            lines = self._additions(method)
        else:
            lines = self._own_scene(method)
        if self.method is None:
            lines.insert(0, "# The engine of its own is not written here.")
        head = ["import carom", ""]
        if any("dataclasses." in line for line in lines):
            head.insert(0, "import dataclasses\n")
        return "\n".join([*head, *lines, "sim.show()", ""])

    def _library_scene(self, options: dict[str, Any], method: list[str]) -> list[str]:
        origin = self.scene.origin
        assert origin is not None
        assert origin.made is not None
        function = f"carom.scenes.{origin.name.replace('-', '_')}"
        made = call(function, (f"{name}={literal(value)}" for name, value in options.items()))
        lines: list[str] = []
        looks = self._differences(origin.made, LOOKS)
        if looks:
            lines = ["scene = " + call("dataclasses.replace", [made, *looks])]
            made = "scene"
        around = self._differences(origin.made, AROUND)
        lines.append("sim = " + call("carom.Simulation", [made, *around, *method]))
        return lines

    def _additions(self, method: list[str]) -> list[str]:
        around = self._differences(Scene(self.scene.spheres), AROUND)
        lines = ["sim = " + call("carom.Simulation", [*around, *method])]
        spheres = self.scene.spheres
        if len(spheres) > LINES:
            return [*lines, call("sim.add_many", many_spheres(spheres))]
        rows = (one_sphere(spheres, i) for i in range(len(spheres)))
        return lines + [f"sim.add({', '.join(row)})" for row in rows]

    def _own_scene(self, method: list[str]) -> list[str]:
        spheres = call("carom.Spheres.of", many_spheres(self.scene.spheres))
        rest = self._differences(Scene(self.scene.spheres), AROUND + LOOKS)
        return [
            "scene = " + call("carom.Scene", [spheres, *rest]),
            "sim = " + call("carom.Simulation", ["scene", *method]),
        ]

    def _differences(self, other: Scene, names: tuple[str, ...]) -> list[str]:
        """Arguments that make the scene of `other`."""
        arguments = []
        for name in names:
            value = getattr(self.scene, name)
            if value != getattr(other, name):
                several = name == "walls" and len(value) > 1
                one = value[0] if name == "walls" else value
                text = f"[{', '.join(map(literal, value))}]" if several else literal(one)
                arguments.append(f"{name}={text}")
        return arguments

    # As a file, as a command.

    def toml(self) -> str:
        """Write it as a scene file."""
        import tomli_w  # these two take longer to load than all the rest

        from carom import scene_file

        if self.options is not None and self._is_as_made():
            assert self.scene.origin is not None
            table: dict[str, Any] = {"scene": self.scene.origin.name}
            return tomli_w.dumps(table | ({"options": self.options} if self.options else {}))
        if len(self.scene.spheres) > TOML:
            remedy = "keep the arrays of sim.state with numpy.savez"
            raise _too_many(self.scene, TOML, "a scene file", remedy)
        return scene_file.dump(self.scene)

    def command(self) -> str:
        """Write it as a command."""
        words = ["carom", "show"]
        remark = ""
        if self.options is not None and self._is_as_made():
            assert self.scene.origin is not None
            words.append(self.scene.origin.name)
            for name, value in self.options.items():
                text = str(value).lower() if isinstance(value, bool) else str(value)
                words += [f"--{name.replace('_', '-')}", text]
        else:
            words.append("my-scene.toml")
            remark = "   # first save the scene file under this name"
        if self.method not in ("exact", None):
            words += ["--method", str(self.method)]
        if self.method == "tick" and self.tick != self.scene.pace / TICKS_PER_SECOND:
            words += ["--tick", literal(self.tick)]
        return shlex.join(words) + remark

    def _is_as_made(self) -> bool:
        origin = self.scene.origin
        assert origin is not None
        assert origin.made is not None
        return all(getattr(self.scene, n) == getattr(origin.made, n) for n in AROUND + LOOKS)


def _too_many(scene: Scene, limit: int, what: str, remedy: str) -> InputError:
    n = len(scene.spheres)
    return InputError(f"{n} spheres are too many for {what}, which holds {limit}; {remedy}")


def _is_of_the_library(scene: Scene) -> bool:
    """Whether its spheres are those of a scene that `import carom` brings everywhere."""
    origin = scene.origin
    if origin is None or origin.made is None or origin.made.spheres is not scene.spheres:
        return False
    function = getattr(scenes, origin.name.replace("-", "_"), None)
    return origin.name in scenes.names() and function is scenes.find(origin.name)
