"""The five phases against the paper: sizes, speeds, walls, colours, what phase 2 prints."""

import numpy as np
import pytest

from carom import Simulation, fit, scenes
from carom.errors import InputError
from carom.walls import Box, Sphere

PHASES = [f"phase-{k}" for k in range(5)]


def hue_saturation_brightness(color):
    """Back from 0xRRGGBB to the paper's HSB."""
    rgb = np.array([color >> 16 & 255, color >> 8 & 255, color & 255]) / 255
    return (1 - rgb.min(axis=0) / rgb.max(axis=0)) * 100, rgb.max(axis=0) * 100


@pytest.mark.parametrize("name", PHASES)
def test_what_all_phases_share(name):
    scene = scenes.build(name)
    assert scene.pace == 60
    assert scene.wire
    assert scene.color == "energy"
    assert scene.rule.restitution == 1
    assert scene.gravity == (0, 0, 0)
    assert len(scene.spheres) == (2 if name == "phase-2" else 12)
    saturation, brightness = hue_saturation_brightness(scene.spheres.color)
    assert saturation.min() > 99  # full: the view takes it away with the energy
    assert brightness.min() > 69
    assert len(np.unique(scene.spheres.color)) == len(scene.spheres)


@pytest.mark.parametrize("name", PHASES)
def test_velocities_are_even_up_to_10_10_20(name):
    velocity = np.concatenate(
        [scenes.build(name, {"seed": seed}).spheres.velocity for seed in range(40)]
    )
    limit = np.array([10, 10, 20])
    assert (np.abs(velocity) <= limit).all()
    assert (np.abs(velocity).max(axis=0) > 0.9 * limit).all()
    # Variance of an even distribution: limit^2 / 3.
    assert velocity.var(axis=0) == pytest.approx(limit**2 / 3, rel=0.3)


@pytest.mark.parametrize("name", PHASES[:4])
def test_radius_50_and_mass_1(name):
    spheres = scenes.build(name).spheres
    assert (spheres.radius == 50).all()
    assert (spheres.mass == 1).all()


@pytest.mark.parametrize("name", PHASES[:2])
def test_phases_0_and_1_start_at_the_centre_and_pass_through(name):
    scene = scenes.build(name)
    assert not scene.collide
    assert not scene.spheres.position.any()


def test_phase_0_is_a_sphere_of_radius_width_that_bounces_back():
    assert scenes.phase_0().walls == (Sphere(500, reflection="bounce-back"),)
    assert scenes.phase_0(width=300).walls[0].radius == 300
    # |location| + radius > width: the whole velocity turns round.
    sim = Simulation(scenes.phase_0(n=1))
    before = sim.velocity.copy()
    sim.run(events=1)
    assert sim.velocity.tolist() == (-before).tolist()
    assert np.sqrt((sim.position**2).sum()) == pytest.approx(450, rel=1e-12)


@pytest.mark.parametrize("name", PHASES[1:])
def test_phases_1_to_4_are_a_cube_of_side_width(name):
    assert scenes.build(name).walls == (Box(500, 500, 500),)
    assert scenes.build(name, {"width": 600}).walls == (Box(600, 600, 600),)


@pytest.mark.parametrize("name", PHASES[2:])
def test_phases_2_to_4_start_at_random_places_that_do_not_overlap(name):
    scene = scenes.build(name)
    assert scene.collide
    s = scene.spheres
    assert fit.first_overlap(s.position, s.radius, s.fixed, np.zeros(3)) is None
    assert (np.abs(s.position) + s.radius[:, np.newaxis] <= 250).all()


def test_phase_4_has_radii_20_to_60_and_masses_with_the_volume():
    radius = np.concatenate([scenes.phase_4(seed=k).spheres.radius for k in range(20)])
    assert 20 <= radius.min() < 24
    assert 56 < radius.max() <= 60
    s = scenes.phase_4(n=7).spheres
    assert s.mass.mean() == pytest.approx(1, rel=1e-14)
    assert s.mass / s.radius**3 == pytest.approx(s.mass[0] / s.radius[0] ** 3)


def test_number_of_balls():
    assert len(scenes.phase_3(n=20).spheres) == 20
    with pytest.raises(InputError, match="n is 0; it must be at least 1"):
        scenes.phase_0(n=0)
    with pytest.raises(InputError, match="cannot reach packing fraction"):
        scenes.phase_3(n=200)
    with pytest.raises(InputError, match="does not fit into a box of 60 x 60 x 60"):
        scenes.phase_2(width=60)


def test_what_phase_2_prints():
    text = scenes.phase_2_lines(3, (0, 0.6, -0.8), -7.25, (12.5, 0.75))
    assert text.splitlines() == [
        "collision 3",
        "|n| = 1.000000",
        "psi = -7.250000",
        "KE = 12.500000, 0.750000",
        "total KE = 13.250000",
    ]


def test_phase_2_collides_and_keeps_its_energy():
    sim = Simulation(scenes.phase_2())
    start = sim.kinetic_energy
    sim.run(collisions=3)
    assert sim.collisions == 3
    assert sim.kinetic_energy == pytest.approx(start, rel=1e-14)
