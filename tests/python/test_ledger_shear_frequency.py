"""Claims on the frequency of active shear: each verdict follows what is planted."""

from __future__ import annotations

import pytest
from ledger_fakes import ALIKE, ensemble, whole

from verification import claims
from verification.ledger import shear_frequency
from verification.ledger.evidence import FAILS, HOLDS, OPEN, Evidence, Missing


def test_a_cube_root_that_the_data_can_neither_prefer_nor_exclude_is_open() -> None:
    assert shear_frequency.cube_root(ensemble()["result"]).verdict == OPEN


def test_a_cube_root_outside_of_the_exponents_interval_does_not_hold() -> None:
    found = shear_frequency.cube_root(ensemble(exponent_before=[0.9, 0.7, 1.1])["result"])
    assert found.verdict == FAILS


def test_a_cube_root_that_is_clearly_the_best_holds() -> None:
    models = [{"model": "cube root", "aic": 10.0}, {"model": "linear", "aic": 14.0}]
    assert shear_frequency.cube_root(ensemble(models_before=models)["result"]).verdict == HOLDS


def test_saturation_needs_a_rise_before_it() -> None:
    assert shear_frequency.saturates(ensemble()["result"]).verdict == HOLDS
    flat = ensemble(slope_before_per_percent=[0.0, -0.1, 0.1])
    assert shear_frequency.saturates(flat["result"]).verdict == OPEN
    rising = ensemble(slope_after_per_percent=[0.1, 0.05, 0.15])
    assert shear_frequency.saturates(rising["result"]).verdict == FAILS


def test_slopes_without_intervals_decide_nothing() -> None:
    single = ensemble(slope_before_per_percent=[0.2], slope_after_per_percent=[0.1])
    assert shear_frequency.saturates(single["result"]).verdict == OPEN


def test_a_rise_that_chance_explains_is_open() -> None:
    assert shear_frequency.rises(ensemble(rise={"kendall_tau": 0.1, "p": 0.2})["result"]).verdict == OPEN


def test_a_verdict_says_for_which_bands_it_holds() -> None:
    alike = shear_frequency.over_bands(shear_frequency.rises)(Evidence(abrasives=whole(ALIKE)))
    assert (alike.verdict, alike.range) == (HOLDS, "by bands of 1, 5 %")
    chance = whole({**ALIKE, 0.2: {"rise": {"kendall_tau": 0.1, "p": 0.2}}})
    chance["bands"].append(
        {"band": 0.5, "within_noise": False, "means": {"4": 0.0}, "reason": "no run changes"}
    )
    found = shear_frequency.over_bands(shear_frequency.rises)(Evidence(abrasives=chance))
    assert (found.verdict, found.range) == (HOLDS, "by bands of 1, 5 %; cannot be decided by 20, 50 %")
    assert "| holds, by bands of 1, 5 %; cannot be decided by 20, 50 % |" in claims.ledger(
        Evidence(abrasives=chance), shear_frequency.CLAIMS
    )


def test_an_ensemble_of_an_older_report_is_missing() -> None:
    with pytest.raises(Missing, match="make figures"):
        shear_frequency.over_bands(shear_frequency.rises)(Evidence(abrasives=ensemble()))
