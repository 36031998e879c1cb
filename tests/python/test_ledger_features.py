"""Claims on wafers with a feature: each verdict follows the pressure that is planted."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from ledger_fakes import Planted, WaferRun, WaferTruth, results, together

from verification.case import load_case
from verification.ledger import features
from verification.ledger.evidence import CORRECTED, FAILS, HOLDS, OPEN
from verification.ledger.features import CASE, VARIANTS

SCENES = {variant.name: load_case(CASE).scene(variant) for variant in load_case(CASE).variants}
LENGTH, PERIOD, UM = 4e-5, 4e-5, 1e-6
FLAT = [{"width_m": 2e-6, "pressure_Pa": 100.0}, {"width_m": 1e-5, "pressure_Pa": 100.0}]
ASPERITY = {"finite_elements": {"width": {"points": 2, "values": FLAT}}}


def bump(x: np.ndarray, place: float, width: float = 0.5 * UM) -> np.ndarray:
    apart = (x - place + LENGTH / 2) % LENGTH - LENGTH / 2
    return np.exp(-((apart / width) ** 2))


def fixed(place: float, height: float = 300.0) -> Callable[[np.ndarray, float], np.ndarray]:
    """High at a place of the wafer as the asperity is 2 um before it."""
    return lambda x, t: (
        height * bump(x, place) * float(bump(np.array([t % PERIOD]), place - 2 * UM, 4 * UM)[0])
    )


def planted(pressure: Callable[[np.ndarray, float], np.ndarray], *variants: str, **parts: object) -> Planted:
    chosen = variants or VARIANTS
    runs = {(CASE, name): WaferRun(SCENES[name], pressure) for name in chosen}
    return Planted(runs=runs, truths={(CASE, name): WaferTruth(pressure) for name in chosen}, **parts)


def test_where_the_features_end() -> None:
    assert features.ends(SCENES["arc"]) == pytest.approx((15.67 * UM, 24.33 * UM), abs=0.01 * UM)
    assert features.ends(SCENES["sine"]) == pytest.approx((11.34 * UM, 28.66 * UM), abs=0.01 * UM)


@pytest.mark.parametrize(
    ("place", "height", "verdict"), [(20 * UM, 300.0, HOLDS), (5 * UM, 300.0, FAILS), (20 * UM, 50.0, FAILS)]
)
def test_the_feature_area_by_the_greatest_pressure(place: float, height: float, verdict: str) -> None:
    evidence = planted(fixed(place, height), asperity=ASPERITY)
    assert features.high_in_the_feature(evidence).verdict == verdict


@pytest.mark.parametrize(
    ("ahead", "behind", "verdict"),
    [(2 * UM, -2 * UM, CORRECTED), (-1 * UM, -2 * UM, HOLDS), (12 * UM, -2 * UM, FAILS)],
)
def test_the_tip_by_where_the_field_is_highest(ahead: float, behind: float, verdict: str) -> None:
    def pressure(x: np.ndarray, t: float) -> np.ndarray:
        return bump(x, t + ahead, 2 * UM) - bump(x, t + behind, 2 * UM)

    found = features.around_the_tip(planted(pressure, "arc"))
    assert found.verdict == verdict
    if verdict == CORRECTED:
        assert "highest 2.1 to 2.1 um ahead of the tip" in found.ours


@pytest.mark.parametrize(("place", "verdict"), [(16 * UM, HOLDS), (24 * UM, FAILS), (5 * UM, FAILS)])
def test_the_corner_of_the_arc_that_is_met_first(place: float, verdict: str) -> None:
    assert features.corner_of_the_arc(planted(fixed(place), "arc")).verdict == verdict


@pytest.mark.parametrize(("place", "verdict"), [(15.7 * UM, HOLDS), (24.3 * UM, HOLDS), (20 * UM, FAILS)])
def test_the_corners_of_the_cavity(place: float, verdict: str) -> None:
    assert features.corner_of_the_cavity(planted(fixed(place), "cavity")).verdict == verdict


@pytest.mark.parametrize(("place", "verdict"), [(23 * UM, HOLDS), (15 * UM, FAILS)])
def test_the_pile_behind_the_hollow(place: float, verdict: str) -> None:
    assert features.pile_of_the_sine(planted(fixed(place), "sine")).verdict == verdict


def test_a_pile_that_is_high_once_the_asperity_is_past_does_not_hold() -> None:
    def late(x: np.ndarray, t: float) -> np.ndarray:
        return 300 * bump(x, 23 * UM) * float(bump(np.array([t % PERIOD]), 27 * UM, 4 * UM)[0])

    assert features.pile_of_the_sine(planted(late, "sine")).verdict == FAILS


@pytest.mark.parametrize("good", [True, False])
def test_the_period_by_every_features_check(good: bool) -> None:
    parts = [results(CASE, name, sample_repeats=good or name != "sine") for name in VARIANTS]
    evidence = Planted(results=together(*parts))
    assert features.repeats(evidence).verdict == (HOLDS if good else FAILS)


def test_the_peak_tells_where_the_asperity_is_and_nothing_of_the_papers() -> None:
    evidence = planted(fixed(23 * UM), "arc", results=results(CASE, "arc", sample_peak=0.006))
    found = features.peak_time(evidence)
    assert found.verdict == OPEN
    assert "0.53 T of ours, the asperity 2.0 um before the sample point" in found.truth
