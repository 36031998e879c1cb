"""The ledger of claims: verdicts follow the evidence, and what was not run is not decided."""

from __future__ import annotations

from typing import Any

import pytest

from verification import claims
from verification.claims import CORRECTED, FAILS, HOLDS, OPEN, Evidence, Missing


def evidence(**parts: Any) -> Evidence:
    return Evidence(**({"results": None, "asperity": None, "abrasives": None} | parts))


def results(case: str, **passed: bool) -> dict[str, Any]:
    checks = [{"quantity": name, "value": 0.01, "passed": good} for name, good in passed.items()]
    common = {"case": case, "finest": True, "spacing_m": 1e-7}
    other = {**common, "scheme": "wang2014", "variant": "top_wall_moves", "checks": []}
    return {
        "level": "gate",
        "cases": [other, {**common, "scheme": "default", "variant": "top_wall_moves", "checks": checks}],
    }


def sweeps(slope: float, bent: float, rates: tuple[float, ...]) -> dict[str, Any]:
    width = {"points": 5, "slope": slope, "interval_95": [slope - 0.5, slope + 0.5], "largest_residual": bent}
    mean = sum(rates) / len(rates)
    gap = {
        "exponential": {"rate": mean, "interval_95": [mean - 0.3, mean + 0.3]},
        "local_rates": [{"rate": rate} for rate in rates],
    }
    return {"finite_elements": {"width": width, "gap": gap}}


def ensemble(**parts: Any) -> dict[str, Any]:
    models = [{"model": "linear", "aic": 10.0}, {"model": "cube root", "aic": 14.0}]
    result = {
        "rise": {"kendall_tau": 0.5, "p": 1e-4},
        "exponent_before": [0.5, 0.2, 0.8],
        "models_before": models,
        "slope_before_per_percent": [0.1, 0.05, 0.15],
        "slope_after_per_percent": [0.0, -0.05, 0.05],
    }
    return {"result": result | parts}


def test_without_evidence_nothing_but_arithmetic_is_decided() -> None:
    text = claims.ledger(evidence())
    rows = [line for line in text.splitlines() if line.startswith("| 4.")]
    assert len(rows) == len(claims.CLAIMS)
    assert sum("not decided" in row for row in rows) == len(rows) - 1
    assert "8 for 7, 15 for 14, 29 for 28" in text


@pytest.mark.parametrize("good", [True, False])
def test_a_claim_stands_or_falls_with_its_check(good: bool) -> None:
    found = claims.agrees_with_fluent(
        evidence(results=results("rough_channel", wafer_pressure=True, wafer_shear=good))
    )
    assert found.verdict == (HOLDS if good else FAILS)


def test_a_check_that_was_not_made_is_missing() -> None:
    with pytest.raises(Missing, match="make verify"):
        claims.threshold(evidence(results=results("rough_channel")))


@pytest.mark.parametrize(
    ("slope", "bent", "verdict"), [(9.0, 0.02, HOLDS), (14.0, 0.02, CORRECTED), (14.0, 0.3, FAILS)]
)
def test_slope_over_the_width(slope: float, bent: float, verdict: str) -> None:
    assert claims.slope_over_width(evidence(asperity=sweeps(slope, bent, (3.6, 3.6)))).verdict == verdict


@pytest.mark.parametrize(
    ("rates", "verdict"),
    [((3.6, 3.7), HOLDS), ((5.0, 5.1), CORRECTED), ((5.2, 2.0), CORRECTED), ((9.0, 2.0), FAILS)],
)
def test_rate_over_the_gap(rates: tuple[float, ...], verdict: str) -> None:
    assert claims.rate_over_gap(evidence(asperity=sweeps(9, 0.02, rates))).verdict == verdict


def test_a_cube_root_that_the_data_can_neither_prefer_nor_exclude_is_open() -> None:
    assert claims.cube_root(evidence(abrasives=ensemble())).verdict == OPEN


def test_a_cube_root_outside_of_the_exponents_interval_does_not_hold() -> None:
    found = claims.cube_root(evidence(abrasives=ensemble(exponent_before=[0.9, 0.7, 1.1])))
    assert found.verdict == FAILS


def test_a_cube_root_that_is_clearly_the_best_holds() -> None:
    models = [{"model": "cube root", "aic": 10.0}, {"model": "linear", "aic": 14.0}]
    assert claims.cube_root(evidence(abrasives=ensemble(models_before=models))).verdict == HOLDS


def test_saturation_needs_a_rise_before_it() -> None:
    assert claims.saturates(evidence(abrasives=ensemble())).verdict == HOLDS
    flat = ensemble(slope_before_per_percent=[0.0, -0.1, 0.1])
    assert claims.saturates(evidence(abrasives=flat)).verdict == OPEN
    rising = ensemble(slope_after_per_percent=[0.1, 0.05, 0.15])
    assert claims.saturates(evidence(abrasives=rising)).verdict == FAILS


def test_slopes_without_intervals_decide_nothing() -> None:
    single = ensemble(slope_before_per_percent=[0.2], slope_after_per_percent=[0.1])
    assert claims.saturates(evidence(abrasives=single)).verdict == OPEN


def test_a_rise_that_chance_explains_is_open() -> None:
    assert claims.rises(evidence(abrasives=ensemble(rise={"kendall_tau": 0.1, "p": 0.2}))).verdict == OPEN
