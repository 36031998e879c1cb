"""Continuations behind an artificial wall, on polynomials of the orders for which they are exact."""

from __future__ import annotations

import numpy as np
import pytest

from verification import wall_continuation
from verification.operator_forms import Cloud
from verification.wall_continuation import (
    FIRST,
    FIRST_NO_SLIP,
    GIVEN_SLOPE,
    MEAN,
    NO_SLIP,
    SECOND,
    Side,
    continuations,
)

SPACING, HEIGHT = 0.05, 0.52


def cloud(spacing=SPACING):
    """A box of size 1, periodic along x, its lattice moved by a fifth of a spacing."""
    along = np.arange(0.5 * spacing, 1.0, spacing)
    places = np.column_stack([axis.ravel() for axis in np.meshgrid(along, along)])
    places += 0.2 * spacing * np.random.default_rng(1).uniform(-1, 1, places.shape)
    return Cloud(places, np.empty((0, 2)), 0.0, np.array([1.0, 0.0]), spacing)


class Layers:
    """Polynomials of y alone, which are periodic in x, lowest power first."""

    def __init__(self, velocity, pressure):
        self.powers = velocity, pressure

    def velocity(self, x, y, t):
        return np.column_stack([np.polynomial.polynomial.polyval(y, self.powers[0]), 0 * x])

    def pressure(self, x, y, t):
        return np.polynomial.polynomial.polyval(y, self.powers[1])


class Waves:
    """A smooth field of period 1 along x, whose velocity on the wall is not zero."""

    def velocity(self, x, y, t):
        return np.column_stack([np.sin(2 * np.pi * x) * np.cos(3 * y), np.cos(2 * np.pi * x) * np.sin(2 * y)])

    def pressure(self, x, y, t):
        return np.cos(2 * np.pi * x) * np.exp(y)


def largest(reference, field, form):
    found = continuations(cloud(), reference, HEIGHT, step=0.01)
    return max(found[field, form].error)


def test_a_linear_field_is_continued_by_every_fit_and_not_by_means_alone():
    reference = Layers([1.0, 2.0], [3.0, -4.0])
    for form in (FIRST, FIRST_NO_SLIP, SECOND, NO_SLIP):
        assert largest(reference, "velocity", form) < 1e-10
    for form in (FIRST, SECOND, GIVEN_SLOPE):
        assert largest(reference, "pressure", form) < 1e-10
    assert largest(reference, "velocity", MEAN) > 1e-3
    assert largest(reference, "pressure", MEAN) > 1e-2


def test_a_quadratic_field_is_continued_by_fits_of_second_order():
    reference = Layers([1.0, 2.0, -5.0], [3.0, -4.0, 6.0])
    for field, form in (("velocity", SECOND), ("velocity", NO_SLIP), ("pressure", SECOND)):
        assert largest(reference, field, form) < 1e-10
    for field, form in (("velocity", FIRST), ("velocity", FIRST_NO_SLIP), ("pressure", GIVEN_SLOPE)):
        assert largest(reference, field, form) > 1e-3


def test_errors_grow_with_depth_and_fall_with_the_order():
    found = continuations(cloud(0.02), Waves(), HEIGHT, step=0.01)
    for errors in (continued.error for continued in found.values()):
        assert errors[0] < errors[1] < errors[2]
    for field in wall_continuation.FORMS:
        assert found[field, SECOND].error[2] < found[field, FIRST].error[2] < found[field, MEAN].error[2]


def test_what_a_wall_is_known_to_do_makes_a_fit_quieter():
    found = continuations(cloud(), Waves(), HEIGHT, step=0.01)
    noise = {key: continued.noise for key, continued in found.items()}
    assert noise["velocity", NO_SLIP][2] < 0.6 * noise["velocity", SECOND][2]
    assert noise["pressure", GIVEN_SLOPE][2] < 0.5 * noise["pressure", FIRST][2]
    assert max(noise["pressure", MEAN]) < 1


@pytest.mark.parametrize("form", [MEAN, FIRST, SECOND, GIVEN_SLOPE])
def test_a_constant_is_continued_as_it_is(form):
    feet = np.column_stack([np.arange(0.5, 20) * SPACING, np.full(20, HEIGHT)])
    i, _, share, across = Side(cloud(), feet, -1.0).shares(form, 1.5)
    assert np.bincount(i, share) == pytest.approx(1.0)
    assert (across >= 0).all()  # nothing is taken from behind the wall


def test_no_slip_on_a_wall_that_is_elsewhere_shows(monkeypatch):
    reference, whole = Layers([1.0, 2.0], [3.0, -4.0]), Side.near

    def displaced(side, depth):
        i, j, offset = whole(side, depth)
        return i, j, offset + [0.1 if depth == 0 else 0.0, 0.0]

    monkeypatch.setattr(Side, "near", displaced)
    assert largest(reference, "velocity", NO_SLIP) > 1e-3
