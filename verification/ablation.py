"""Errors of the default scheme with one key changed at a time: the table of verification/accuracy.md.

`python -m verification.ablation` runs the changes of verification/bench/plan.toml and of
verification/ablation.toml on the cases of the latter. It keeps each case's errors in the output folder once
it is through, and writes the table between the markers of accuracy.md; `--table-only` writes it again from
what is kept. Errors are those that `make verify` checks; wall times are left to `make bench`, which wants the
machine for itself. Particles' paths are chaotic, so that one run's error is partly chance: each change is run
from several starts that hardly differ (`start.seed`), and only what is beyond chance is marked. Exit status:
0; 1 when a run failed or a case is missing; 2 when it cannot start.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from verification.bench import ablation
from verification.bench.plan import load_plan
from verification.bench.session import Session
from verification.case import ROOT, CaseError
from verification.markers import replace_between
from verification.results import commit
from verification.run import REPOSITORY, References

PLAN = Path(__file__).with_suffix(".toml")
PAGE = ROOT / "accuracy.md"

Rows = Sequence[Mapping[str, Any]]


def plan_of(additions: Mapping[str, Any]) -> dict[str, Any]:
    """The bench's plan with the additional changes; every run once, for its errors."""
    plan = load_plan(quick=False)
    plan |= {"repetitions": 1}
    plan["ablation"]["variants"] = [*plan["ablation"]["variants"], *additions["variants"]]
    return plan


def file_of(folder: Path, case: Mapping[str, Any]) -> Path:
    return folder / f"{case['case']}_{case['variant']}_{case['spacing']:g}.json"


def columns(rows: Rows) -> list[str]:
    """The quantities of a case; of one that is checked at several times only the worst is shown."""
    return list(dict.fromkeys(quantity.split(" at ")[0] for quantity in rows[0]["members"][0]["errors"]))


def worst(errors: Mapping[str, float], quantity: str) -> float:
    return max(error for name, error in errors.items() if name.split(" at ")[0] == quantity)


def mean_and_chance(row: Mapping[str, Any], quantity: str) -> tuple[float, float]:
    """Of the runs' errors; chance is the standard error of the mean, 0 for one run."""
    errors = [worst(member["errors"], quantity) for member in row["members"] if not member["failure"]]
    chance = statistics.stdev(errors) / len(errors) ** 0.5 if len(errors) > 1 else 0.0
    return statistics.mean(errors), chance


def cell(row: Mapping[str, Any] | None, base: Mapping[str, Any], quantity: str) -> str:
    """A mean error in percent, bold where it is at most 0.9 of the default's, italic from 1.1 of it on, if
    the difference is beyond twice what chance makes of it.
    """
    if row is None:
        return ""
    if stopped := sum(bool(member["failure"]) for member in row["members"]):
        return "stops" if stopped == len(row["members"]) else f"{stopped} of {len(row['members'])} stop"
    (error, chance), (usual, usual_chance) = mean_and_chance(row, quantity), mean_and_chance(base, quantity)
    text = f"{100 * error:.2g}" + (f" ± {100 * chance:.1g}" if chance else "")
    if abs(error - usual) <= 2 * (chance**2 + usual_chance**2) ** 0.5:
        return text
    return f"**{text}**" if error <= 0.9 * usual else f"*{text}*" if error >= 1.1 * usual else text


def table(cases: Sequence[tuple[Mapping[str, Any], Rows]]) -> str:
    """A row for each change, a column for each quantity of each case; errors in percent."""
    heads, changes = [], dict.fromkeys(row["name"] for _, rows in cases for row in rows)
    for case, rows in cases:
        heads += [f"{case['case']}, {case['spacing']:g} m: {name}" for name in columns(rows)]
    lines = ["| change | " + " | ".join(heads).replace("_", " ") + " |", "|---" * (len(heads) + 1) + "|"]
    for change in changes:
        cells = []
        for _, rows in cases:
            row = next((row for row in rows if row["name"] == change), None)
            cells += [cell(row, rows[0], name) for name in columns(rows)]
        lines.append(f"| {change} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def measure(session: Session, cases: Sequence[Mapping[str, Any]], folder: Path) -> None:
    for entry in cases:
        case = dict(entry)
        starts = range(1, case.pop("members", 1) + 1)
        common = case.pop("settings", {})
        session.plan["ablation"]["cases"] = [
            {**case, "settings": {**common, "start.seed": seed}} for seed in starts
        ]
        members: dict[str, list[dict[str, Any]]] = {}
        for row in ablation.measure(session):
            members.setdefault(row["name"], []).append({key: row[key] for key in ("errors", "failure")})
        rows = [{"name": name, "members": found} for name, found in members.items()]
        stored = {"commit": commit(), "rows": rows}
        file_of(folder, case).write_text(json.dumps(stored, indent=1) + "\n")


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m verification.ablation", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--solver", type=Path, default=REPOSITORY / "build" / "slurry")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "ablation")
    parser.add_argument("--page", type=Path, default=PAGE, help="with the markers of the table")
    parser.add_argument("--table-only", action="store_true", help="from the errors that are kept")
    return parser.parse_args(argv)


def main(argv: Sequence[str] | None = None) -> int:
    options = parse(argv)
    additions = tomllib.loads(PLAN.read_text())
    failures: list[str] = []
    try:
        if not options.table_only:
            session = Session(options.solver, options.out, plan_of(additions), References())
            options.out.mkdir(parents=True, exist_ok=True)
            measure(session, additions["cases"], options.out)
            failures = session.failures
        found = []
        for case in additions["cases"]:
            if (stored := file_of(options.out, case)).exists():
                found.append((case, json.loads(stored.read_text())["rows"]))
            else:
                failures.append(f"no errors are kept for {case['case']} at {case['spacing']:g} m")
        if found:
            replace_between(options.page, "ablation", table(found))
    except (CaseError, OSError, ValueError) as error:
        print(f"ablation: {error}", file=sys.stderr)
        return 2
    for failure in failures:
        print(f"FAILED: {failure}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
