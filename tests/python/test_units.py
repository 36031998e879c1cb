"""Multiples of units that a person can read."""

import pytest
from matplotlib.figure import Figure

from verification.units import label, readable, text


@pytest.mark.parametrize(
    ("unit", "largest", "factor", "name"),
    [
        ("m", 4e-5, 1e-6, "µm"),
        ("s", 0.012, 1e-3, "ms"),
        ("Pa", 480.0, 1.0, "Pa"),
        ("Pa", 2.5e4, 1e3, "kPa"),
        ("1/s", 3e6, 1e6, "$10^{6}$/s"),
        ("kg/s", 9e-8, 1e-9, "$10^{-9}$ kg/s"),
        ("1", 1e-3, 1e-3, "$10^{-3}$"),
        ("1", 0.5, 1.0, "-"),
        ("m", 0.0, 1.0, "m"),
        ("m", float("nan"), 1.0, "m"),
    ],
)
def test_the_multiple_suits_the_numbers(unit, largest, factor, name):
    found = readable(unit, largest)
    assert found[0] == pytest.approx(factor, rel=1e-12)
    assert found[1] == name


def test_a_number_and_an_axis_are_given_in_it():
    assert text(4.56e-5, "s") == "45.6 µs"
    axes = Figure().subplots()
    axes.set_xlim(0, 4e-5)
    label(axes.xaxis, "x", "m")
    assert axes.get_xlabel() == "x (µm)"
    assert axes.xaxis.get_major_formatter()(3e-5, 0) == "30"
