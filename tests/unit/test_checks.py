"""Numbers from outside: each refusal is one sentence with the value, the limit, the remedy."""

import pytest

from carom import InputError, scenes
from carom.checks import count


def test_a_count_the_machine_has_no_memory_for_is_refused_at_once() -> None:
    with pytest.raises(InputError, match=r"room for about .* spheres .*; ask for fewer"):
        count("n", 1e12)


def test_a_count_is_a_whole_number_of_spheres() -> None:
    assert count("n", 1e3) == 1000
    with pytest.raises(InputError, match="n is 0; it must be at least 1"):
        count("n", 0)


@pytest.mark.parametrize(
    "name", ["bounce", "fluid", "gas", "giant", "newton-cradle", "phase-0", "phase-3", "phase-4"]
)
def test_every_scene_with_a_number_of_spheres_checks_it(name: str) -> None:
    with pytest.raises(InputError, match="room for about"):
        scenes.build(name, {"n": 1e12})
