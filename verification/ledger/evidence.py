"""What the claims are decided by: the results of the repository's commands, and the runs beside them."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import reference
from verification.case import ROOT, Case, Variant, load_case
from verification.measure import Result

BUILD = ROOT.parent / "build"
HOLDS, CORRECTED, FAILS, OPEN = "holds", "holds with a correction", "does not hold", "cannot be decided"
DEFAULT, PAPER_SCHEME = "default", "wang2014"
MICRO = 1e6


class Missing(LookupError):
    """Evidence that has not been made; what() is the command that makes it."""


@dataclass(frozen=True)
class Finding:
    ours: str
    truth: str  # what is independent of the particles
    verdict: str
    why: str
    range: str = ""  # of the rule's band, for which the verdict holds


@dataclass(frozen=True)
class Evidence:
    """The results (see verification/claims.py); members raise Missing."""

    results: dict[str, Any] | None = None
    asperity: dict[str, Any] | None = None
    abrasives: dict[str, Any] | None = None
    ablation: dict[str, Any] = field(default_factory=dict)  # by the name of the case's file
    bench: dict[str, Any] | None = None
    build: Path = BUILD

    @classmethod
    def read(cls, build: Path) -> Evidence:
        files = ("verify/results.json", "verify/asperity.json", "figures/abrasives.json")
        kept = [_json(build / file) for file in files]
        ablation = {path.stem: _json(path) for path in sorted((build / "ablation").glob("*.json"))}
        return cls(*kept, ablation, _json(build / "bench/machine_bench.json"), build)

    def entry(self, case: str, variant: str = "", scheme: str = DEFAULT) -> dict[str, Any]:
        """What results.json has of the run at the finest spacing."""
        for entry in (self.results or {}).get("cases", []):
            wanted = entry["case"] == case and entry["scheme"] == scheme and entry["finest"]
            if wanted and variant in ("", entry["variant"]):
                return entry
        raise Missing(f"`make verify`, case {case}")

    def variants(self, case: str) -> list[str]:
        """Those of the default scheme that were run, none of a case that was not."""
        entries = [e for e in (self.results or {}).get("cases", []) if e["case"] == case and e["finest"]]
        return [entry["variant"] for entry in entries if entry["scheme"] == DEFAULT]

    def check(self, case: str, quantity: str, variant: str = "", scheme: str = DEFAULT) -> dict[str, Any]:
        """The check at the finest spacing, with the spacing as `spacing_m`."""
        entry = self.entry(case, variant, scheme)
        for check in entry["checks"]:
            if check["quantity"] == quantity:
                return check | {"spacing_m": entry["spacing_m"]}
        raise Missing(f"`make verify`, case {case}")

    def run(self, case: str, variant: str) -> Result:
        """The run of the default scheme at the finest spacing."""
        spacing = self.entry(case, variant)["spacing_m"]
        folder = self.build / "verify/runs" / case / DEFAULT / variant / f"{spacing:g}"
        if not (folder / "result.h5").is_file():
            raise Missing(f"`make verify`, case {case}")
        scene = self.scene(case, variant)
        return Result(folder / "result.h5", scene["output"]["end_time"], scene)

    def scene(self, case: str, variant: str) -> dict[str, Any]:
        return load_case(case).scene(_variant(load_case(case), variant))

    def truth(self, case: str, variant: str) -> reference.Reference:
        """The case's reference, for a run that was made; own_error() says how good it is."""
        self.entry(case, variant)
        found = load_case(case)
        chosen = _variant(found, variant)
        cache = self.build / "reference"
        return reference.load(found.reference, found.path(chosen), dict(chosen.set), cache)

    def references(self, case: str) -> list[dict[str, Any]]:
        """What results.json says of a case's references: name, error_estimate, seconds."""
        found = [row for row in (self.results or {}).get("references", []) if row["case"] == case]
        if not found:
            raise Missing(f"`make verify`, case {case}")
        return found

    def own_error(self, case: str) -> str:
        """How far a case's reference is from exact, by its own estimate."""
        return f"reference within {100 * max(row['error_estimate'] for row in self.references(case)):.1g} %"

    def sweep(self, source: str, of: str) -> dict[str, Any]:
        found = (self.asperity or {}).get(source, {}).get(of, {})
        if "points" not in found and "exponential" not in found:
            raise Missing("`make verify LEVEL=paper`, then `python -m verification.asperity`")
        return found

    def change(self, case: str, name: str) -> dict[str, Any]:
        """A row of `make ablation`: the errors of a case with one key of the scheme changed."""
        rows = [found["rows"] for stem, found in self.ablation.items() if stem.startswith(case)]
        for row in sum(rows, []):
            if row["name"] == name:
                return row
        raise Missing("`make ablation`")

    def searches(self) -> list[dict[str, Any]]:
        """Times of the neighbour searches."""
        if not (self.bench or {}).get("search"):
            raise Missing("`make bench`")
        return (self.bench or {})["search"]

    def ensemble(self) -> dict[str, Any]:
        if self.abrasives is None or "bands" not in self.abrasives:  # or of an older make figures
            raise Missing("`make figures`")
        return self.abrasives["result"]

    def bands(self) -> list[dict[str, Any]]:
        """The ensemble by every band outside of the abrasive-free run's noise."""
        self.ensemble()
        return [row for row in (self.abrasives or {})["bands"] if not row["within_noise"]]


@dataclass(frozen=True)
class Claim:
    section: str
    text: str
    decide: Callable[[Evidence], Finding]


def _json(path: Path) -> dict[str, Any] | None:
    return json.loads(path.read_text()) if path.exists() else None


def _variant(case: Case, name: str) -> Variant:
    return next(variant for variant in case.variants if variant.name == name)


def percent(check: dict[str, Any]) -> str:
    value = check["value"]
    return "no number" if value is None else f"{100 * value:.2g} %"


def by_checks(checks: Sequence[dict[str, Any]], ours: str, truth: str, why: str) -> Finding:
    """A claim that stands or falls with checks."""
    return Finding(ours, truth, HOLDS if all(check["passed"] for check in checks) else FAILS, why)


def undecided(ours: str, truth: str, why: str) -> Callable[[Evidence], Finding]:
    """A claim on which no run of ours says anything."""
    return lambda evidence: Finding(ours, truth, OPEN, why)


def within(value: float, interval: Sequence[float]) -> bool:
    return min(interval) <= value <= max(interval)
