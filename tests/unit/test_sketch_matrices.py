"""The sketch's matrix stack against matrices written out with NumPy."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.errors import InputError
from carom.sketch.matrices import DEEPEST, IDENTITY, MatrixStack

small = st.floats(-10, 10)
steps = st.lists(
    st.one_of(
        st.tuples(st.just("translate"), small, small, small),
        st.tuples(st.just("scale"), small, small, small),
        st.tuples(st.sampled_from(["rotate_x", "rotate_y", "rotate_z"]), small),
    ),
    max_size=6,
)


def written_out(name, *values):
    """The 4 × 4 matrix of one step, as textbooks print it."""
    m = np.eye(4)
    if name == "translate":
        m[:3, 3] = values
    elif name == "scale":
        m[:3, :3] = np.diag(values)
    else:
        c, s = math.cos(values[0]), math.sin(values[0])
        i, j = {"rotate_x": (1, 2), "rotate_y": (2, 0), "rotate_z": (0, 1)}[name]
        m[i, i], m[j, j], m[i, j], m[j, i] = c, c, -s, s
    return m


@given(steps, small, small, small)
def test_steps_are_products_of_matrices(program, x, y, z):
    stack, expected = MatrixStack(), np.eye(4)
    for name, *values in program:
        getattr(stack, name)(*values)
        expected = expected @ written_out(name, *values)
    scale = np.abs(expected).max() * 40
    assert stack.apply(x, y, z) == pytest.approx(expected[:3] @ (x, y, z, 1), abs=1e-12 * scale)
    found = np.array(stack.top).reshape(4, 3).T
    assert found == pytest.approx(expected[:3], abs=1e-12 * scale)


def test_the_last_step_acts_first():
    stack = MatrixStack()
    stack.translate(100.0, 0.0, 0.0)
    stack.rotate_z(math.pi / 2)  # y points down, so x turns down
    assert stack.apply(1.0, 0.0, 0.0) == pytest.approx((100.0, 1.0, 0.0))


def test_pop_comes_back_to_what_was_pushed():
    stack = MatrixStack()
    stack.translate(1.0, 2.0, 3.0)
    kept = stack.top
    stack.push()
    stack.scale(2.0, 3.0, 4.0)
    stack.push()
    stack.rotate_x(1.0)
    stack.pop()
    assert stack.apply(1.0, 1.0, 1.0) == (3.0, 5.0, 7.0)
    stack.pop()
    assert stack.top == kept
    assert stack.kept == []


def test_pop_without_push_and_push_without_end():
    stack = MatrixStack()
    with pytest.raises(InputError, match=r"pop_matrix\(\) without push_matrix\(\)"):
        stack.pop()
    assert stack.top == IDENTITY
    for _ in range(DEEPEST):
        stack.push()
    with pytest.raises(InputError, match="257 times without pop_matrix"):
        stack.push()
