"""Where the scales of colours by energy and speed end, and that all who draw agree on it."""

import numpy as np
import pytest

import carom
from carom import scenes
from carom.pictures.painter import Painter, Style
from carom.pictures.scales import Scales, full_gravity
from carom.view import replay
from carom.view.announcer import Announcer
from carom.view.protocol import Command
from carom.view.reel import decode
from carom.view.stage import Stage
from carom.view.wire import FRAME_HEADER, HEADER, METERS, REEL_COLUMNS

#: Time until the gas of `cooling` has lost most of its speed, and pictures per second until then.
LONG, FEW = 200, 0.5


def ends(sim, scales=None):
    return (scales or Scales(paper=False)).follow(sim.state, sim.world)


def one(*, speed=0.0, mass=1.0, **options):
    sim = carom.Simulation(**options)
    sim.add(position=(0, 0, 3), velocity=(speed, 0, 0), mass=mass)
    return sim


def cooling():
    """A gas that loses its heat, and its speeds nine tenths of what they were."""
    sim = carom.Simulation(scenes.gas(n=60, seed=1, packing_fraction=0.2))
    sim.rule = carom.Smooth(0.7, contact_time=1e-4)
    return sim


# One motion.


def test_a_usual_sphere_has_half_the_speed_and_a_third_of_the_energy_of_the_end():
    assert ends(one(speed=3, mass=2)) == (20, 5)  # 3 times 9 and 2 times 3, to 1, 2 or 5
    assert ends(one(speed=3e-9, mass=2e30)) == (2e13, 5e-9)


def test_height_counts_for_what_will_fall():
    onto = {"walls": carom.Box(10, 10, 10), "gravity": (0, 0, -1)}
    assert ends(one(**onto)) == (20, 5)  # 3 · 2/3 · 8, and 2 √(2/3 · 2 · 8)
    assert ends(one(**{**onto, "walls": carom.Sphere(5)})) == (20, 5)
    assert ends(one(**{**onto, "walls": carom.Cylinder(5, 10)})) == (20, 5)
    assert ends(one(gravity=(0, 0, -1)))[0] == 1  # nothing is below it but its own radius


@pytest.mark.parametrize("scene", [scenes.bounce(n=20, restitution=1.0), scenes.gas(n=50)])
def test_scales_stay_while_the_energy_does(scene):
    sim = carom.Simulation(scene)
    scales = Scales(paper=False)
    seen = {ends(sim, scales)}
    for frame in sim.frames(every=0.1 * sim.pace, until=10 * sim.pace):
        seen.add(scales.follow(frame.state, frame.world))
    assert len(seen) == 1


def test_scales_follow_what_has_left_them_and_nothing_less():
    sim, scales = one(speed=1), Scales(paper=False)
    assert ends(sim, scales) == (2, 2)
    sim.velocity = (1.9, 0, 0)
    assert ends(sim, scales)[1] == 2
    sim.velocity = (2.1, 0, 0)
    assert ends(sim, scales) == (5, 5)
    sim.velocity = (0.9, 0, 0)
    assert ends(sim, scales)[1] == 5
    sim.velocity = (0.8, 0, 0)
    assert ends(sim, scales)[1] == 2


def test_what_comes_to_rest_leaves_scales_alone():
    sim, scales = one(speed=1), Scales(paper=False)
    before = ends(sim, scales)
    sim.velocity = (0, 0, 0)
    assert ends(sim, scales) == before


def test_where_nothing_has_moved_the_first_motion_says_how_far_scales_go():
    sim, scales = one(), Scales(paper=False)
    assert ends(sim, scales) == (1, 1)
    sim.velocity = (0.3, 0, 0)
    assert ends(sim, scales)[1] == 0.5
    sim = carom.Simulation()
    sim.add((0, 0, 0), fixed=True)
    assert (ends(sim), full_gravity(sim.state, sim.world)) == ((1, 1), 1)


def test_the_paper_keeps_its_number():
    scales = Scales(paper=True)
    sim = one(speed=1)
    assert [ends(sim, scales)[0] for sim.velocity in ((1, 0, 0), (1e9, 0, 0))] == [500, 500]


# All who draw.


@pytest.fixture
def film_ends(monkeypatch, tmp_path):
    """Draws a film and says where the scale ended at each time."""

    def draw(sim, color, **options):
        drawn = {}
        paint = Painter.paint

        def told(painter, state):
            drawn[state.time] = painter.end_of_scale(state)
            return paint(painter, state)

        monkeypatch.setattr(Painter, "paint", told)
        carom.render(sim, tmp_path / "a.gif", color=color, size=(64, 36), caption=False, **options)
        return drawn

    return draw


def test_no_film_of_a_gas_that_cools_becomes_one_colour(film_ends):
    sim = cooling()
    drawn = film_ends(sim, "speed", until=LONG, fps=FEW)
    first, *_, last = drawn.values()
    speeds = np.linalg.norm(sim.velocity, axis=1)
    assert np.median(speeds) < 0.1 * first  # all would be as blue as the slowest
    assert 0.1 * last < np.median(speeds) < 0.9 * last
    assert sorted(set(drawn.values()), reverse=True) == [2, 0.5, 0.2, 0.05]


def test_balls_at_rest_at_first_do_not_become_one_colour(film_ends):
    sim = carom.Simulation(gravity=(0, 0, -10))
    for x in (-2, 0, 2):
        sim.add(position=(x, 0, 0), velocity=(0, 0, 0))
    drawn = list(film_ends(sim, "speed", until=2, fps=20).values())
    assert max(sim.velocity[:, 2]) < -19
    assert 19 < drawn[-1] < 100
    assert drawn == sorted(drawn)


@pytest.mark.parametrize("color", ["energy", "speed"])
def test_film_replay_and_live_page_agree(film_ends, color):
    drawn = film_ends(cooling(), color, until=LONG, fps=FEW)
    times = list(drawn)
    data, _ = replay.pack(cooling(), times, color=color, title=None, speed=1.0, progress=None)
    column = REEL_COLUMNS.index(f"full_{color}")
    assert decode(data).columns[:, column].tolist() == list(drawn.values())
    sim = cooling()
    page, told = Page(sim), []
    for time in times:
        sim.run(until=time)
        told.append(page.head()[f"full_{color}"])
    assert told == list(drawn.values())


class Page:
    """What a live page is told."""

    def __init__(self, sim):
        self.stage = Stage(sim, lambda: False)
        self.announcer = Announcer(self.stage)

    def head(self):
        # Paused, sums are read each time, not ten times a second.
        now = self.announcer.snapshot(playing=False, speed=1, reached=1, failure="")
        fields = FRAME_HEADER.unpack_from(now.frames[0])
        return dict(zip([*(name for name, _ in HEADER), *METERS], fields, strict=True))


def test_a_live_page_keeps_its_scale_through_a_push_and_gets_the_first_again_at_a_restart():
    sim = one(speed=1)
    page = Page(sim)
    assert page.head()["full_speed"] == 2
    sim.run(until=1)
    page.stage.act(Command("push", {"index": 0, "velocity": (1.9, 0, 0)}))
    assert page.head()["full_speed"] == 2
    page.stage.act(Command("push", {"index": 0, "velocity": (2.1, 0, 0)}))
    assert page.head()["full_speed"] == 5
    page.stage.act(Command("reverse", {}))
    assert page.head()["full_speed"] == 5
    page.stage.act(Command("restart", {}))
    assert page.head()["full_speed"] == 2


def test_a_picture_is_scaled_for_its_own_moment():
    sim = one(speed=1)
    state, world = sim.state, sim.world
    painter = Painter(state, world, Style(color="speed", size=(64, 36)))
    assert painter.end_of_scale(state) == 2
    sim.velocity = (100, 0, 0)
    fast = Painter(sim.state, world, Style(color="speed", size=(64, 36)))
    assert fast.end_of_scale(sim.state) == 200
