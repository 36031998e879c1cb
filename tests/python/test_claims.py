"""The ledger of claims: verdicts follow the evidence, and what was not run is not decided."""

from __future__ import annotations

import json
from pathlib import Path
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


def whole(bands: dict[float, dict[str, Any]]) -> dict[str, Any]:
    """What `make figures` leaves, with other results by some bands; that of 0 is within the noise."""
    found = ensemble(rows=[{"count": 0, "members": 1}, {"count": 4, "members": 4}])
    rows = [
        {"band": band, "within_noise": band == 0, "means": {"4": 0.3}, "result": found["result"] | parts}
        for band, parts in bands.items()
    ]
    found["result"]["rule"] = {"band": 0.01, "threshold": 287.0}
    halves = {"later_less_earlier": 0.0, "interval": None, "rows": {"4": [0.3, 0.3]}}
    return found | {"bands": rows, "spacing_m": 2e-7, "halves": halves, "spacings": {}}


ALIKE: dict[float, dict[str, Any]] = {0.0: {"rise": {"kendall_tau": 0, "p": 1}}, 0.01: {}, 0.05: {}}


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
    assert claims.cube_root(ensemble()["result"]).verdict == OPEN


def test_a_cube_root_outside_of_the_exponents_interval_does_not_hold() -> None:
    found = claims.cube_root(ensemble(exponent_before=[0.9, 0.7, 1.1])["result"])
    assert found.verdict == FAILS


def test_a_cube_root_that_is_clearly_the_best_holds() -> None:
    models = [{"model": "cube root", "aic": 10.0}, {"model": "linear", "aic": 14.0}]
    assert claims.cube_root(ensemble(models_before=models)["result"]).verdict == HOLDS


def test_saturation_needs_a_rise_before_it() -> None:
    assert claims.saturates(ensemble()["result"]).verdict == HOLDS
    flat = ensemble(slope_before_per_percent=[0.0, -0.1, 0.1])
    assert claims.saturates(flat["result"]).verdict == OPEN
    rising = ensemble(slope_after_per_percent=[0.1, 0.05, 0.15])
    assert claims.saturates(rising["result"]).verdict == FAILS


def test_slopes_without_intervals_decide_nothing() -> None:
    single = ensemble(slope_before_per_percent=[0.2], slope_after_per_percent=[0.1])
    assert claims.saturates(single["result"]).verdict == OPEN


def test_a_rise_that_chance_explains_is_open() -> None:
    assert claims.rises(ensemble(rise={"kendall_tau": 0.1, "p": 0.2})["result"]).verdict == OPEN


def test_a_verdict_says_for_which_bands_it_holds() -> None:
    alike = claims.over_bands(claims.rises)(evidence(abrasives=whole(ALIKE)))
    assert (alike.verdict, alike.range) == (HOLDS, "by bands of 1, 5 %")
    chance = whole({**ALIKE, 0.2: {"rise": {"kendall_tau": 0.1, "p": 0.2}}})
    chance["bands"].append(
        {"band": 0.5, "within_noise": False, "means": {"4": 0.0}, "reason": "no run changes"}
    )
    found = claims.over_bands(claims.rises)(evidence(abrasives=chance))
    assert (found.verdict, found.range) == (HOLDS, "by bands of 1, 5 %; cannot be decided by 20, 50 %")
    assert "| holds, by bands of 1, 5 %; cannot be decided by 20, 50 % |" in claims.ledger(
        evidence(abrasives=chance)
    )


def test_an_ensemble_of_an_older_report_is_missing() -> None:
    with pytest.raises(Missing, match="make figures"):
        claims.over_bands(claims.rises)(evidence(abrasives=ensemble()))
    assert "`make figures` (none)" in claims.ledger(evidence(abrasives=ensemble()))


def test_the_ledger_says_what_each_part_is_from() -> None:
    text = claims.ledger(
        evidence(results={"level": "gate", "cases": []}, asperity={"level": "paper"}, abrasives=whole(ALIKE))
    )
    assert "`make verify` (level gate): Secs. 4.1 and 4.3" in text
    assert "`python -m verification.asperity` (level paper): Sec. 4.2" in text
    assert "`make figures` (4 members for each number of discs, spacing 2e-07 m): F_tau" in text


@pytest.fixture
def repository(tmp_path: Path) -> list[str]:
    """A ledger, a page with markers and no evidence; the command line for them."""
    (tmp_path / "claims.md").write_text("of earlier\n")
    (tmp_path / "README.md").write_text("<!-- sensitivity:begin -->\n<!-- sensitivity:end -->\n")
    paths = {"--build": "build", "--to": "claims.md", "--page": "README.md"}
    return [text for option, name in paths.items() for text in (option, str(tmp_path / name))]


def test_a_clone_without_evidence_keeps_its_ledger(
    repository: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert claims.main(repository) == 2
    assert (tmp_path / "claims.md").read_text() == "of earlier\n"
    message = capsys.readouterr().err
    for command in (
        "make verify",
        "make verify LEVEL=paper",
        "python -m verification.asperity",
        "make figures",
    ):
        assert f"`{command}`" in message


def test_whole_evidence_makes_the_ledger_and_the_page(
    repository: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(claims, "CLAIMS", [claim for claim in claims.CLAIMS if "F_tau" in claim.text])
    (tmp_path / "build/figures").mkdir(parents=True)
    (tmp_path / "build/figures/abrasives.json").write_text(json.dumps(whole(ALIKE)))
    assert claims.main(repository) == 0
    assert "F_tau rises" in (tmp_path / "claims.md").read_text()
    assert "| 5 % | 0.30 |" in (tmp_path / "README.md").read_text()
