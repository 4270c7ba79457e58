"""Instruction sets, grid, looking ahead, sorting: no bit depends on what the engine chooses."""

import ctypes
import ctypes.util
import math
import os
import subprocess
import sys
from itertools import product

import numpy as np
import pytest

from carom import _core
from carom.engine import FastEngine
from carom.errors import InputError
from carom.world import World

from .worlds import bits, box, digest, every_kind, gas, run

KINDS = every_kind()
LEVELS = _core.simd_levels()
each_kind = pytest.mark.parametrize("kind", KINDS)


def story(state, world, until, **bookkeeping):
    """Digest of the end and of all records."""
    engine = FastEngine(state, world, **bookkeeping)
    run(engine, until)
    records = engine.take_events()
    return bits(engine.state()), digest(records["i"], records["j"], records["impulse"])


@each_kind
def test_every_instruction_set_tells_the_same_story(kind):
    told = {
        story(*KINDS[kind], simd=simd, grid=grid, ahead=ahead, sort=sort)
        for simd, grid, ahead, sort in product(LEVELS, (0, 1), (0, 1), (False, True))
    }
    assert len(told) == 1


def large_worlds():
    """Large enough to be sorted: {name: (state, world, time to run)}."""
    fluid, dilute = gas(11, 1.3), gas(11, 3.0)
    return {
        "fluid": (fluid, World(period=np.full(3, 14.3)), 1.5),
        "dilute": (dilute, World(period=np.full(3, 33.0)), 20.0),
        "box": (dilute, World(walls=box(33.0)), 20.0),
        "cooling": (
            fluid,
            World(period=np.full(3, 14.3), restitution=0.9, contact_time=1e-3),
            1.5,
        ),
        "open space": (fluid, World(), 5.0),
        "gravity": (fluid, World(walls=box(15.0), gravity=np.array([0.0, 0.0, -1.0])), 1.5),
    }


LARGE = large_worlds()


@pytest.mark.parametrize("kind", LARGE)
def test_order_in_memory_tells_nothing(kind):
    """Sorted, numbers differ inside; a checkpoint and the records carry those of the outside."""
    state, world, until = LARGE[kind]
    told = {
        story(state, world, until, grid=grid, ahead=ahead, sort=sort)
        for grid, ahead, sort in product((0, 1), (0, 1), (False, True))
    }
    for sort in (False, True):
        engine = FastEngine(state, world, sort=sort)
        run(engine, until / 3)
        records, saved = [engine.take_events()], engine.checkpoint()
        engine = FastEngine(state, world, sort=not sort, simd=LEVELS[0])
        engine.restore(saved)
        run(engine, until)
        records = np.concatenate([*records, engine.take_events()])
        end = bits(engine.state()), digest(records["i"], records["j"], records["impulse"])
        told.add(end)
        assert len(records) > 500
    assert len(told) == 1


def test_the_best_instruction_set_is_taken_unless_another_is_asked_for():
    program = "from carom import _core; print(_core.simd())"

    def answer(**environment):
        clean = {name: value for name, value in os.environ.items() if name != "CAROM_SIMD"}
        done = subprocess.run(
            [sys.executable, "-c", program],
            env=clean | environment,
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.strip()

    assert LEVELS[0] == "baseline"
    assert answer() == LEVELS[-1]
    for level in LEVELS:
        assert answer(CAROM_SIMD=level) == level


def test_an_instruction_set_that_is_not_there_is_refused():
    with pytest.raises(InputError, match=r"abacus.*baseline"):
        FastEngine(gas(2), World(), simd="abacus")


def test_a_wrong_choice_is_one_sentence_on_the_command_line():
    done = subprocess.run(
        [sys.executable, "-m", "carom", "run", "two-balls", "--collisions", "1"],
        env=os.environ | {"CAROM_SIMD": "abacus"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert done.stderr == (
        "carom: this machine cannot run the instruction set 'abacus': "
        f"choose one of {', '.join(LEVELS)}\n"
    )


def rounding_modes():
    """The C library's `fesetround` and the modes it takes, as far as they are known here."""
    library = ctypes.CDLL(ctypes.util.find_library("m"))
    known = {"x86_64": (0x400, 0x800, 0xC00), "aarch64": (0x400000, 0x800000, 0xC00000)}
    return library.fesetround, known.get(os.uname().machine, ())


@pytest.mark.skipif(not hasattr(os, "uname"), reason="fesetround is called by its POSIX numbers")
@pytest.mark.parametrize("kind", ["box", "unequal periods", "coming to rest", "open space"])
def test_the_callers_rounding_mode_does_not_matter(kind):
    state, world, until = KINDS[kind]
    fesetround, modes = rounding_modes()

    def in_mode(mode):
        """As `story`, but stopping on the way, and every call made in that mode."""

        def call(function, *arguments, **options):
            assert fesetround(mode) == 0
            try:
                return function(*arguments, **options)
            finally:
                fesetround(0)

        engine = call(FastEngine, state, world)
        ends = []
        for part in (0.3, 1.0):
            call(engine.advance, until * part)
            ends.append(bits(call(engine.state)))
            ends.append(call(engine.max_overlap))
            saved = call(engine.checkpoint)
            engine = call(FastEngine, state, world)
            call(engine.restore, saved)
        return ends

    plain = in_mode(0)
    for mode in modes:
        assert in_mode(mode) == plain


def test_nothing_moves_and_nothing_ever_will():
    state = gas(5, 1.5)
    state.velocity[:] = 0.0
    engine = FastEngine(state, World(walls=box(9.0)), grid=1)
    assert run(engine, math.inf).name == "IDLE"
