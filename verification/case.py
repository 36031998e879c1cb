"""Cases as data: reads verification/<case>/scene.toml and checks.toml.

A value in checks.toml that differs by scheme, level or variant is a table keyed by their names, any nesting:
`tolerance = { default = { gate = 0.004, paper = 0.002 }, wang2014 = 0.005 }`.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reference.scene import override
from verification.compare import KINDS, METRICS, Check

ROOT = Path(__file__).resolve().parent
SCHEMES = ("default", "wang2014")
LEVELS = ("gate", "paper")
CHECK_KEYS = {
    "quantity", "at", "field", "metric", "tolerance", "kind", "why", "order_band", "order_floor",
    "subtract_mean", "times", "from", "against", "variants", "known_shortfall",
}  # fmt: skip


class CaseError(ValueError):
    """A case that cannot be run as written: one line that names the file and what is wrong."""


@dataclass(frozen=True)
class Variant:
    name: str
    set: Mapping[str, Any]  # overrides of the scene, as for --set


@dataclass(frozen=True)
class Case:
    name: str
    scene_path: Path
    reference: str
    figures: tuple[str, ...]
    variants: tuple[Variant, ...]
    data: Mapping[str, Any]  # checks.toml as read

    def spacings(self, scheme: str, level: str) -> list[float]:
        values = select(self.data["spacings"], (scheme, level))
        if not values or len(values) < 3 or sorted(set(values), reverse=True) != values:
            raise CaseError(f"{self.name}: needs three spacings or more, from coarse to fine, not {values}")
        return [float(value) for value in values]

    def scene(self, variant: Variant | None = None) -> dict[str, Any]:
        """The scene with the variant's overrides, defaults not filled in."""
        scene = tomllib.loads(self.scene_path.read_text())
        for address, value in (variant.set if variant else {}).items():
            override(scene, address, value, self.scene_path)
        return scene

    def checks(self, scheme: str, level: str, variant: str) -> list[Check]:
        entries = [e for e in self.data["checks"] if variant in e.get("variants", [variant])]
        return [check for entry in entries for check in _checks(entry, (scheme, level, variant), self.name)]


def select(value: Any, keys: Iterable[str]) -> Any:
    """The entry for these keys of a table nested in any order; None where a table has no entry for them."""
    while isinstance(value, Mapping):
        value = next((value[key] for key in keys if key in value), None)
    return value


def load_case(name: str, root: Path = ROOT) -> Case:
    """Reads and checks one case; raises CaseError."""
    path = root / name / "checks.toml"
    try:
        data = tomllib.loads(path.read_text())
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise CaseError(f"{name}: {error}") from error
    missing = {"reference", "spacings", "variants", "checks"} - data.keys()
    if missing:
        raise CaseError(f"{path.name} of {name}: missing {', '.join(sorted(missing))}")
    variants = tuple(Variant(v["name"], v.get("set", {})) for v in data["variants"])
    figures = tuple(data.get("figures", ()))
    case = Case(name, root / name / "scene.toml", data["reference"], figures, variants, data)
    for scheme in SCHEMES:
        for level in LEVELS:
            case.spacings(scheme, level)
            for variant in variants:
                case.checks(scheme, level, variant.name)
    return case


def load_cases(root: Path = ROOT) -> list[Case]:
    return [load_case(path.parent.name, root) for path in sorted(root.glob("*/checks.toml"))]


def _checks(entry: Mapping[str, Any], keys: tuple[str, str, str], case: str) -> list[Check]:
    where = f"checks.toml of {case}, {entry.get('quantity', 'a check without quantity')}"
    unknown = entry.keys() - CHECK_KEYS
    missing = {"quantity", "at", "field", "metric", "tolerance", "kind", "why"} - entry.keys()
    if unknown or missing:
        raise CaseError(f"{where}: unknown {sorted(unknown)}, missing {sorted(missing)}")
    if entry["metric"] not in METRICS or entry["kind"] not in KINDS:
        raise CaseError(f"{where}: metric {entry['metric']} or kind {entry['kind']} is unknown")
    tolerance = select(entry["tolerance"], keys)
    if not isinstance(tolerance, (int, float)) or not 0 < tolerance < float("inf"):
        raise CaseError(f"{where}: no tolerance for {', '.join(keys)}")
    band = select(entry.get("order_band"), keys)
    times = entry.get("times", [None])
    return [
        Check(
            quantity=entry["quantity"] if len(times) == 1 else f"{entry['quantity']} at {time:g} s",
            at=entry["at"],
            field=entry["field"],
            metric=entry["metric"],
            tolerance=float(tolerance),
            kind=entry["kind"],
            why=entry["why"],
            order_band=(float(band[0]), float(band[1])) if band else None,
            order_floor=float(entry.get("order_floor", 0.0)),
            subtract_mean=entry.get("subtract_mean", False),
            time=time,
            from_time=select(entry.get("from"), keys),
            against=entry.get("against"),
            known_shortfall=select(entry.get("known_shortfall"), keys),
        )
        for time in times
    ]


def toml_value(value: Any) -> str:
    """A value as it is written in TOML, for --set."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    return repr(value)
