"""A bench session: runs the solver for one job at a time, repeats short runs, keeps what went wrong."""

from __future__ import annotations

import argparse
import dataclasses
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from verification.case import Case, CaseError, Variant, load_case, toml_value
from verification.compare import DataError
from verification.execute import Outcome, Run, execute
from verification.progress import Progress
from verification.run import REPOSITORY, References, judge

ARITHMETIC = "numerics.pair_arithmetic"
BUILT_IN = "built-in"  # of a solver without that key
WRAPPER = Path(__file__).resolve().parent / "peak_memory.py"
TRUTHS = ("exact", "finite-element")  # kinds of checks whose value is an error of the solver

Reader = Callable[[Outcome], dict[str, float]]


@dataclass(frozen=True)
class Job:
    """One point to be measured. `settings` are keys of the scene that leave the flow as it is."""

    case: Case
    variant: Variant
    spacing: float  # m
    scheme: str = "default"
    arithmetic: str = "float"
    threads: int = 1
    settings: Mapping[str, Any] = field(default_factory=dict)
    may_stop: bool = False  # a run that the solver stops is an answer (a note), not a failure of the bench

    @property
    def run(self) -> Run:
        return Run(self.case, self.scheme, self.variant, self.spacing, finest=False)

    @property
    def label(self) -> str:
        changes = "".join(f", {key} = {value}" for key, value in self.settings.items())
        return f"{self.run.label}, {self.arithmetic}, {self.threads} thread(s){changes}"

    def solver_settings(self) -> list[str]:
        chosen = {} if self.arithmetic == BUILT_IN else {ARITHMETIC: self.arithmetic}
        return [f"{key}={toml_value(value)}" for key, value in {**self.settings, **chosen}.items()]


@dataclass
class Measured:
    """What a job's run of median wall time says of itself, and what was read from its result."""

    job: Job
    failure: str = ""
    attributes: dict[str, float] = field(default_factory=dict)
    readings: dict[str, float] = field(default_factory=dict)
    repetitions: int = 0
    peak_memory: float = math.nan  # bytes; measured only when asked for

    @property
    def wall(self) -> float:
        return self.attributes.get("wall_seconds", math.nan)

    @property
    def particles(self) -> float:
        """Fluid and dummies, as the solver counts them."""
        return self.attributes.get("fluid_particles", math.nan) + self.attributes.get("dummy_particles", 0.0)

    @property
    def step_seconds(self) -> float:
        """Time of one step, without start, output and checks: of those a short run has too many."""
        apart = sum(self.attributes.get(f"seconds_{phase}", 0.0) for phase in ("start", "output_and_checks"))
        return (self.wall - apart) / self.attributes.get("steps", math.nan)


def ask(command: Sequence[str]) -> str:
    """What a command prints; raises CaseError with its message when it ends badly."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise CaseError(str(error)) from error
    if done.returncode != 0:
        message = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise CaseError(f"{Path(command[0]).name} {command[1]}: exit status {done.returncode}: {message}")
    return done.stdout


def scene_keys(manual: str) -> dict[str, tuple[str, ...]]:
    """Addresses of all keys in the text of `slurry help scene`, with the names that a key allows."""
    keys: dict[str, tuple[str, ...]] = {}
    table = ""
    for line in manual.splitlines():
        if heading := re.match(r"\[+(\w+)\]", line):
            table = heading[1]
        elif table and (entry := re.match(r" {2}(\w+)\s+(\S.*)", line)):
            keys[f"{table}.{entry[1]}"] = tuple(re.findall(r'"([^"]*)"', entry[2].split(";")[0]))
    return keys


def default_name(manual: str, key: str) -> str:
    """The default of a key that allows names, from the same text; "" when there is none."""
    entry = re.search(rf'^  {key.split(".")[-1]}\s.*?; "([^"]*)"', manual, re.MULTILINE)
    return entry[1] if entry else ""


def finite(value: float) -> float | None:
    """The number, or None (null in JSON) for one that is not finite."""
    return value if math.isfinite(value) else None


def parser(command: str, description: str | None) -> argparse.ArgumentParser:
    """The options that both commands of the bench have."""
    options = argparse.ArgumentParser(prog=command, description=(description or "").splitlines()[0])
    options.add_argument("--quick", action="store_true", help="few and small runs: a trial, no measurement")
    options.add_argument("--solver", type=Path, default=REPOSITORY / "build" / "slurry")
    options.add_argument("--out", type=Path, default=REPOSITORY / "build" / "bench")
    return options


class Session:
    def __init__(self, solver: Path, out: Path, plan: Mapping[str, Any], references: References) -> None:
        self.solver, self.out, self.plan, self.references = solver, out, plan, references
        if not os.access(solver, os.X_OK):
            raise CaseError(f"{solver} is not there or not executable: run `make build` first")
        self.manual = ask([str(solver), "help", "scene"])
        self.keys = scene_keys(self.manual)
        self.failures: list[str] = []
        self.notes: list[str] = []

    def note(self, text: str) -> None:
        if text not in self.notes:
            self.notes.append(text)
            print(f"bench: {text}", file=sys.stderr, flush=True)

    def fail(self, text: str) -> None:
        self.failures.append(text)
        print(f"bench: FAILED: {text}", file=sys.stderr, flush=True)

    def knows(self, key: str, value: Any = None) -> bool:
        """Whether the solver has the key, and allows the value if it is one of names; a note says if not."""
        if key not in self.keys:
            self.note(f"{key} is not a key of this solver: what needs it is left out")
        elif isinstance(value, str) and value not in self.keys[key]:
            self.note(f"{key} does not allow {value!r}: what needs it is left out")
        else:
            return True
        return False

    def arithmetics(self, wanted: Sequence[str]) -> list[str]:
        """Those of the wanted pair arithmetics that the solver has; its own when it has no choice."""
        if not self.knows(ARITHMETIC):
            return [BUILT_IN]
        return [name for name in wanted if self.knows(ARITHMETIC, name)]

    def arithmetic(self) -> str:
        return self.arithmetics(["float"])[0]

    def job(self, case: str, variant: str, spacing: float, **choices: Any) -> Job:
        loaded = load_case(case)
        found = [v for v in loaded.variants if v.name == variant]
        if not found:
            raise CaseError(f"{case} has no variant {variant}")
        return Job(loaded, found[0], spacing, **{"arithmetic": self.arithmetic()} | choices)

    def shortened(self, job: Job, steps: int) -> Job:
        """The job cut to about so many steps, with as little output as a run can have."""
        command = [str(self.solver), "info", str(job.case.scene_path)]
        # To relax millions of particles takes minutes, and the time step is the same without.
        for setting in [*job.run.settings(), *job.solver_settings(), 'start.arrangement="lattice"']:
            command += ["--set", setting]
        step = re.search(r"^time step\s+(\S+) s", ask(command), re.MULTILINE)
        if not step:
            raise CaseError("slurry info does not name the time step")
        ends = {"output.end_time": steps * float(step[1]), "output.series_samples": 2}
        ends |= {"output.snapshot_times": [], "output.probe_samples": 1}
        variant = Variant(job.variant.name, {**job.variant.set, **ends})
        return dataclasses.replace(job, variant=variant)

    def errors(self, outcome: Outcome) -> dict[str, float]:
        """The case's errors against its reference, as verify measures them; a missing one is a failure."""
        errors = {}
        for result in judge([outcome], self.references, "gate")[0]:
            if result.check.kind in TRUTHS:
                errors[result.check.quantity] = result.value
                if not math.isfinite(result.value):
                    self.fail(f"{outcome.run.label}: {result.check.quantity}: {result.explanation()}")
        return errors

    def measure(
        self, job: Job, read: Reader | None = None, memory: bool = False, solver: Path | None = None
    ) -> Measured:
        """Runs the job, more than once when it is short; nothing of its result stays on the disc."""
        self.out.mkdir(parents=True, exist_ok=True)
        folder = Path(tempfile.mkdtemp(prefix=".run.", dir=self.out))
        try:
            return self._measure(job, folder, read, memory, solver or self.solver)
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def _measure(self, job: Job, folder: Path, read: Reader | None, memory: bool, solver: Path) -> Measured:
        timeout, report = self.plan["timeout_s"], folder / "peak_memory"
        small_python = [sys.executable, "-I", "-S", str(WRAPPER), str(report), str(timeout)]
        options = argparse.Namespace(
            solver=solver, out=folder, solver_set=job.solver_settings(), reuse=False, threads=job.threads,
            timeout=timeout + (10 if memory else 0),
        )  # fmt: skip
        runs: list[dict[str, float]] = []
        while not runs or (
            runs[0]["wall_seconds"] < self.plan["short_run_s"] and len(runs) < self.plan["repetitions"]
        ):
            outcome = execute(job.run, options, small_python if memory else ())
            if not outcome.failure and not outcome.attributes.get("wall_seconds", 0) > 0:
                outcome.failure = "the result has no wall_seconds"
            if outcome.failure:
                stopped = job.may_stop and outcome.failure.startswith("exit status 3:")
                (self.note if stopped else self.fail)(f"{job.label}: {outcome.failure}")
                return Measured(job, outcome.failure)
            runs.append(outcome.attributes)
        middle = sorted(runs, key=lambda run: run["wall_seconds"])[(len(runs) - 1) // 2]
        measured = Measured(job, "", middle, repetitions=len(runs))
        if memory:
            measured.peak_memory = float(report.read_text())
        try:
            measured.readings = read(outcome) if read else {}
        except DataError as error:
            measured.failure = str(error)
            self.fail(f"{job.label}: {error}")
        return measured

    def progress(self, jobs: Sequence[Job]) -> Progress:
        return Progress(sum(job.run.expected_work() for job in jobs), len(jobs))

    def measure_all(
        self, jobs: Sequence[Job], read: Reader | None = None, memory: bool = False
    ) -> list[Measured]:
        """Every job in its order, with progress; references are made first, so that no run waits for one."""
        if read == self.errors:
            self.references.prepare([(job.case, job.variant) for job in jobs])
        progress, measured = self.progress(jobs), []
        for job in jobs:
            progress.begin(job.label)
            measured.append(self.measure(job, read, memory))
            outcome = measured[-1].failure or f"{measured[-1].wall:.2f} s"
            progress.end(f"{job.label}: {outcome}", job.run.expected_work())
        return measured
