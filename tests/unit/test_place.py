"""Where spheres start and how fast: lattices, random places, Maxwell velocities."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom import fit
from carom.errors import InputError
from carom.place import (
    DENSEST,
    cube_edge,
    cube_root,
    fcc,
    fluid_cells,
    maxwell,
    random_positions,
    simple_cubic,
)
from carom.random_numbers import Random


def nearest(x, period):
    """Smallest distance between two sites, nearest images included."""
    d = x[:, np.newaxis] - x
    d -= np.rint(d / period) * period
    r = np.sqrt((d**2).sum(axis=2))
    return r[np.triu_indices(len(x), 1)].min()


def test_cube_root_is_correct_to_the_last_bit():
    assert [cube_root(x) for x in (0.001, 1, 27, 1e30)] == [0.1, 1, 3, 1e10]
    for x in Random(1).uniform(200, low=1e-3, high=1e6):
        assert cube_root(x) == pytest.approx(x ** (1 / 3), rel=4e-16)


def test_simple_cubic():
    x = simple_cubic(2, 3, 4, spacing=1.5)
    assert x.shape == (24, 3)
    assert x.mean(axis=0).tolist() == [0, 0, 0]
    assert np.ptp(x, axis=0).tolist() == [1.5, 3, 4.5]
    assert nearest(x, 1e9) == 1.5


def test_fcc_fills_its_box_evenly():
    x = fcc(3, 3, 3, size=6)
    assert x.shape == (108, 3)
    assert (np.abs(x) < 3).all()
    assert nearest(x, 6) == pytest.approx(math.sqrt(2))
    # Each site has twelve neighbours: that is what makes it face-centred.
    d = x - x[0]
    d -= np.rint(d / 6) * 6
    assert (np.abs(np.sqrt((d**2).sum(axis=1)) - math.sqrt(2)) < 1e-12).sum() == 12


def test_fcc_cells_need_not_be_cubes():
    x = fcc(2, 3, 1, size=(4, 9, 5))
    assert len(x) == 24
    assert len(np.unique(x[:, 0])) == 4
    assert len(np.unique(x[:, 1])) == 6
    assert len(np.unique(x[:, 2])) == 2


# --- Maxwell ---------------------------------------------------------------------------


@pytest.mark.parametrize("conserved", [3, 0])
def test_momentum_is_zero_and_the_temperature_exact(conserved):
    mass = Random(1).uniform(1000, low=0.5, high=50)
    v = maxwell(Random(2), mass, temperature=2.5, conserved=conserved)
    assert np.abs((v * mass[:, np.newaxis]).sum(axis=0)).max() < 1e-10
    kinetic = (mass * (v**2).sum(axis=1)).sum() / 2
    assert 2 * kinetic / (3 * 1000 - conserved) == pytest.approx(2.5, rel=1e-14)


def test_heavy_spheres_are_as_warm_as_light_ones():
    mass = np.where(np.arange(20_000) % 2, 1.0, 25.0)
    v = maxwell(Random(3), mass)
    energy = mass * (v**2).sum(axis=1)
    for part in (energy[0::2], energy[1::2]):  # 3 kT each, variance 6
        assert abs(part.mean() - 3) < 4 * math.sqrt(6 / len(part))


def test_cold_and_impossible():
    assert not maxwell(Random(1), np.ones(5), temperature=0).any()
    with pytest.raises(InputError, match="temperature is -1"):
        maxwell(Random(1), np.ones(5), temperature=-1)
    with pytest.raises(InputError, match="at rest"):
        maxwell(Random(1), np.ones(1))


# --- random places ---------------------------------------------------------------------


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 2**32),
    n=st.integers(1, 60),
    periodic=st.tuples(st.booleans(), st.booleans(), st.booleans()),
    size=st.tuples(*[st.floats(3, 12)] * 3),
)
def test_random_places_do_not_overlap_and_stay_inside(seed, n, periodic, size):
    random = Random(seed)
    radius = random.uniform(n, low=0.1, high=0.4)
    x = random_positions(random, radius, size, periodic)
    period = np.where(periodic, size, 0)
    assert fit.first_overlap(x, radius, np.zeros(n, bool), period) is None
    reach = np.where(periodic, 0, radius[:, np.newaxis])
    assert (np.abs(x) + reach <= np.array(size) / 2).all()


def test_random_places_keep_clear_of_what_is_there():
    radius = np.full(300, 0.5)
    x = random_positions(Random(1), radius, (12, 12, 12), avoid=([(1, 0, 0)], [4.0]))
    assert (np.sqrt(((x - [1, 0, 0]) ** 2).sum(axis=1)) >= 4.5).all()


def test_random_places_are_even():
    x = random_positions(Random(4), np.full(2000, 1e-3), (2, 4, 6))
    for axis, half in enumerate((1, 2, 3)):
        counts = np.histogram(x[:, axis], bins=8, range=(-half, half))[0]
        assert np.abs(counts - 250).max() < 4 * math.sqrt(250)


def test_what_has_no_random_place_is_refused():
    message = r"packing fraction 0\.524: it found places for 0 of 1000 .* carom\.place\.fcc"
    with pytest.raises(InputError, match=message):
        random_positions(Random(1), np.full(1000, 0.5), (10, 10, 10))
    with pytest.raises(InputError, match=r"cannot reach packing fraction 0\.38"):
        random_positions(Random(1), np.full(58, 0.5), (4.3, 4.3, 4.3))
    with pytest.raises(InputError, match=r"radius 1.5 does not fit into a box of 2 x 2 x 9"):
        random_positions(Random(1), np.array([0.1, 1.5]), (2, 2, 9))


def test_no_spheres_need_no_place():
    assert random_positions(Random(1), np.zeros(0), (1, 1, 1)).shape == (0, 3)


# --- the fluid's grid ------------------------------------------------------------------


@settings(max_examples=150, deadline=None)
@given(n=st.integers(2, 500), phi=st.floats(0.01, 0.6))
def test_a_grid_has_places_enough_and_no_two_overlap(n, phi):
    try:
        cells = fluid_cells(n, phi)
    except InputError as error:
        near = int(str(error).split()[-1])
        fluid_cells(near, phi)
        # No number nearer to n can be placed.
        for k in range(max(1, n - abs(n - near) + 1), n + abs(n - near)):
            with pytest.raises(InputError, match="cannot be placed"):
                fluid_cells(k, phi)
        return
    side = cube_edge(n, phi)
    x = fcc(*cells, size=side)
    assert len(x) >= n
    assert nearest(x, side) >= 1 - 1e-12
    assert side >= 1
    assert n * math.pi / 6 / side**3 == pytest.approx(phi, rel=1e-14)


@pytest.mark.parametrize("phi", [0.05, 0.25, 0.45, 0.49])
@pytest.mark.parametrize("n", [100, 500, 864, 1000, 1372, 4000, 10_000, 32_000, 10**6])
def test_usual_fluids_can_be_placed(n, phi):
    nx, ny, nz = fluid_cells(n, phi)
    assert 4 * nx * ny * nz >= n


def test_close_packing_can_be_placed():
    assert fluid_cells(108, DENSEST - 1e-12) == (3, 3, 3)


@pytest.mark.parametrize("phi", [0, -0.1, 0.75, math.nan, math.inf])
def test_impossible_packing_fractions_are_refused(phi):
    with pytest.raises(InputError, match="packing_fraction is"):
        fluid_cells(100, phi)


def test_an_impossible_number_names_the_nearest():
    with pytest.raises(InputError, match=r"n = 5 cannot .* the nearest number that can is 4"):
        fluid_cells(5, 0.49)
    with pytest.raises(InputError, match="n is 0"):
        fluid_cells(0, 0.49)
