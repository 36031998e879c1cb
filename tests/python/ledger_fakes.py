"""Evidence that is planted, so that a claim of the ledger can be seen to stand and to fall."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np

from verification.ledger.evidence import Evidence


@dataclass(frozen=True)
class Planted(Evidence):
    """With runs and references by (case, variant)."""

    runs: dict[tuple[str, str], Any] = field(default_factory=dict)
    truths: dict[tuple[str, str], Any] = field(default_factory=dict)

    def run(self, case: str, variant: str) -> Any:
        return self.runs[case, variant]

    def truth(self, case: str, variant: str) -> Any:
        return self.truths[case, variant]

    def own_error(self, case: str) -> str:
        return "reference within 0.1 %"


def results(
    case: str, variant: str = "any", paper: dict[str, float] | None = None, **checks: Any
) -> dict[str, Any]:
    """A results.json of one run of a case and one by the paper's scheme. A check is passed or not, or a value
    that passes.
    """

    def entry(scheme: str, found: dict[str, Any]) -> dict[str, Any]:
        rows = [
            {"quantity": name, "value": 0.01 if isinstance(what, bool) else what, "passed": what is not False}
            for name, what in found.items()
        ]
        common = {"case": case, "variant": variant, "finest": True, "spacing_m": 1e-7}
        return {**common, "scheme": scheme, "checks": rows}

    estimate = {"case": case, "variant": variant, "error_estimate": 1e-3, "seconds": 2.0}
    return {
        "level": "gate",
        "references": [estimate],
        "cases": [entry("wang2014", paper or {}), entry("default", checks)],
    }


def together(*parts: dict[str, Any]) -> dict[str, Any]:
    """Several results.json as one."""
    lists = {key: sum((part[key] for part in parts), []) for key in ("references", "cases")}
    return {"level": "gate", **lists}


Field = Callable[[np.ndarray, float], np.ndarray]


class WaferRun:
    """A run of which the wafer probe, and particles at half height, have p(x, t) in Pa."""

    def __init__(self, scene: dict[str, Any], pressure: Field, samples: int = 200, places: int = 200) -> None:
        self.scene, self.end_time = scene, scene["output"]["end_time"]
        length = scene["domain"]["upper"][0]
        self.times = np.linspace(self.end_time / samples, self.end_time, samples)
        self.x = (np.arange(places) + 0.5) * length / places
        self.pressure = pressure

    def wall_samples(self, probe: str, what: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.times, self.x, np.array([self.pressure(self.x, time) for time in self.times])

    def particles(self, time: float) -> SimpleNamespace:
        position = np.stack([self.x, np.full_like(self.x, 1e-5)], axis=1)
        return SimpleNamespace(time=time, position=position, pressure=self.pressure(self.x, time))


class WaferTruth:
    """A reference with the same, whose wafer shear is `shear`(x)."""

    def __init__(self, pressure: Field, shear: Callable[[np.ndarray], np.ndarray] = np.zeros_like) -> None:
        self._pressure, self._shear = pressure, shear

    def wall_pressure(self, wall: str, x: np.ndarray, t: float) -> np.ndarray:
        return self._pressure(x, t)

    def wall_shear(self, wall: str, x: np.ndarray, t: float) -> np.ndarray:
        return self._shear(x)

    def pressure(self, x: np.ndarray, y: np.ndarray, t: float) -> np.ndarray:
        return self._pressure(x, t)


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
