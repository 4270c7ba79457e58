"""A student's program: read, run, and its errors explained by file and line."""

import builtins
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from types import ModuleType
from typing import Any, TextIO

from carom.checks import nearest
from carom.errors import CaromError, FileError, InputError, RunError
from carom.sketch.printed import Printed
from carom.sketch.recorder import CURRENT, Picture, Recorder

#: The program's name as a module. Not ``__main__``, which is carom's own.
NAME = "__sketch__"


class Program:
    """A file with ``setup()`` and ``draw()``, run as often as one likes.

    Parameters
    ----------
    path : str or Path
    seed : int
        Of ``random()``.
    echo : text stream, optional
        Where ``print()`` goes, besides the page.

    Attributes
    ----------
    recorder : Recorder
    printed : Printed
    names : dict
        The program's own names: its functions, balls and so on.

    Examples
    --------
    ::

        program = Program("my_ball.py")
        program.start()
        picture = program.draw()
    """

    def __init__(self, path: str | Path, seed: int = 1, echo: TextIO | None = None) -> None:
        self.path = Path(path).resolve()
        self._seed = seed
        self.printed = Printed(echo)
        self.recorder = Recorder(seed)
        self.names: dict[str, Any] = {}
        self._before: set[str] | None = None

    def load(self) -> None:
        """Read the file, as it is now, and run it up to its functions.

        Raises
        ------
        FileError
            If it cannot be read.
        InputError
            If it does not parse, or has no ``draw()``.
        RunError
            If it fails.
        """
        code = self._compiled()
        self._forget_helpers()
        module = ModuleType(NAME)
        module.__file__ = str(self.path)
        sys.modules[NAME] = module  # dataclasses look their module up
        self.recorder = Recorder(self._seed)
        self.printed.forget()
        self.names = vars(module)
        with self._running():
            exec(code, self.names)
        if not callable(self.names.get("draw")):
            msg = (
                f"{self.path.name} has no draw(); write a function draw() that draws one frame, "
                "it is called 60 times a second"
            )
            raise InputError(msg)

    def start(self) -> None:
        """Load, and run ``setup()`` if there is one.

        Raises
        ------
        FileError, InputError, RunError
            See `load`.
        """
        self.load()
        self.setup()

    def setup(self) -> None:
        """Run ``setup()`` if there is one.

        Raises
        ------
        RunError
            If it fails.
        """
        setup = self.names.get("setup")
        if callable(setup):
            self._call("setup", setup)
        self.recorder.clear()

    def draw(self) -> Picture:
        """Run ``draw()`` once.

        Raises
        ------
        RunError
            If it fails.
        """
        self.recorder.begin()
        self._call("draw", self.names["draw"])
        return self.recorder.picture()

    def _call(self, name: str, function: Callable[[], object]) -> None:
        with self._running():
            function()
        if kept := self.recorder.stack.kept:
            _, (file, line) = kept[-1]
            msg = (
                f"{Path(file).name}, line {line}: push_matrix() has no pop_matrix() by the end of "
                f"{name}(); write one pop_matrix() for each push_matrix()"
            )
            raise RunError(msg)

    @contextmanager
    def _running(self) -> Iterator[None]:
        """Around the program's own code: its drawing is recorded, its errors explained."""
        folder = str(self.path.parent)
        if folder not in sys.path:
            sys.path.insert(0, folder)  # its own modules lie beside it
        token = CURRENT.set(self.recorder)
        try:
            with redirect_stdout(self.printed):
                yield
        except Exception as error:
            raise RunError(self._explained(error)) from error
        finally:
            CURRENT.reset(token)

    def _compiled(self) -> Any:
        try:
            source = self.path.read_bytes()
        except FileNotFoundError as error:
            near = _meant(self.path.name, [p.name for p in self.path.parent.glob("*.py")])
            msg = f"there is no file {self.path.name!r} in {self.path.parent}{near}"
            raise FileError(msg) from error
        except OSError as error:
            msg = f"{self.path.name} cannot be read ({error.strerror}); name a Python file"
            raise FileError(msg) from error
        try:
            return compile(source, str(self.path), "exec", dont_inherit=True)
        except SyntaxError as error:
            where = f", line {error.lineno}" if error.lineno else ""
            msg = f"{self.path.name}{where} is no Python: {error.msg}"
            raise InputError(msg) from error
        except ValueError as error:  # a null byte, in some versions of Python
            msg = f"{self.path.name} is no Python: {error}"
            raise InputError(msg) from error

    def _forget_helpers(self) -> None:
        """Drop modules that lie beside the program, so that they are read again too."""
        if self._before is None:
            self._before = set(sys.modules)
        for name in set(sys.modules) - self._before:
            file = getattr(sys.modules[name], "__file__", None)
            if file and Path(file).resolve().parent == self.path.parent:
                del sys.modules[name]

    def _explained(self, error: Exception) -> str:
        """One sentence: file, line, what is wrong."""
        own = [
            frame
            for frame in traceback.extract_tb(error.__traceback__)
            if Path(frame.filename).parent == self.path.parent
        ]
        where = self.path.name
        if own:
            where = f"{Path(own[-1].filename).name}, line {own[-1].lineno}"
        if isinstance(error, CaromError):
            return f"{where}: {error}"
        if isinstance(error, RecursionError):
            return f"{where}: a function calls itself without end; give it a way out"
        said = " ".join(f"{type(error).__name__}: {error}".split()).removesuffix(":")
        if isinstance(error, NameError) and error.name:
            said += _meant(error.name, [*self.names, *vars(builtins)])
        elif isinstance(error, AttributeError) and error.name:
            said += _meant(error.name, dir(error.obj))
        elif isinstance(error, TypeError) and "'function'" in said:
            said += " (a function is missing its brackets, as in width())"
        return f"{where}: {said}"


def _meant(name: str, known: Iterable[str]) -> str:
    """`nearest`, without the list of all of them where none is near."""
    said = nearest(name, known)
    return said if "did you mean" in said else ""
