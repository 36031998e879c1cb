"""Measures speed against error and holds the speed against its targets.

`python -m verification.bench` writes speed_error.json, figures, report.md and report.html into the output
folder. Nothing else may run meanwhile. Exit status: 0, whether or not targets are met; 1 when a run failed or
an error depends on the threads; 2 when it cannot start.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from reference import load as load_reference
from verification.bench import ablation, machine_bench, report, scaling, speed_error, target_runs
from verification.bench.plan import load_plan
from verification.bench.session import Session, parser
from verification.case import CaseError
from verification.results import commit, machine
from verification.run import LoadReference, References

SECTIONS: dict[str, Callable[[Session], Any]] = {
    "machine_bench": machine_bench.measure,
    "speed_error": speed_error.measure,
    "ablation": ablation.measure,
    "scaling": scaling.measure,
    "target_runs": target_runs.measure,
}


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    options = parser("python -m verification.bench", __doc__)
    options.add_argument("--only", action="append", choices=SECTIONS, help="only this section (repeatable)")
    options.add_argument("--page", type=Path, help="a page with the markers of targets and points to fill")
    options.add_argument("--report-only", action="store_true", help="the report again, from the last results")
    return options.parse_args(argv)


def main(argv: Sequence[str] | None = None, load: LoadReference = load_reference) -> int:
    options = parse(argv)
    stored = options.out / report.RESULTS
    try:
        if options.report_only:
            return finish(options, json.loads(stored.read_text()))
        session = Session(options.solver, options.out, load_plan(options.quick), References(load))
        stored.unlink(missing_ok=True)  # an interrupted bench leaves none
    except (CaseError, OSError, json.JSONDecodeError) as error:
        print(f"bench: {error}", file=sys.stderr)
        return 2
    return finish(options, measure(session, options))


def finish(options: argparse.Namespace, results: dict[str, Any]) -> int:
    report.write(options.out, results)
    if options.page:
        report.write_page(options.page, results)
    report.print_targets(results)
    for failure in results["failures"]:
        print(f"FAILED: {failure}")
    print(options.out / "report.html")
    return 1 if results["failures"] else 0


def measure(session: Session, options: argparse.Namespace) -> dict[str, Any]:
    """Every section asked for; one that cannot be measured is a failure, and the others go on."""
    load_average = os.getloadavg()[0]
    if load_average > 0.5:
        session.note(f"the load average was {load_average:.1f} at the start: other work slows the runs")
    results: dict[str, Any] = {
        "commit": commit(),
        "generated": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "quick": options.quick,
        "machine": machine(),
        "load_average_at_start": load_average,
    }
    for name, section in SECTIONS.items():
        if not options.only or name in options.only:
            print(f"bench: {name}", file=sys.stderr, flush=True)
            try:
                results[name] = section(session)
            except Exception as error:  # hours of the other sections are not lost for it
                session.fail(f"{name}: {type(error).__name__}: {error}")
    results["references"] = session.references.facts()
    return results | {"notes": session.notes, "failures": session.failures}


if __name__ == "__main__":
    sys.exit(main())
