"""The regression gate: every check's last accepted error, beside the truth and never shown as verification.

A run fails when an error has grown by more than 10 % over its accepted value, even inside its tolerance.
Growth of less than 2 % of the tolerance is not held against it: an error close to zero may double on another
compiler. On another processor than the baseline's the last bits differ, the particles take other paths, and
instantaneous errors scatter: there the limit is 50 %. A value of a complete run that has gone missing fails
too. `python -m verification.baseline --accept` accepts the last results; the commit of baseline.json is where
a person reviews them.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent
PATH = ROOT / "baseline.json"
LARGEST_GROWTH = 0.10
LARGEST_GROWTH_ELSEWHERE = 0.50  # a small change at one periodic side moved an instantaneous error by 22 %
FLOOR = 0.02  # of the tolerance

Baseline = dict[str, Any]  # level -> case/scheme/variant/spacing/quantity -> error; "processor" -> its name


def load(path: Path = PATH) -> Baseline:
    return json.loads(path.read_text()) if path.exists() else {}


def values(results: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Every check of the results with its key, but those that are only reported."""
    for case in results["cases"]:
        for check in [check for check in case["checks"] if not check.get("reported")]:
            names = (
                case["case"],
                case["scheme"],
                case["variant"],
                f"{case['spacing_m']:g}",
                check["quantity"],
            )
            yield "/".join(names), check


def processor(results: dict[str, Any]) -> str | None:
    return results.get("machine", {}).get("processor")


def compare(results: dict[str, Any], baseline: Baseline) -> list[dict[str, Any]]:
    """One row for each check: status "regression", "missing", "improved", "unchanged" or "new"."""
    accepted = dict(baseline.get(results["level"], {}))
    here = baseline.get("processor") == processor(results)
    growth = LARGEST_GROWTH if here else LARGEST_GROWTH_ELSEWHERE
    rows = []
    for key, check in values(results):
        old, new = accepted.pop(key, None), check["value"]
        floor = FLOOR * check["tolerance_at_finest"]
        if old is None:
            status = "new"
        elif new is None:
            status = "missing"
        elif new > (1 + growth) * old and new - old > floor:
            status = "regression"
        elif new < old / (1 + growth) and old - new > floor:
            status = "improved"
        else:
            status = "unchanged"
        rows.append(
            {"key": key, "accepted": old, "value": new, "status": status, "unit": check.get("unit", "")}
        )
    if results["complete"]:
        rows += [
            {"key": key, "accepted": old, "value": None, "status": "missing", "unit": ""}
            for key, old in accepted.items()
        ]
    return rows


def failures(results: dict[str, Any]) -> list[dict[str, Any]]:
    return [row for row in results.get("baseline", []) if row["status"] in ("regression", "missing")]


def lines(results: dict[str, Any]) -> list[str]:
    """What a person wants to know of the comparison, one line each."""
    text = []
    for row in results.get("baseline", []):
        if row["status"] == "missing":
            text.append(f"REGRESSION: {row['key']}: accepted at {row['accepted']:.3g}, now without a value")
        elif row["status"] in ("regression", "improved"):
            text.append(f"{row['status'].upper()}: {row['key']}: {change(row)}")
    new = sum(row["status"] == "new" for row in results.get("baseline", []))
    return text + ([f"{new} values are not in the baseline yet (make baseline accepts them)"] if new else [])


def change(row: dict[str, Any]) -> str:
    relative = 100 * (row["value"] / row["accepted"] - 1) if row["accepted"] else float("inf")
    return f"{row['accepted']:.3g} -> {row['value']:.3g} ({relative:+.0f} %)"


def accept(results: dict[str, Any], baseline: Baseline) -> Baseline:
    """The baseline with these values: a complete run replaces its level, a partial one adds to it."""
    bad = [key for key, check in values(results) if not check["passed"] and not check["known_shortfall"]]
    if bad:
        raise ValueError(f"{len(bad)} checks fail, first {bad[0]}: only a run that passes can be accepted")
    level = {} if results["complete"] else dict(baseline.get(results["level"], {}))
    level |= {key: float(f"{check['value']:.4g}") for key, check in values(results)}
    name = processor(results)
    return baseline | ({"processor": name} if name else {}) | {results["level"]: dict(sorted(level.items()))}


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.baseline", description=__doc__.splitlines()[0]
    )
    parser.add_argument(
        "--accept", action="store_true", help="write the values of the last run to the baseline"
    )
    parser.add_argument("--results", type=Path, default=ROOT.parent / "build" / "verify" / "results.json")
    parser.add_argument("--baseline", type=Path, default=PATH)
    options = parser.parse_args(argv)
    try:
        results, before = json.loads(options.results.read_text()), load(options.baseline)
        results["baseline"] = compare(results, before)
        print("\n".join(lines(results)) or "nothing has changed")
        if options.accept:
            after = accept(results, before)
            options.baseline.write_text(json.dumps(after, indent=1, allow_nan=False, sort_keys=True) + "\n")
    except (OSError, ValueError) as error:
        print(f"baseline: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
