"""Cases as data: reads verification/<case>/scene.toml and checks.toml.

A value in checks.toml that differs by scheme, level or variant is a table keyed by their names, any nesting:
`tolerance = { default = { gate = 0.004, paper = 0.002 }, wang2014 = 0.005 }`. An empty list of spacings says
that a variant is not run at that level.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reference.scene import override
from verification.compare import EVERY, KINDS, METRICS, Check, Curves

ROOT = Path(__file__).resolve().parent
HARD = "stability"  # the folder of the hard cases
SCHEMES = ("default", "wang2014")
LEVELS = ("gate", "paper")
CHECK_KEYS = {
    "quantity", "at", "field", "metric", "tolerance", "kind", "why", "order_band", "order_floor",
    "subtract_mean", "times", "from", "against", "variants", "known_shortfall", "reference", "value",
    "source", "data", "conserved", "window", "statistic", "unit", "scale", "reported", "repeats",
}  # fmt: skip
TRUTHS = ("data", "against", "value", "conserved", "from", "repeats")  # else the reference
STATISTICS = ("min", "max", "mean", "deviation", "peak")


class CaseError(ValueError):
    """A case that cannot be run as written: one line that names the file and what is wrong."""


@dataclass(frozen=True)
class Variant:
    name: str
    set: Mapping[str, Any]  # overrides of the scene, as for --set
    scene: str = "scene.toml"  # its file, for what overrides cannot say


@dataclass(frozen=True)
class Case:
    name: str
    scene_path: Path
    reference: str  # of the checks that name no other; "" for none
    figures: tuple[str, ...]
    variants: tuple[Variant, ...]
    data: Mapping[str, Any]  # checks.toml as read

    @property
    def schemes(self) -> tuple[str, ...]:
        return tuple(self.data.get("schemes", SCHEMES))

    def spacings(self, scheme: str, level: str, variant: str = "") -> list[float]:
        values = select(self.data["spacings"], (scheme, level, variant))
        if values is None or sorted(set(values), reverse=True) != values:
            raise CaseError(f"{self.name}: needs spacings from coarse to fine, not {values}")
        if 0 < len(values) < 3 and any(c.order_band for c in self.checks(scheme, level, variant)):
            raise CaseError(f"{self.name}: an order_band needs three spacings or more, not {values}")
        return [float(value) for value in values]

    def references(self, variant: str) -> list[str]:
        """Names of all references that the checks of a variant need."""
        checks = (
            c for scheme in self.schemes for level in LEVELS for c in self.checks(scheme, level, variant)
        )
        return sorted({check.reference for check in checks if check.reference})

    def path(self, variant: Variant) -> Path:
        """The variant's scene file."""
        return self.scene_path.with_name(variant.scene)

    def scene(self, variant: Variant | None = None) -> dict[str, Any]:
        """The scene with the variant's overrides, defaults not filled in."""
        path = self.path(variant) if variant else self.scene_path
        scene = tomllib.loads(path.read_text())
        for address, value in (variant.set if variant else {}).items():
            override(scene, address, value, path)
        return scene

    def checks(self, scheme: str, level: str, variant: str) -> list[Check]:
        entries = [e for e in self.data["checks"] if variant in e.get("variants", [variant])]
        keys = (scheme, level, variant)
        return [check for entry in entries for check in _checks(entry, keys, self.name, self.reference)]


def select(value: Any, keys: Iterable[str]) -> Any:
    """The entry for these keys of a table nested in any order; None where a table has no entry for them."""
    while isinstance(value, Mapping):
        value = next((value[key] for key in keys if key in value), None)
    return value


def load_case(name: str, root: Path = ROOT) -> Case:
    """Reads and checks one case; raises CaseError."""
    folder = root / name if (root / name).is_dir() else root / HARD / name
    path = folder / "checks.toml"
    try:
        data = tomllib.loads(path.read_text())
        if "include" in data:  # checks that cases share
            data["checks"] = tomllib.loads((folder / data["include"]).read_text())["checks"] + data["checks"]
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise CaseError(f"{name}: {error}") from error
    missing = {"spacings", "variants", "checks"} - data.keys()
    if missing:
        raise CaseError(f"{path.name} of {name}: missing {', '.join(sorted(missing))}")
    variants = tuple(
        Variant(v["name"], v.get("set", {}), v.get("scene", "scene.toml")) for v in data["variants"]
    )
    figures = tuple(data.get("figures", ()))
    scene_path = (folder / data.get("scene", "scene.toml")).resolve()
    case = Case(name, scene_path, data.get("reference", ""), figures, variants, data)
    if unknown := set(case.schemes) - set(SCHEMES):
        raise CaseError(f"{path.name} of {name}: no scheme is called {', '.join(sorted(unknown))}")
    for scheme in case.schemes:
        for level in LEVELS:
            for variant in variants:
                case.spacings(scheme, level, variant.name)
                case.checks(scheme, level, variant.name)
    return case


def load_cases(root: Path = ROOT) -> list[Case]:
    folders = (path.parent for top in (root, root / HARD) for path in sorted(top.glob("*/checks.toml")))
    return [load_case(folder.name, root) for folder in folders]


def _checks(
    entry: Mapping[str, Any], keys: tuple[str, str, str], case: str, reference: str
) -> Iterator[Check]:
    """One check for each of the entry's times."""
    where = f"checks.toml of {case}, {entry.get('quantity', 'a check without quantity')}"
    _require_sense(entry, reference, where)
    tolerance = select(entry["tolerance"], keys)
    if not isinstance(tolerance, (int, float)) or not 0 < tolerance < float("inf"):
        raise CaseError(f"{where}: no tolerance for {', '.join(keys)}")
    chosen = {key: select(entry.get(key), keys) for key in ("order_band", "value", "window", "scale", "from")}
    value, window, band = chosen["value"], chosen["window"], chosen["order_band"]
    if "value" in entry and value is None:
        raise CaseError(f"{where}: no value for {', '.join(keys)}")
    times = entry.get("times", [None])
    for time in times:
        yield Check(
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
            from_time=chosen["from"],
            against=entry.get("against"),
            known_shortfall=select(entry.get("known_shortfall"), keys),
            reference="" if set(TRUTHS) & entry.keys() else entry.get("reference", reference),
            value=tuple(map(float, value if isinstance(value, list) else [value]))
            if "value" in entry
            else (),
            source=entry.get("source", ""),
            data=curves(entry["data"], where) if "data" in entry else None,
            conserved=entry.get("conserved", False),
            repeats=entry.get("repeats"),
            window=(float(window[0]), float(window[1])) if window else None,
            statistic=entry.get("statistic"),
            unit=entry.get("unit", ""),
            stated_scale=chosen["scale"],
            reported=bool(select(entry.get("reported"), keys)),
        )


def _require_sense(entry: Mapping[str, Any], reference: str, where: str) -> None:
    """Refuses keys that are unknown, missing or cannot go together."""
    unknown = entry.keys() - CHECK_KEYS
    missing = {"quantity", "at", "field", "metric", "tolerance", "kind", "why"} - entry.keys()
    if unknown or missing:
        raise CaseError(f"{where}: unknown {sorted(unknown)}, missing {sorted(missing)}")
    if entry["metric"] not in METRICS or entry["kind"] not in KINDS:
        raise CaseError(f"{where}: metric {entry['metric']} or kind {entry['kind']} is unknown")
    truths = sorted(set(TRUTHS) & entry.keys())
    ensemble = entry.get("against") == EVERY
    if ensemble != (truths == ["against", "data"]) or (len(truths) > 1 and not ensemble):
        raise CaseError(
            f"{where}: held against {', '.join(truths)}; one of them is wanted, or data and every variant"
        )
    if not (truths or entry.get("reference", reference)):
        raise CaseError(
            f"{where}: there is nothing to hold it against: no reference and none of {', '.join(TRUTHS)}"
        )
    if (entry["metric"] == "largest_difference") != (("unit" in entry) != ("scale" in entry)):
        raise CaseError(f"{where}: largest_difference, and no other metric, needs a unit or a scale")
    if "statistic" in entry and ("data" in entry or entry["statistic"] not in STATISTICS):
        raise CaseError(f"{where}: a statistic is {' or '.join(STATISTICS)}, and not of published curves")
    if ("value" in entry) != ("source" in entry):
        raise CaseError(f"{where}: a value and its source go together")


def curves(entry: Mapping[str, Any], where: str) -> Curves:
    try:
        columns = tuple(entry["columns"])
        return Curves(**{"time": "t_s", **entry, "columns": columns})
    except (KeyError, TypeError) as error:
        raise CaseError(
            f"{where}: data needs file and columns, may have time, offset and factor: {error}"
        ) from error


def toml_value(value: Any) -> str:
    """A value as it is written in TOML, for --set."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    return repr(value)
