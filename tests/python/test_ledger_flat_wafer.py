"""Claims on a Gaussian asperity under a flat wafer: each verdict follows what is planted."""

from __future__ import annotations

from typing import Any

import pytest
from ledger_fakes import Planted

from verification.ledger import flat_wafer
from verification.ledger.evidence import CORRECTED, FAILS, HOLDS, Missing


def sweeps(slope: float, bent: float, rates: tuple[float, ...]) -> dict[str, Any]:
    width = {"points": 5, "slope": slope, "interval_95": [slope - 0.5, slope + 0.5], "largest_residual": bent}
    mean = sum(rates) / len(rates)
    gap = {
        "exponential": {"rate": mean, "interval_95": [mean - 0.3, mean + 0.3]},
        "local_rates": [{"rate": rate} for rate in rates],
    }
    return {"finite_elements": {"width": width, "gap": gap}}


@pytest.mark.parametrize(
    ("slope", "bent", "verdict"), [(9.0, 0.02, HOLDS), (14.0, 0.02, CORRECTED), (14.0, 0.3, FAILS)]
)
def test_slope_over_the_width(slope: float, bent: float, verdict: str) -> None:
    found = flat_wafer.slope_over_width(Planted(asperity=sweeps(slope, bent, (3.6, 3.6))))
    assert found.verdict == verdict


@pytest.mark.parametrize(
    ("rates", "verdict"),
    [((3.6, 3.7), HOLDS), ((5.0, 5.1), CORRECTED), ((5.2, 2.0), CORRECTED), ((9.0, 2.0), FAILS)],
)
def test_rate_over_the_gap(rates: tuple[float, ...], verdict: str) -> None:
    assert flat_wafer.rate_over_gap(Planted(asperity=sweeps(9, 0.02, rates))).verdict == verdict


@pytest.mark.parametrize(
    ("narrowest", "widest", "verdict"),
    [(2000.0, 130.0, HOLDS), (70.0, 130.0, FAILS), (2000.0, 60000.0, FAILS)],
)
def test_height_against_width(narrowest: float, widest: float, verdict: str) -> None:
    gap = [{"gap_m": 1e-6, "pressure_Pa": narrowest}, {"gap_m": 1e-5, "pressure_Pa": 60.0}]
    width = [{"width_m": 2e-6, "pressure_Pa": 110.0}, {"width_m": 1e-5, "pressure_Pa": widest}]
    of = {"gap": {"exponential": {}, "values": gap}, "width": {"points": 2, "values": width}}
    found = flat_wafer.height_matters_more(Planted(asperity={"sph": of, "finite_elements": of}))
    assert found.verdict == verdict


def test_the_growth_of_a_power_is_its_exponent() -> None:
    values = [{"gap_m": gap, "pressure_Pa": 5 * gap**-1.5} for gap in (1.0, 2.0, 4.0)]
    factor, exponent = flat_wafer.growth({"values": values}, "gap_m")
    assert (factor, exponent) == (pytest.approx(8), pytest.approx(1.5))


def test_without_sweeps_it_says_what_to_run() -> None:
    with pytest.raises(Missing, match="verification.asperity"):
        flat_wafer.height_matters_more(Planted())
