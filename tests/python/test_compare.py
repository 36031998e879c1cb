import math

import numpy as np
import pytest

from verification.compare import (
    Check,
    CheckResult,
    DataError,
    measure,
    observed_order,
    require_reference_quality,
    require_series,
)


def check(metric="relative_l2", **changes):
    values = {
        "quantity": "q",
        "at": "series",
        "field": "f",
        "tolerance": 0.01,
        "kind": "exact",
        "why": "test",
    }
    return Check(metric=metric, **(values | changes))


def result(value, tolerance=0.01, order=None, **changes):
    return CheckResult(check(**changes), value, tolerance, order=order)


VECTORS = np.array([[3.0, 4.0], [0.0, 5.0]])


@pytest.mark.parametrize(
    ("metric", "error"),
    [
        ("relative_l1", 2 / 10),  # lengths of the errors over lengths of the reference
        ("relative_l2", math.sqrt(2) / math.sqrt(50)),
        ("relative_peak", 1 / 5),
    ],
)
def test_metrics_of_vectors(metric, error):
    measured = VECTORS + [[1.0, 0.0], [0.0, -1.0]]
    assert measure(check(metric), measured, VECTORS) == pytest.approx(error)


def test_relative_l1_sees_a_wrong_direction():
    assert measure(check("relative_l1"), -VECTORS, VECTORS) == pytest.approx(2)


def test_scalar_and_deviation():
    assert measure(check("relative_scalar"), 1.02, 1.0) == pytest.approx(0.02)
    assert measure(check("relative_scalar"), -1.0, 1.0) == pytest.approx(2)
    assert measure(check("largest_deviation"), [1.0, 0.7, 1.1], [1.0, 1.0, 1.0]) == pytest.approx(0.3)


def test_mean_is_subtracted_from_both_and_from_the_scale():
    reference = np.array([99.0, 101.0])
    assert measure(check(subtract_mean=True), reference + 50, reference) == pytest.approx(0)
    assert measure(check(subtract_mean=True), [98.0, 102.0], reference) == pytest.approx(1)


@pytest.mark.parametrize(
    ("measured", "reference", "reason"),
    [
        ([1.0, math.nan], [1.0, 1.0], "result holds 1 values that are not finite"),
        ([1.0, 1.0], [1.0, math.inf], "reference holds 1 values that are not finite"),
        ([1.0], [1.0, 1.0], "shape"),
        ([], [], "no data"),
        ([1.0, 1.0], [0.0, 0.0], "scale"),
    ],
)
def test_data_that_cannot_be_compared(measured, reference, reason):
    with pytest.raises(DataError, match=reason):
        measure(check(), measured, reference)


@pytest.mark.parametrize(
    ("values", "times", "reason"),
    [
        ([1.0, 2.0], [0.0, 0.0], "do not increase"),
        ([1.0, 2.0], [1.0, 0.0], "do not increase"),
        ([1.0, 2.0], [0.0], "2 samples for 1 times"),
        ([1.0, 2.0], [0.0, math.nan], "not finite"),
        ([], [], "no data"),
    ],
)
def test_series_are_refused_with_a_reason(values, times, reason):
    with pytest.raises(DataError, match=reason):
        require_series("series", values, times)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 0.0100001])
def test_only_a_finite_error_within_the_tolerance_passes(value):
    failing = result(value)
    assert not failing.passed
    assert failing.explanation()


def test_the_tolerance_itself_passes_and_a_reason_never_does():
    assert result(0.01).passed
    assert result(0.01).explanation() == ""
    assert not CheckResult(check(), 0.0, 0.01, reason="no data").passed


@pytest.mark.parametrize(
    ("order", "passes"), [(1.0, True), (0.8, True), (0.79, False), (3.1, False), (None, False)]
)
def test_the_order_band_has_two_sides(order, passes):
    assert result(0.001, order=order, order_band=(0.8, 3.0)).passed is passes
    assert result(0.001, order=math.nan, order_band=(0.8, 3.0)).passed is False
    assert result(0.001, order=order).passed


def test_a_known_shortfall_excuses_a_number_but_not_a_missing_one():
    assert result(0.02, known_shortfall="why").known_shortfall
    assert not result(0.02, known_shortfall="why").passed
    assert not result(math.nan, known_shortfall="why").known_shortfall
    assert not result(0.001, known_shortfall="why").known_shortfall
    assert not result(0.02).known_shortfall


def test_observed_order():
    spacings = [0.4, 0.2, 0.1]
    assert observed_order(spacings, [3 * h**1.5 for h in spacings]) == pytest.approx(1.5)
    assert observed_order(spacings[:2], [0.2, 0.1]) is None
    assert observed_order(spacings, [0.2, math.nan, 0.1]) is None
    assert observed_order(spacings, [0.2, 0.0, 0.1]) is None
    assert observed_order([0.1, 0.1, 0.1], [0.3, 0.2, 0.1]) is None


def test_a_poor_reference_is_refused():
    require_reference_quality(1e-3)
    for error in (1.1e-3, math.nan):
        with pytest.raises(DataError, match="the reference's own error"):
            require_reference_quality(error)
