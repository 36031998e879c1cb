"""Claims on the method: each verdict follows what is planted."""

from __future__ import annotations

import math
from typing import Any

import pytest
from ledger_fakes import Planted, results, together

from verification.ledger import method
from verification.ledger.evidence import CORRECTED, FAILS, HOLDS, OPEN, Missing


@pytest.mark.parametrize(
    ("dimension", "factor", "verdict"),
    [(3, 1 / (120 * math.pi), HOLDS), (3, 3 / (359 * math.pi), CORRECTED), (2, 7 / (479 * math.pi), FAILS)],
)
def test_factors_of_the_kernel(dimension: int, factor: float, verdict: str) -> None:
    right = {**method.FACTORS, 3: 1 / (120 * math.pi)}
    found = method.kernel_factors(Planted(), right | {dimension: factor})
    assert found.verdict == verdict
    assert ("1/(120 pi)" in found.why) == (verdict == CORRECTED)


@pytest.mark.parametrize(("passed", "verdict"), [(True, CORRECTED), (False, FAILS)])
def test_momentum_by_its_check(passed: bool, verdict: str) -> None:
    evidence = Planted(results=results("disc_conservation", momentum_step=passed))
    assert method.conserves(evidence).verdict == verdict


def change(name: str, *pressures: float, failures: int = 0) -> dict[str, Any]:
    members = [{"errors": {"pressure": value}, "failure": ""} for value in pressures]
    return {"name": name, "members": members + [{"errors": {}, "failure": "stopped"}] * failures}


@pytest.mark.parametrize(
    ("without", "verdict"), [((0.08, 0.07), HOLDS), ((0.021, 0.019), OPEN), ((0.004, 0.005), FAILS)]
)
def test_gradient_correction_by_the_ablation(without: tuple[float, ...], verdict: str) -> None:
    rows = [
        change("default scheme", 0.02, 0.022),
        change("without gradient correction", *without),
        change("without density diffusion", 0.1, 0.12),
    ]
    found = method.gradient_correction(Planted(ablation={"rough_channel_x": {"rows": rows}}))
    assert found.verdict == verdict
    assert "11 +- 1 %" in found.why


@pytest.mark.parametrize(
    ("stopped", "kept", "verdict"),
    [((2, 0), 0, HOLDS), ((1, 1), 0, OPEN), ((0, 2), 0, FAILS), ((2, 0), 2, FAILS)],
)
def test_transport_velocity_by_the_runs_that_stop(stopped: tuple[int, int], kept: int, verdict: str) -> None:
    without = change("without transport velocity", *[0.1] * stopped[1], failures=stopped[0])
    default = change("default scheme", *[0.1] * (2 - kept), failures=kept)
    ablation = {case: {"rows": [default, without]} for case in ("rough_channel_x", "taylor_green_x")}
    assert method.transport_velocity(Planted(ablation=ablation)).verdict == verdict


def test_without_an_ablation_it_says_what_to_run() -> None:
    with pytest.raises(Missing, match="make ablation"):
        method.gradient_correction(Planted())
    with pytest.raises(Missing, match="make bench"):
        method.plane_sweep(Planted())


@pytest.mark.parametrize(("passed", "verdict"), [(True, HOLDS), (False, FAILS)])
def test_repulsion_by_both_overlaps(passed: bool, verdict: str) -> None:
    both = together(results("disc_pair", overlap=True), results("abrasives", overlap=passed))
    assert method.repulsion(Planted(results=both)).verdict == verdict


@pytest.mark.parametrize(("seconds", "verdict"), [(1.5, HOLDS), (14.0, OPEN)])
def test_plane_sweep_by_its_time(seconds: float, verdict: str) -> None:
    common = {"set": "uniform", "threads": 1, "points": 1000}
    search = [
        {**common, "search": "cells", "seconds": 1.0},
        {**common, "search": "plane_sweep", "seconds": seconds},
    ]
    assert method.plane_sweep(Planted(bench={"search": search})).verdict == verdict
