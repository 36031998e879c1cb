"""Claims on what abrasives do to the wafer's stresses: each verdict follows what is planted."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import h5py
import numpy as np
import pytest
from ledger_fakes import Planted, WaferTruth, results

from verification.case import load_case
from verification.ledger import abrasives
from verification.ledger.abrasives import FREE_CASE, FREE_VARIANT, SINGLE, SINGLE_VARIANT, Situations
from verification.ledger.evidence import CORRECTED, FAILS, HOLDS, OPEN, Missing

LENGTH, TOP, SIGMA = 4e-5, 2e-5, 5e-6
FREE = {
    (FREE_CASE, FREE_VARIANT): WaferTruth(
        lambda x, t: 400 * np.cos(2 * np.pi * x / LENGTH), lambda x: 287.0 + 0 * x
    )
}
ENSEMBLE = {"bands": [], "result": {}, "places": {"within sigma / 2": 0.01, "beyond": 0.99}}


def member(over: float, bulk: float, in_gap_area: float = 0.6) -> Situations:
    """One whose disc is over the top at half of its samples, and far from it at the others."""
    nearest = np.array([0.1, 0.2, 3.0, 3.5]) * SIGMA
    change = np.array([over, over, bulk, bulk])
    return Situations(nearest, change, change, np.full(4, in_gap_area))


def plant(monkeypatch: pytest.MonkeyPatch, members: list[Situations]) -> Planted:
    monkeypatch.setattr(abrasives, "situations", lambda evidence: members)
    return Planted(truths=FREE)


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ([(30, 5), (33, 6), (35, 4)], HOLDS),
        ([(5, 30), (6, 33), (4, 35)], FAILS),
        ([(30, 5), (10, 12), (20, 30)], OPEN),
        ([(30, 5)], OPEN),
    ],
)
def test_the_gap_against_the_bulk(
    changes: list[tuple[float, float]], verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = abrasives.passing_and_bulk(plant(monkeypatch, [member(*pair) for pair in changes]))
    assert found.verdict == verdict


def test_an_ensemble_without_the_bulk_decides_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    crowded = Situations(*(np.array([0.1 * SIGMA]) for _ in range(4)))
    with pytest.raises(Missing, match="more members"):
        abrasives.passing_and_bulk(plant(monkeypatch, [crowded]))


@pytest.mark.parametrize(
    ("shares", "verdict"),
    [((0.6, 0.7, 0.6), HOLDS), ((0.1, 0.12, 0.1), FAILS), ((0.1, 0.9, 0.1), OPEN), ((0.9,), OPEN)],
)
def test_the_gap_area_by_its_share_of_the_change(
    shares: tuple[float, ...], verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    members = [member(30, 5, share) for share in shares]
    assert abrasives.thinner_film(plant(monkeypatch, members)).verdict == verdict


def passage(at_top: float, at_flanks: float) -> Planted:
    """One disc that goes by, with what the greatest shear is while it is over the top and over the flanks."""
    times = np.linspace(0, 4e-5, 401)
    place = TOP + 12e-6 - 0.6 * times

    def greatest(time: np.ndarray) -> np.ndarray:
        away = np.abs(TOP + 12e-6 - 0.6 * time - TOP)
        return np.where(away < 0.3 * SIGMA, at_top, at_flanks)

    scene = load_case(SINGLE).scene()
    run = SimpleNamespace(
        scene=scene,
        wall_samples=lambda probe, field: (times, np.zeros(1), -greatest(times)[:, None]),
        disc=lambda name, field: (times, np.stack([place, 0 * place], axis=1)),
    )
    truth = SimpleNamespace(greatest_wafer_shear=lambda time: float(greatest(np.array(time))))
    return Planted(
        abrasives=ENSEMBLE,
        runs={(SINGLE, SINGLE_VARIANT): run},
        truths={**FREE, (SINGLE, SINGLE_VARIANT): truth},
    )


@pytest.mark.parametrize(
    ("at_top", "at_flanks", "verdict"),
    [(287.0, 380.0, CORRECTED), (380.0, 370.0, HOLDS), (287.0, 280.0, FAILS)],
)
def test_large_shear_by_where_the_disc_is(at_top: float, at_flanks: float, verdict: str) -> None:
    found = abrasives.shear_in_the_gap(passage(at_top, at_flanks))
    assert found.verdict == verdict
    assert "1 % within sigma / 2, 99 % beyond" in found.ours


@pytest.mark.parametrize(
    ("passed", "exact", "verdict"), [(True, 287.4, HOLDS), (False, 287.4, FAILS), (True, 250.0, FAILS)]
)
def test_the_threshold_by_its_check_and_the_reference(passed: bool, exact: float, verdict: str) -> None:
    truth = {(FREE_CASE, FREE_VARIANT): WaferTruth(lambda x, t: x, lambda x: -exact + 0 * x)}
    found = abrasives.threshold(Planted(results=results(FREE_CASE, threshold=passed), truths=truth))
    assert found.verdict == verdict
    assert f"{exact:.1f} Pa by finite elements" in found.truth


def test_a_threshold_that_was_not_checked_is_missing() -> None:
    with pytest.raises(Missing, match="make verify"):
        abrasives.threshold(Planted(results=results(FREE_CASE)))


def test_table_1_is_arithmetic() -> None:
    found = abrasives.table_1(Planted())
    assert (found.verdict, "8 for 7, 15 for 14, 29 for 28" in found.why) == (CORRECTED, True)


def write_member(path: Path, scene: dict[str, Any], change: float) -> None:
    """A disc that is over the top at one sample, where it changes the shear, and at the side at the next."""
    times = np.array([2e-5, 5e-5, 6e-5])
    along = (np.arange(200) + 0.5) * LENGTH / 200
    shear = []
    for index, time in enumerate(times):
        seen = (along - time) % LENGTH
        over = np.abs(seen - TOP) < SIGMA / 2
        shear.append(287.0 + change * over if index == 1 else 287.0 + 1e-3 * ~over)
    pressure = [400 * np.cos(2 * np.pi * (along - time) / LENGTH) for time in times]
    with h5py.File(path, "w") as file:
        group = file.create_group("probes/wafer")
        group["time"], group["x"], group["pressure"], group["shear"] = times, along, pressure, shear
        discs = file.create_group("discs")
        discs.attrs["names"] = "abrasive_1,abrasive_2"
        discs["time"] = times
        discs["position_x"] = [[TOP, 1e-6], [TOP, 1e-6], [1e-6, LENGTH - 1e-6]]
        discs["position_y"] = np.full((3, 2), 1.85e-5)
    assert scene["output"]["end_time"] == times[-1]


def test_situations_are_read_in_the_pads_frame(tmp_path: Path) -> None:
    scene = load_case("abrasives").scene()
    scene["output"]["end_time"] = 6e-5
    write_member(tmp_path / "result.h5", scene, change=40.0)
    free = abrasives.free_wafer(Planted(truths=FREE), abrasives.POINTS)
    found = Situations.of(tmp_path / "result.h5", scene, free)
    assert found.nearest == pytest.approx([0, 19e-6], abs=1e-12)  # the first sample is of the settling
    assert found.shear[0] == pytest.approx(40 * np.sqrt(SIGMA / LENGTH), rel=0.05)
    assert found.shear[1] == pytest.approx(0, abs=1e-2)
    assert found.pressure == pytest.approx([0, 0], abs=2)
    assert found.in_gap_area == pytest.approx([1, 0.15], abs=0.02)


def test_members_that_are_not_there_are_missing(tmp_path: Path) -> None:
    pair = {"fine_1": {"members": [[4, 1]]}}
    with pytest.raises(Missing, match="make figures"):
        abrasives.situations(
            Planted(build=tmp_path, truths=FREE, abrasives=ENSEMBLE | {"spacings": pair, "spacing_m": 2e-7})
        )
    with pytest.raises(Missing, match="make figures"):
        abrasives.situations(Planted())
