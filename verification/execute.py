"""The solver runs of a verification: which ones, how each is called, what to say of one that goes wrong."""

from __future__ import annotations

import argparse
import hashlib
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from verification.case import SCHEMES, Case, Variant, toml_value
from verification.compare import DataError
from verification.measure import Result


@dataclass(frozen=True)
class Run:
    """One solver run; `finest` carries the tolerance, the others the observed order."""

    case: Case
    scheme: str
    variant: Variant
    spacing: float
    finest: bool

    @property
    def label(self) -> str:
        return f"{self.case.name} {self.scheme} {self.variant.name} {self.spacing:g} m"

    def folder(self, out: Path) -> Path:
        return out / "runs" / self.case.name / self.scheme / self.variant.name / f"{self.spacing:g}"

    def settings(self) -> list[str]:
        values = {"scene.scheme": self.scheme, "numerics.particle_spacing": self.spacing, **self.variant.set}
        return [f"{key}={toml_value(value)}" for key, value in values.items()]

    def expected_work(self) -> float:
        """Particle-steps, for the time remaining: the time step of Eq. 2.35 with Mach 0.1."""
        scene = self.case.scene(self.variant)
        size = [
            high - low for low, high in zip(scene["domain"]["lower"], scene["domain"]["upper"], strict=True)
        ]
        viscosity = scene["fluid"]["dynamic_viscosity"] / scene["fluid"]["density"]
        step = 0.25 * min(
            self.spacing / (1.1 * scene["numerics"]["sound_speed"]), self.spacing**2 / viscosity
        )
        return size[0] * size[1] / self.spacing**2 * scene["output"]["end_time"] / step


@dataclass
class Outcome:
    run: Run
    result: Result
    failure: str = ""  # why there is no result, in one line
    attributes: dict[str, float] = field(default_factory=dict)


def plan(cases: Sequence[Case], options: argparse.Namespace) -> list[Run]:
    runs = []
    for case in cases:
        for scheme in [scheme for scheme in options.scheme or SCHEMES if scheme in case.schemes]:
            for variant in [v for v in case.variants if options.variant in (None, v.name)]:
                asked = options.spacings or case.spacings(scheme, options.level, variant.name)
                spacings = sorted(asked, reverse=True)
                runs += [Run(case, scheme, variant, s, s == spacings[-1]) for s in spacings]
    return runs


def execute(run: Run, options: argparse.Namespace, prefix: Sequence[str] = ()) -> Outcome:
    """Runs the solver, called through the command `prefix` if there is one. A run that goes wrong gives an
    Outcome with the solver's message, not an exception.
    """
    folder = run.folder(options.out)
    scene = run.case.scene(run.variant)
    outcome = Outcome(run, Result(folder / "result.h5", scene["output"]["end_time"], scene))
    settings = run.settings() + options.solver_set
    scene_path = run.case.path(run.variant)
    arguments = ["run", str(scene_path)] + [part for item in settings for part in ("--set", item)]
    content = options.solver.read_bytes() + scene_path.read_bytes() + "\0".join(arguments).encode()
    digest = hashlib.sha256(content).hexdigest()
    stamp = folder / "command.sha256"
    if not (options.reuse and stamp.exists() and stamp.read_text() == digest):
        shutil.rmtree(folder, ignore_errors=True)  # an earlier result must never pass for this one
        folder.mkdir(parents=True)
        command = [
            *prefix,
            str(options.solver),
            *arguments,
            "--out",
            str(folder),
            "--threads",
            str(options.threads),
            "--quiet",
        ]
        outcome.failure = call(command, options.timeout)
        if not outcome.failure:
            stamp.write_text(digest)
    try:
        outcome.attributes = {} if outcome.failure else outcome.result.attributes()
    except DataError as error:
        outcome.failure = str(error)
    return outcome


def call(command: Sequence[str], timeout: float) -> str:
    """Runs a command; "" if it ends well, otherwise one line that says how it did not."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False)
    except subprocess.TimeoutExpired:
        return f"the solver did not end within {timeout:g} s"
    except OSError as error:
        return f"the solver could not be started: {error}"
    lines = [line for line in done.stderr.splitlines() if line.strip()]
    return f"exit status {done.returncode}: {lines[-1] if lines else 'no message'}" if done.returncode else ""
