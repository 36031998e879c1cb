"""From when on a run is within bounds of the steady answer."""

from __future__ import annotations

import numpy as np
import pytest

from verification import transients
from verification.case import CaseError

TIMES = np.arange(5.0)


class Steady:
    """A wafer's pressure and shear that move with the flow at 1 m/s, and their energy."""

    def wall_pressure(self, wall, x, t):
        return 3.0 + np.sin(2 * np.pi * (x - t))

    def wall_shear(self, wall, x, t):
        return 2.0 + np.cos(2 * np.pi * (x - t))

    def kinetic_energy(self, t):
        return 4.0


class Decaying:
    """What a run has of it: all is off by a share that falls with time."""

    def wall_samples(self, probe, field):
        x, steady = np.linspace(0, 1, 20, endpoint=False), Steady()
        exact = steady.wall_pressure if field == "pressure" else steady.wall_shear
        shift = 7.0 if field == "pressure" else 0.0
        mean = 3.0 if field == "pressure" else 0.0
        samples = [mean + (1 + 0.3 ** (t + 1)) * (exact("wafer", x, t) - mean) + shift for t in TIMES]
        return TIMES, x, np.array(samples)

    def series(self, name):
        return TIMES, 4.0 * (1 - 0.3 ** (TIMES + 1))


@pytest.mark.parametrize(
    ("errors", "expected"),
    [([0.0, 0.0, 0.0], 0.0), ([0.5, 0.0, 0.1], 1.0), ([0.0, 0.5, 0.0], 2.0), ([0.0, 0.0, 0.5], np.nan)],
)
def test_settled_is_the_first_sample_from_which_on_all_are_within(errors, expected):
    assert transients.settled(TIMES[:3], np.array(errors), 0.2) == pytest.approx(expected, nan_ok=True)


def test_not_a_number_has_not_settled():
    assert np.isnan(transients.settled(TIMES[:3], np.array([0.0, 0.0, np.nan]), 0.2))


def test_errors_are_those_of_each_time_and_a_mean_pressure_is_none():
    found = transients.errors_over_time(Decaying(), Steady())
    assert set(found) == set(transients.BOUNDS)
    for times, errors in found.values():
        assert list(times) == list(TIMES)
        assert errors == pytest.approx(0.3 ** (TIMES + 1))


def test_the_page_has_the_table():
    text = transients.PAGE.read_text()
    assert all(f"| {name} |" in text for name in transients.STARTS)


def test_a_start_that_stops_is_told_and_a_default_that_stops_is_not_passed_over(monkeypatch):
    def finished(run, options):
        if run.variant.name.endswith(", default") and not default_stops:
            return Decaying()
        raise CaseError("it stopped")

    monkeypatch.setattr(transients, "finished", finished)
    monkeypatch.setattr(transients.References, "of", lambda *rest: Steady())
    default_stops = False
    text = transients.measure(None)["transients"].markdown()
    assert "| top wall moves | relaxed | stops |" in text
    assert "| top wall moves | default | stops |" not in text
    default_stops = True
    with pytest.raises(CaseError):
        transients.measure(None)
