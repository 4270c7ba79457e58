"""The rule of smooth spheres: what it holds, and what it refuses."""

import math

import pytest

from carom.errors import InputError
from carom.rules import Smooth


def test_elastic_by_default() -> None:
    assert Smooth() == Smooth(restitution=1, contact_time=None)


def test_examples_are_rules_of_every_kind() -> None:
    examples = Smooth.examples()
    assert {rule.restitution for rule in examples} >= {0, 1}
    assert any(rule.contact_time for rule in examples)


@pytest.mark.parametrize("e", [-1e-9, 1.0000001, math.nan, math.inf, -math.inf, "1", None, True])
def test_restitution_outside_0_to_1_is_refused(e) -> None:
    with pytest.raises(InputError, match="restitution"):
        Smooth(e)


def test_the_message_names_value_and_limit() -> None:
    with pytest.raises(
        InputError, match=r"restitution is 1\.5; it must be at least 0 and at most 1"
    ):
        Smooth(1.5)


@pytest.mark.parametrize("tc", [0, -1, math.nan, math.inf, "x"])
def test_contact_time_must_be_positive(tc) -> None:
    with pytest.raises(InputError, match="contact_time"):
        Smooth(0.9, contact_time=tc)


def test_rules_are_frozen() -> None:
    with pytest.raises(AttributeError):
        Smooth().restitution = 0.5
