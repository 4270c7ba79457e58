"""Two spheres in a periodic cube: a point among fixed spheres, the Sinai billiard in 3-D."""

import math

import numpy as np

from carom import place
from carom.engine import FastEngine
from carom.random_numbers import Random
from carom.world import World

from .tools import Number, drive, spheres

LENGTH, STARTS, COLLISIONS = 2.5, 25, 4_000


def flights(seed):
    """(v12 x mean free time, mean approach speed/v12) of one long path."""
    random = Random(seed)
    places = place.random_positions(random, np.full(2, 0.5), np.full(3, LENGTH), (True,) * 3)
    velocity = random.normal(2, 3)
    speed = np.linalg.norm(velocity[0] - velocity[1])
    engine = FastEngine(spheres(places, velocity), World(period=np.full(3, LENGTH)))
    drive(engine, collisions=COLLISIONS)
    end = engine.state()
    assert math.isclose(np.linalg.norm(end.velocity[0] - end.velocity[1]), speed, rel_tol=1e-12)
    # For mass 1 the impulse is the approach speed.
    approach = np.linalg.norm(engine.take_events()["impulse"], axis=1).mean()
    return speed * engine.time / COLLISIONS, approach / speed


def test_free_time_and_approach_speed_of_the_sinai_billiard():
    """|v| <t> = (L^3 - 4 pi/3)/pi and <v_n> = 2 |v|/3, exactly.

    The sphere meets many images of its partner, some of them beyond the next. Two
    collisions missed in a hundred show.
    """
    paths, approaches = np.transpose([flights(seed) for seed in range(1, STARTS + 1)])
    path, approach = Number.of_blocks(paths), Number.of_blocks(approaches)
    expected = (LENGTH**3 - 4 * math.pi / 3) / math.pi
    assert math.isclose(expected, 3.640259, rel_tol=1e-6)
    assert path.is_off(expected) < 4
    assert path.error < 0.005 * expected
    assert approach.is_off(2 / 3) < 4
    assert approach.error < 0.002
