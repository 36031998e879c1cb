"""Claims on the rough channel: each verdict follows what is planted."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from ledger_fakes import Planted, WaferRun, WaferTruth, results, together

from verification.case import load_case
from verification.ledger import rough_channel
from verification.ledger.evidence import CORRECTED, FAILS, HOLDS
from verification.ledger.rough_channel import CASE, CURVED, FLAT

BOTH = ("wafer_pressure", "wafer_shear")
SCENES = {variant.name: load_case(CASE).scene(variant) for variant in load_case(CASE).variants}


@pytest.mark.parametrize("good", [True, False])
def test_the_wafers_forces_by_their_checks(good: bool) -> None:
    found = results(CASE, FLAT, dict.fromkeys(BOTH, 0.03), wafer_pressure=True, wafer_shear=good)
    decided = rough_channel.agrees_with_fluent(Planted(results=found))
    assert decided.verdict == (HOLDS if good else FAILS)
    assert "as written 3 % and 3 %" in decided.ours


@pytest.mark.parametrize(
    ("ours", "written", "verdict"), [(0.004, 0.01, HOLDS), (0.004, 0.15, CORRECTED), (0.1, 0.15, FAILS)]
)
def test_the_field_by_both_schemes(ours: float, written: float, verdict: str) -> None:
    found = results(CASE, FLAT, {"pressure": written}, pressure=ours)
    assert rough_channel.whole_field(Planted(results=found)).verdict == verdict


@pytest.mark.parametrize("good", [True, False])
def test_either_wall_by_its_checks(good: bool) -> None:
    names = ("wafer_pressure_of_variants", "wafer_shear_of_variants")
    found = results(CASE, FLAT, dict.fromkeys(names, 0.02), **dict(zip(names, (good, True), strict=True)))
    assert rough_channel.either_wall(Planted(results=found)).verdict == (HOLDS if good else FAILS)


@pytest.mark.parametrize(("factor", "verdict"), [(1.0, FAILS), (1.3, HOLDS)])
def test_reynolds_equation_against_the_reference(factor: float, verdict: str) -> None:
    """A reference that is what Reynolds' equation says, times a factor."""

    def part(index: int) -> Any:
        return lambda x, *time: factor * rough_channel.lubrication(SCENES[FLAT], x)[index]

    truth = {(CASE, FLAT): WaferTruth(part(0), part(1))}
    assert rough_channel.reynolds_fails(Planted(truths=truth)).verdict == verdict


def test_reynolds_equation_carries_what_the_wall_drags() -> None:
    """A gap that hardly changes has Couette's shear, and no pressure."""
    pad = {
        "name": "pad",
        "shape": "cosine",
        "crest": 0.0,
        "wavelength": 1.0,
        "amplitude": 0.0,
        "mean_height": 0.0,
    }
    scene = {
        "walls": [pad, {"name": "wafer", "shape": "line", "velocity": [2.0, 0.0]}],
        "domain": {"upper": [1.0, 0.5]},
        "fluid": {"dynamic_viscosity": 3.0},
    }
    pressure, shear = rough_channel.lubrication(scene, (np.arange(100) + 0.5) / 100)
    assert np.allclose(pressure, 0, atol=1e-6) and np.allclose(shear, 12.0)


@pytest.mark.parametrize(("estimate", "verdict"), [(1e-3, FAILS), (0.2, HOLDS)])
def test_a_mesh_by_what_the_references_say_of_themselves(estimate: float, verdict: str) -> None:
    found = together(results(CASE, CURVED), results("wafer_feature", "arc"))
    found["references"][1]["error_estimate"] = estimate
    assert rough_channel.mesh_is_difficult(Planted(results=found)).verdict == verdict


@pytest.mark.parametrize("good", [True, False])
def test_steady_times_by_their_checks(good: bool) -> None:
    found = together(
        results(CASE, FLAT, kinetic_energy_steady=True), results(CASE, CURVED, kinetic_energy_steady=good)
    )
    assert rough_channel.steady_times(Planted(results=found)).verdict == (HOLDS if good else FAILS)


class Starting(WaferRun):
    """Pressure and energy come to rest with memories of their own; the pressure stands above the pad."""

    def __init__(self, variant: str, pressure_memory: float, energy_memory: float) -> None:
        scene = SCENES[variant]
        length = scene["domain"]["upper"][0]
        drift = 1.0  # m/s, of the wafer as seen from the pad, in both variants
        super().__init__(
            scene,
            lambda x, t: np.cos(2 * np.pi * (x + drift * t) / length) * (1 + np.exp(-t / pressure_memory)),
        )
        self.energy_memory = energy_memory

    def series(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        return self.times, 1 - np.exp(-self.times / self.energy_memory)


@pytest.mark.parametrize(
    ("pressure", "energy", "verdict"), [(1e-5, 1e-5, HOLDS), (1e-5, 5e-6, CORRECTED), (5e-6, 1e-5, FAILS)]
)
def test_the_curved_wall_by_pressure_and_energy(pressure: float, energy: float, verdict: str) -> None:
    runs = {(CASE, FLAT): Starting(FLAT, 5e-6, 5e-6), (CASE, CURVED): Starting(CURVED, pressure, energy)}
    assert rough_channel.curved_is_slower(Planted(runs=runs)).verdict == verdict


def test_what_never_settles_is_never_steady() -> None:
    times = np.arange(5.0)
    assert rough_channel.steady_from(times, np.array([1, 0.005, 0.005, 0.005, 0])) == 1
    assert rough_channel.steady_from(times, np.array([1, 1, 1, 1, 0])) == np.inf


@pytest.mark.parametrize(("layers", "verdict"), [(3, HOLDS), (2, FAILS)])
def test_the_counts_of_particles(layers: int, verdict: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rough_channel, "DUMMY_LAYERS", layers)
    assert rough_channel.particle_counts(Planted()).verdict == verdict
