"""The forms of the sums on polynomials of the orders for which they are exact, and with planted faults."""

from __future__ import annotations

import numpy as np
import pytest

from verification import operator_forms
from verification.compare import DataError
from verification.operator_forms import (
    DIVERGENCE,
    FIT,
    FORMS,
    GRADIENT,
    MOMENTS,
    SOLVER,
    VISCOUS,
    Cloud,
    sums,
)

SPACING = 0.05


def cloud(jitter=0.2, period=0.0):
    """A box of size 1, its lattice moved by `jitter` spacings; `period` 0: open on all sides."""
    along = np.arange(0.5 * SPACING, 1.0, SPACING)
    places = np.column_stack([axis.ravel() for axis in np.meshgrid(along, along)])
    places += jitter * SPACING * np.random.default_rng(1).uniform(-1, 1, places.shape)
    return Cloud(places, np.empty((0, 2)), 0.0, np.array([period, period]), SPACING)


def largest_errors(velocity, pressure, gradient, laplacian, divergence, jitter=0.2):
    """The largest error of each form among particles with all their neighbours, of functions of x and y."""
    box = cloud(jitter)
    x, y = box.position.T
    exact = {
        GRADIENT: np.column_stack(gradient(x, y)),
        VISCOUS: np.column_stack(laplacian(x, y)),
        DIVERGENCE: divergence(x, y)[:, None],
    }
    inner = (np.abs(box.position - 0.5) < 0.5 - 4 * SPACING).all(axis=1)
    found = sums(box, np.column_stack(velocity(x, y)), pressure(x, y))
    return {key: np.abs(found[key] - exact[key[0]])[inner].max() for key in found if key[0] in exact}


def linear(**more):
    return largest_errors(
        velocity=lambda x, y: (1 + 2 * x - 3 * y, 4 * x + 5 * y),
        pressure=lambda x, y: 3 + x - 2 * y,
        gradient=lambda x, y: (1 + 0 * x, -2 + 0 * x),
        laplacian=lambda x, y: (0 * x, 0 * x),
        divergence=lambda x, y: 7 + 0 * x,
        **more,
    )


def quadratic(**more):
    return largest_errors(
        velocity=lambda x, y: (1 + x + 2 * x**2 - 3 * x * y, y**2 + 4 * x * y - x**2),
        pressure=lambda x, y: 3 + x**2 - 2 * x * y + 3 * y**2,
        gradient=lambda x, y: (2 * x - 2 * y, -2 * x + 6 * y),
        laplacian=lambda x, y: (4 + 0 * x, 0 * x),
        divergence=lambda x, y: 1 + 4 * x - 3 * y + 2 * y + 4 * x,
        **more,
    )


OF_FIRST_ORDER = {
    (GRADIENT, "(p_j - p_i) B_i"),
    (VISCOUS, "of the remainder, over moments"),
    (DIVERGENCE, "(v_j - v_i) B_i"),
}
FITS = {(name, FIT) for name in FORMS}


def test_the_kernel_is_the_solver_s():
    radii = np.linspace(1e-6, 3, 20001)
    slope, value = operator_forms.kernel_slope(radii**2), operator_forms.kernel_value(radii**2)
    assert np.pi * -np.trapezoid(slope * radii**3, radii) == pytest.approx(1.0, abs=1e-6)  # as a delta's
    assert 2 * np.pi * np.trapezoid(value * radii, radii) == pytest.approx(1.0, abs=1e-6)
    assert np.gradient(value, radii)[1:-1] == pytest.approx((slope * radii)[1:-1], abs=1e-6)
    assert operator_forms.kernel_slope(np.array([9.0, 10.0])).tolist() == [0.0, 0.0]


def test_without_coefficients_nothing_is_measured(tmp_path, monkeypatch):
    monkeypatch.setattr(operator_forms, "KERNEL", tmp_path / "kernel.hpp")
    operator_forms.KERNEL.write_text("struct FittedQuintic {};")
    with pytest.raises(DataError, match="coefficients"):
        operator_forms.kernel_slope(np.array([1.0]))


def test_there_are_all_forms():
    found = sums(cloud(), np.zeros((400, 2)), np.zeros(400))
    assert set(found) == {(name, form) for name, forms in FORMS.items() for form in forms} | {(MOMENTS, "")}
    assert set(SOLVER.items()) <= set(found)


def test_corrected_forms_are_exact_for_linear_fields_in_disorder_and_the_others_are_not():
    errors = linear()
    for key, error in errors.items():
        assert error < 1e-9 if key in OF_FIRST_ORDER | FITS else error > 1e-2, key


def test_only_the_fits_are_exact_for_quadratic_fields():
    errors = quadratic()
    for key, error in errors.items():
        assert error < 1e-8 if key in FITS else error > 1e-2, key


def test_on_a_lattice_the_moments_are_all_that_a_linear_field_s_sums_miss():
    errors = linear(jitter=0.0)
    assert errors[GRADIENT, "p_j - p_i"] == pytest.approx(2 * 1.9e-4, rel=0.05)
    assert errors[DIVERGENCE, "v_j - v_i"] == pytest.approx(7 * 1.9e-4, rel=0.05)


def test_a_viscous_force_over_its_moments_is_exact_on_a_lattice():
    errors = quadratic(jitter=0.0)
    assert errors[VISCOUS, "v_i - v_j"] == pytest.approx(4 * 1.9e-4, rel=0.05)
    assert errors[VISCOUS, "over moments"] < 1e-10


@pytest.mark.parametrize("form", FORMS[GRADIENT])
def test_forms_that_are_symmetric_in_a_pair_conserve_momentum(form):
    box = cloud(period=1.0)
    x, y = 2 * np.pi * box.position.T
    total = sums(box, 0 * box.position, 3 + np.cos(x) * np.sin(y))[GRADIENT, form].sum(axis=0)
    conserves = form in ("p_i + p_j", "p_i B_i + p_j B_j")
    assert np.abs(total).max() < 1e-9 if conserves else np.abs(total).max() > 1e-3


def test_a_kernel_of_the_wrong_strength_shows_in_all_but_what_is_corrected(monkeypatch):
    sound, kernel = quadratic(jitter=0.0), operator_forms.kernel_slope
    monkeypatch.setattr(operator_forms, "kernel_slope", lambda squared: 1.02 * kernel(squared))
    faulty = quadratic(jitter=0.0)
    for key in [(GRADIENT, "p_i + p_j"), (VISCOUS, "v_i - v_j"), (DIVERGENCE, "v_j - v_i")]:
        assert faulty[key] > 10 * sound[key]
    for key in OF_FIRST_ORDER | FITS | {(VISCOUS, "over moments")}:
        assert faulty[key] == pytest.approx(sound[key], abs=1e-8)


def test_a_fit_without_its_mixed_term_shows(monkeypatch):
    complete = operator_forms.quadratic
    monkeypatch.setattr(
        operator_forms, "quadratic", lambda x, y: complete(x, y) + np.outer(x**3 - x * y, [0, 0, 0, 1, 0])
    )
    assert linear()[GRADIENT, FIT] < 1e-9
    assert quadratic()[GRADIENT, FIT] > 1e-2
