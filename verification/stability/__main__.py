"""Runs every hard case with the defaults, then pushes it in each of its directions until it breaks.

`python -m verification.stability` writes stability.json, report.md, report.html and a figure. Every answer is
stored as it comes: an interrupted run goes on where it was, and a new solver or case starts anew. `--page`
writes the margins of all cases into a page, between its markers of `margins`. The exit status is the verdict:
0 when every margin meets its target or is a known shortfall, 1 if not; 2 when it cannot start.
"""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
import json
import math
import os
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from verification.case import HARD, ROOT, Case, CaseError, load_case
from verification.markers import replace_between
from verification.run import References
from verification.stability import report
from verification.stability.margins import Margin, find
from verification.stability.trial import LEVEL, Direction, Subject, Trial, attempt, base_scene, harder

REPOSITORY = ROOT.parent
FOLDER = ROOT / HARD


@dataclasses.dataclass(frozen=True)
class Task:
    subject: Subject
    direction: Direction | None  # None: the defaults alone
    known_shortfall: str = ""

    @property
    def name(self) -> str:
        direction = self.direction.name if self.direction else report.DEFAULTS
        return f"{self.subject.case.name}-{self.subject.variant.name}-{direction}"

    @property
    def subject_name(self) -> str:
        return dataclasses.replace(self, direction=None).name


def directions(path: Path = FOLDER / "directions.toml") -> dict[str, Direction]:
    tables = tomllib.loads(path.read_text())
    return {name: Direction(name=name, **table) for name, table in tables.items()}


def tasks(case: Case, known: dict[str, Direction]) -> Iterator[Task]:
    """A case's variants at the defaults, then its directions; raises CaseError for what does not exist."""
    subjects = {variant.name: Subject(case, variant) for variant in case.variants}
    shortfalls = case.data.get("known_shortfalls", {})
    planned = [Task(subject, None) for subject in subjects.values()]
    for entry in case.data.get("directions", ()):
        for variant in entry["variants"]:
            for name in entry["names"]:
                if variant not in subjects or name not in known:
                    raise CaseError(f"{case.name}: there is no variant {variant} or no direction {name}")
                planned.append(Task(subjects[variant], known[name]))
    for task in planned:
        yield dataclasses.replace(task, known_shortfall=shortfalls.pop(task.name.partition("-")[2], ""))
    if shortfalls:
        raise CaseError(f"{case.name}: known_shortfalls of what is not run: {', '.join(shortfalls)}")


def digest(task: Task, solver: bytes) -> str:
    """Of everything that a stored answer depends on."""
    case = task.subject.case
    scene = case.scene(task.subject.variant)
    checks = [repr(c) for c in case.checks("default", LEVEL, task.subject.variant.name)]
    parts = [solver, json.dumps(scene, sort_keys=True).encode(), "\n".join(checks).encode()]
    return hashlib.sha256(b"\0".join([*parts, repr(task.direction).encode()])).hexdigest()


def perform(task: Task, defaults: dict[str, Any] | None, options: argparse.Namespace) -> dict[str, Any]:
    """The margin of one task, as it is stored, `defaults` being the stored answer of its subject as it is;
    nothing of its runs stays on the disc.
    """
    with tempfile.TemporaryDirectory(prefix=".run.", dir=options.out) as folder:
        out, direction = Path(folder), task.direction
        if direction is None or defaults is None:
            base, scene = base_scene(task.subject, options, out)
            margin = Margin(float(base.survived), math.inf if base.survived else 1.0, [base])
        else:
            scene = defaults["scene"]
            values = harder(scene, direction, 1.0)
            base = Trial(**defaults["trials"][0] | {"values": values})

            def push(factor: float) -> Trial:
                return attempt(task.subject, harder(scene, direction, factor), factor, options, out)[0]

            margin = find(push, base, direction.limit)
    return {
        "case": task.subject.case.name, "variant": task.subject.variant.name,
        "direction": direction.name if direction else report.DEFAULTS, "margin": margin.factor,
        "broken_at": margin.broken_at if margin.broken_at < math.inf else None,
        "met": margin.met if direction else base.survived, "scene": scene,
        "trials": [dataclasses.asdict(trial) for trial in margin.trials],
    }  # fmt: skip


def answer(
    task: Task, defaults: dict[str, Any] | None, options: argparse.Namespace, solver: bytes
) -> dict[str, Any]:
    """The stored answer of this very task, or a new one, stored whole or not at all."""
    if found := stored_answer(task, options, solver):
        return found
    stored = options.out / "margins" / f"{task.name}.json"
    made = perform(task, defaults, options) | {"digest": digest(task, solver)}
    partial = stored.with_suffix(".part")
    partial.write_text(json.dumps(made, indent=1) + "\n")
    partial.replace(stored)
    return made | described(task)


def stored_answer(task: Task, options: argparse.Namespace, solver: bytes) -> dict[str, Any]:
    """The answer of this very task to this very solver, empty if there is none."""
    stored = options.out / "margins" / f"{task.name}.json"
    found = json.loads(stored.read_text()) if stored.exists() else {}
    return found | described(task) if found.get("digest") == digest(task, solver) else {}


def described(task: Task) -> dict[str, str]:
    """What is the case's to say and not measured."""
    meaning = task.direction.meaning if task.direction else "as the defaults run it"
    return {"known_shortfall": task.known_shortfall, "meaning": meaning}


def run_all(planned: Sequence[Task], options: argparse.Namespace) -> list[dict[str, Any]]:
    """Answers in the order of the tasks; progress on standard error."""
    (options.out / "margins").mkdir(parents=True, exist_ok=True)
    References().prepare([(task.subject.case, task.subject.variant) for task in planned])
    solver = options.solver.read_bytes()
    answers: dict[str, dict[str, Any]] = {}
    for directed in (False, True):  # a direction starts from the defaults' answer
        some = [task for task in planned if bool(task.direction) == directed]
        run_some(some, answers, len(planned), options, solver)
    return [answers[task.name] for task in planned]


def run_some(
    some: Sequence[Task],
    answers: dict[str, dict[str, Any]],
    total: int,
    options: argparse.Namespace,
    solver: bytes,
) -> None:
    """Adds the answers of some tasks to `answers`, `options.jobs` at a time."""
    with ThreadPoolExecutor(options.jobs) as pool:
        waiting = {
            pool.submit(answer, task, answers.get(task.subject_name), options, solver): task for task in some
        }
        try:
            for done in as_completed(waiting):
                name = waiting[done].name
                answers[name] = done.result()
                line = f"[{len(answers)}/{total}] {name}: {report.in_words(answers[name])}"
                print(line, file=sys.stderr, flush=True)
        except BaseException:  # whatever ends it, no further run starts
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m verification.stability", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--case", action="append", help="only this case (repeatable)")
    parser.add_argument("--solver", type=Path, default=REPOSITORY / "build" / "slurry")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "stability")
    parser.add_argument("--page", type=Path, help="with the markers of margins; of all cases only")
    parser.add_argument("--report-only", action="store_true", help="of the answers so far")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="runs at a time")
    parser.add_argument("--timeout", type=float, default=600, metavar="S", help="for one run (%(default)s s)")
    return parser.parse_args(argv)


def main(argv: Sequence[str] | None = None) -> int:
    options = parse(argv)
    names = [path.parent.name for path in sorted(FOLDER.glob("*/checks.toml"))]
    try:
        if unknown := set(options.case or []) - set(names):
            raise CaseError(f"no hard case is called {', '.join(sorted(unknown))}")
        if not os.access(options.solver, os.X_OK):
            raise CaseError(f"{options.solver} is not there or not executable: run `make build` first")
        known = directions()
        planned = [t for name in options.case or names for t in tasks(load_case(name), known)]
        if options.report_only:
            solver = options.solver.read_bytes()
            answers = [found for task in planned if (found := stored_answer(task, options, solver))]
        else:
            answers = run_all(planned, options)
        report.write(answers, options.out)
        if options.page:
            if options.case or len(answers) < len(planned):
                raise CaseError(f"{options.page} is for the margins of all cases, and some are missing")
            replace_between(options.page, "margins", report.page(answers))
    except KeyboardInterrupt:
        print("stability: interrupted; the answers so far are kept", file=sys.stderr)
        return 2
    except (CaseError, OSError, ValueError) as error:
        print(f"stability: {error}", file=sys.stderr)
        return 2
    return report.verdict(answers)


if __name__ == "__main__":
    sys.exit(main())
