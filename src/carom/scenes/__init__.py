"""Ready-made scenes: functions that return a `Scene`, and the same by name.

``scenes.fluid(n=1000)`` in Python and ``carom run fluid --n 1000`` on the command line are
one scene. `names`, `describe`, `options`, `find` and `build` serve those who have a name;
`scene` adds a scene of your own.
"""

from carom.scenes.bounce import bounce
from carom.scenes.break_shot import break_shot
from carom.scenes.fluid import fluid
from carom.scenes.galperin import galperin
from carom.scenes.gas import gas
from carom.scenes.giant import giant
from carom.scenes.newton_cradle import newton_cradle
from carom.scenes.phase_0 import phase_0
from carom.scenes.phase_1 import phase_1
from carom.scenes.phase_2 import phase_2, phase_2_lines
from carom.scenes.phase_3 import phase_3
from carom.scenes.phase_4 import phase_4
from carom.scenes.registry import Option, Slider, build, describe, find, names, options, scene
from carom.scenes.two_balls import two_balls

__all__ = [
    "Option",
    "Slider",
    "bounce",
    "break_shot",
    "build",
    "describe",
    "find",
    "fluid",
    "galperin",
    "gas",
    "giant",
    "names",
    "newton_cradle",
    "options",
    "phase_0",
    "phase_1",
    "phase_2",
    "phase_2_lines",
    "phase_3",
    "phase_4",
    "scene",
    "two_balls",
]
