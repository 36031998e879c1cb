"""Runs every case, compares, and says whether the solver can be believed.

`python -m verification.run --level gate` writes results.json, report.md and report.html into the output
folder. The exit status is the verdict: 0 passed, 1 failed; 2 when it cannot start.
"""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import datetime
import json
import math
import os
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from reference import Reference
from reference import load as load_reference
from verification import baseline
from verification.case import LEVELS, ROOT, SCHEMES, Case, CaseError, Variant, load_cases
from verification.compare import EVERY, Check, CheckResult, DataError, observed_order
from verification.execute import Outcome, execute, plan
from verification.progress import Progress
from verification.results import commit, entry, machine, standing, summary
from verification.truth import error_of

REPOSITORY = ROOT.parent
LoadReference = Callable[[str, Path, dict[str, object], Path], Reference]


def judge(outcomes: Sequence[Outcome], references: References, level: str) -> list[list[CheckResult]]:
    """Check results for each outcome, in its order; a variant's finest spacing gets the observed order."""
    by_run = {(o.run.case.name, o.run.scheme, o.run.variant.name, o.run.spacing): o for o in outcomes}
    judged: list[list[CheckResult]] = []
    history: dict[tuple[str, ...], list[tuple[float, float]]] = {}
    for outcome in outcomes:
        run, results = outcome.run, []
        for check in run.case.checks(run.scheme, level, run.variant.name):
            key = (run.case.name, run.scheme, run.variant.name, check.quantity)
            every = [variant.name for variant in run.case.variants]
            wanted = every if check.against == EVERY else [check.against] if check.against else []
            others = {name: by_run.get((run.case.name, run.scheme, name, run.spacing)) for name in wanted}
            result = _check(check, outcome, others, references)
            points = history.setdefault(key, [])
            points.append((run.spacing, result.value))
            if run.finest:
                if check.kind in ("exact", "finite-element"):
                    result.order = observed_order(*zip(*points, strict=True))
                converged = all(value <= check.order_floor for _, value in points)  # False for NaN
                if converged or len(points) < 3:  # --spacings: too few for an order
                    result.check = dataclasses.replace(check, order_band=None)
            results.append(result)
        judged.append(results)
    return judged


def _check(
    check: Check, outcome: Outcome, others: dict[str, Outcome | None], references: References
) -> CheckResult:
    run = outcome.run
    result = CheckResult(check, math.nan, check.tolerance if run.finest else None, source=described(check))
    try:
        if outcome.failure:
            raise DataError(outcome.failure)
        for name, other in others.items():
            if other is None or other.failure:
                raise DataError(f"no run of {name}: {other.failure if other else 'not asked for'}")
        reference = references.of(run.case, run.variant, check.reference) if check.reference else None
        if reference is not None:
            result.source = reference.source
        result.value = error_of(check, outcome.result, reference, [o.result for o in others.values() if o])
    except DataError as error:
        result.reason = str(error)
    except Exception as error:  # whatever a reference raises fails its checks and must not stop the rest
        result.reason = f"{type(error).__name__}: {error}"
    return result


def described(check: Check) -> str:
    """What a check without a reference is held against."""
    if check.data is not None:
        columns = f"{', '.join(check.data.columns)} of data/{check.data.file}"
        return columns + (" against the band of all variants" if check.against == EVERY else "")
    if check.against:
        return f"the run of {check.against}"
    if check.conserved:
        return "the step before"
    if check.repeats:
        return f"its own values {check.repeats:g} s before"
    return check.source if check.value else "its own final value"


class References:
    """The references of each case and variant, made once; an error is raised again for every check."""

    def __init__(self, load: LoadReference = load_reference) -> None:
        self._load = load
        self._made: dict[tuple[str, str, str], Reference | Exception] = {}

    def of(self, case: Case, variant: Variant, name: str = "") -> Reference:
        """The case's reference, or the one of that name."""
        key = (case.name, variant.name, name or case.reference)
        if key not in self._made:
            try:
                cache = REPOSITORY / "build" / "reference"
                self._made[key] = self._load(key[2], case.path(variant), dict(variant.set), cache)
            except Exception as error:
                self._made[key] = error
        made = self._made[key]
        if isinstance(made, Exception):
            raise made
        return made

    def prepare(self, wanted: Sequence[tuple[Case, Variant]]) -> None:
        """Makes the references before the runs: nothing slow may come after the last line of progress."""
        for case, variant in wanted:
            for name in case.references(variant.name):
                if (case.name, variant.name, name) not in self._made:
                    print(f"reference: {case.name} {variant.name} {name}", file=sys.stderr, flush=True)
                    with contextlib.suppress(Exception):  # of() raises it again for the checks
                        self.of(case, variant, name)

    def facts(self) -> list[dict[str, Any]]:
        """What results.json says of every reference that was used."""
        keys = ("source", "kind", "error_estimate", "seconds", "digest")
        return [
            {"case": case, "variant": variant, "name": name} | {key: getattr(made, key) for key in keys}
            for (case, variant, name), made in self._made.items()
            if not isinstance(made, Exception)
        ]


def print_verdict(results: dict[str, Any]) -> None:
    marks = {"failed": "FAILED", "known": "KNOWN SHORTFALL", "reported": "REPORTED, NOT WITHIN"}
    for style, mark in marks.items():
        for case in results["cases"]:
            for check in case["checks"]:
                if not check["passed"] and standing(check) == style:
                    name = f"{case['case']} {case['scheme']} {case['variant']} {case['spacing_m']:g} m"
                    note = f" ({check['note']})" if style == "known" else ""
                    print(f"{mark}: {name}: {check['quantity']}: {check['reason']}{note}")
    for line in baseline.lines(results):
        print(line)
    print("{} passed, {} failed".format(*summary(results)))


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m verification.run", description=__doc__.splitlines()[0])
    parser.add_argument("--level", choices=LEVELS, default="gate")
    parser.add_argument("--case", action="append", help="only this case (repeatable)")
    parser.add_argument("--scheme", action="append", choices=SCHEMES, help="only this scheme (repeatable)")
    parser.add_argument("--variant", help="only this variant")
    parser.add_argument(
        "--spacings", nargs="+", type=float, metavar="M", help="the finest carries the tolerance"
    )
    parser.add_argument("--solver", type=Path, default=REPOSITORY / "build" / "slurry")
    parser.add_argument(
        "--solver-set", action="append", default=[], metavar="KEY=VALUE", help="for the solver alone"
    )
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "verify")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument(
        "--timeout", type=float, default=3600, metavar="S", help="for one run (%(default)s s)"
    )
    parser.add_argument(
        "--reuse", action="store_true", help="keep a result of the same solver, scene and settings"
    )
    parser.add_argument("--no-baseline", action="store_true")
    parser.add_argument("--no-report", action="store_true")
    return parser.parse_args(argv)


def main(argv: Sequence[str] | None = None, load: LoadReference = load_reference) -> int:
    options = parse(argv)
    results_path = options.out / "results.json"
    try:
        cases = [case for case in load_cases() if not options.case or case.name in options.case]
        if unknown := set(options.case or []) - {case.name for case in cases}:
            raise CaseError(f"no case is called {', '.join(sorted(unknown))}")
        if not os.access(options.solver, os.X_OK):
            raise CaseError(f"{options.solver} is not there or not executable: run `make build` first")
        results_path.unlink(missing_ok=True)  # an interrupted run leaves no verdict
        runs = plan(cases, options)
    except (CaseError, OSError) as error:
        print(f"verification: {error}", file=sys.stderr)
        return 2
    references = References(load)
    outcomes = []
    references.prepare([(run.case, run.variant) for run in runs])
    progress = Progress(sum(run.expected_work() for run in runs), len(runs))
    for run in runs:
        progress.begin(run.label)
        started = time.monotonic()
        outcomes.append(execute(run, options))
        progress.end(f"{run.label}: {time.monotonic() - started:.1f} s", run.expected_work())
    results: dict[str, Any] = {
        "commit": commit(),
        "level": options.level,
        "generated": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "complete": not (
            options.case or options.scheme or options.variant or options.spacings or options.solver_set
        ),
        "machine": machine(),
        "cases": [
            entry(*pair) for pair in zip(outcomes, judge(outcomes, references, options.level), strict=True)
        ],
    }
    results["references"] = references.facts()
    if not options.no_baseline:
        results["baseline"] = baseline.compare(results, baseline.load())
    passed, failed = summary(results)
    results["passed"] = passed > 0 and failed == 0
    results_path.parent.mkdir(parents=True, exist_ok=True)
    results_path.write_text(json.dumps(results, indent=1, allow_nan=False) + "\n")
    if not options.no_report:
        from verification import report  # matplotlib is slow to import and not needed for faults

        report.write(options.out, references)
    print_verdict(results)
    return 0 if results["passed"] else 1


if __name__ == "__main__":
    sys.exit(main())
