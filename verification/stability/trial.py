"""One run of a hard case, made harder by a factor in one direction, and whether it survived."""

from __future__ import annotations

import argparse
import dataclasses
import sys
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py

from verification.case import HARD, Case, CaseError, Variant
from verification.execute import Outcome, Run, execute
from verification.run import References, judge

SPACING = "numerics.particle_spacing"
LEVEL = HARD  # whose spacings the cases name beside those of gate and paper
# Ways to end. Only the last two are a fault of the solver: nothing said that the answer is wrong.
SURVIVED, STOPPED, REFUSED, WRONG, BROKE = "survived", "stopped", "refused", "wrong", "broke"
WRAPPER = Path(__file__).parent / "resident_memory.py"
MOST_GROWTH = 0.01  # of resident memory
FEWEST_SAMPLES = 3  # in a tenth of the run
ENDS = {"exit status 3:": STOPPED, "exit status 2:": REFUSED}


@dataclass(frozen=True)
class Direction:
    """A way to make a case harder: at factor f each key is its value times f ** power."""

    name: str
    meaning: str
    scale: Mapping[str, float]  # powers
    limit: float  # the largest factor that is tried

    def __post_init__(self) -> None:
        if not self.scale or not self.limit > 1:
            raise CaseError(f"direction {self.name}: needs keys to scale and a limit above 1")


@dataclass(frozen=True)
class Subject:
    """A variant of a hard case as the defaults run it."""

    case: Case
    variant: Variant

    @property
    def spacing(self) -> float:
        return self.case.spacings("default", LEVEL, self.variant.name)[-1]

    @property
    def label(self) -> str:
        return f"{self.case.name} {self.variant.name}"


@dataclass(frozen=True)
class Trial:
    """How a run ended; `reason` is the solver's message or the checks that failed."""

    factor: float
    values: Mapping[str, Any]  # of the keys that were scaled
    end: str
    reason: str
    seconds: float = 0.0
    time_step: float = 0.0  # s; 0 when there is no result

    @property
    def survived(self) -> bool:
        return self.end == SURVIVED


def value_at(scene: Mapping[str, Any], address: str) -> Any:
    """A value of a scene with all defaults filled in; raises CaseError."""
    node: Any = scene
    for part in address.split("."):
        if isinstance(node, list):
            node = next((entry for entry in node if entry.get("name") == part), None)
        elif isinstance(node, Mapping):
            node = node.get(part)
        if node is None:
            raise CaseError(f"{address}: the scene has no {part}")
    return node


def harder(base: Mapping[str, Any], direction: Direction, factor: float) -> dict[str, Any]:
    """The direction's values at a factor; a vector is scaled as a whole."""
    values = {}
    for key, power in direction.scale.items():
        value = value_at(base, key)
        times = factor**power
        values[key] = [times * part for part in value] if isinstance(value, list) else times * value
    return values


def attempt(
    subject: Subject, values: Mapping[str, Any], factor: float, options: argparse.Namespace, folder: Path
) -> tuple[Trial, Outcome]:
    """Runs the subject with these values and holds it against its checks; its reference has them, too."""
    spacing = float(values.get(SPACING, subject.spacing))
    set_values = {**subject.variant.set, **{k: v for k, v in values.items() if k != SPACING}}
    run = Run(subject.case, "default", Variant(subject.variant.name, set_values), spacing, finest=True)
    arguments = argparse.Namespace(
        solver=options.solver, out=folder, solver_set=[], reuse=False, threads=1, timeout=options.timeout + 10
    )
    memory = folder / "resident_memory"
    small_python = [sys.executable, "-I", "-S", str(WRAPPER), str(memory), str(options.timeout)]
    outcome = execute(run, arguments, small_python)
    seconds, step = (outcome.attributes.get(name, 0.0) for name in ("wall_seconds", "time_step"))
    end, reason = verdict(outcome)
    if end == SURVIVED and (growth := memory_growth(memory)) > MOST_GROWTH:
        end, reason = WRONG, f"resident memory grew by {100 * growth:.3g} % over the second half of the run"
    return Trial(factor, dict(values), end, reason, seconds, step), outcome


def memory_growth(samples: Path) -> float:
    """How much larger the memory's greatest sample is in the run's last tenth than in its middle one, over
    the latter; 0 for a run too short to tell.
    """
    sizes = [int(line) for line in samples.read_text().split()]
    tenth = len(sizes) // 10
    if tenth < FEWEST_SAMPLES:
        return 0.0
    middle = max(sizes[5 * tenth : 6 * tenth])
    return max(sizes[-tenth - 1 : -1]) / middle - 1  # the very last may be of a process that has gone


def verdict(outcome: Outcome) -> tuple[str, str]:
    """How a run ended, and why in one line."""
    if outcome.failure:
        end = next((name for start, name in ENDS.items() if outcome.failure.startswith(start)), BROKE)
        reason = outcome.failure.replace(f"{outcome.run.case.scene_path.parent}/", "")
        return end, reason.partition(": ")[2] if end != BROKE else reason
    (results,) = judge([outcome], References(), LEVEL)
    failed = [result for result in results if not result.passed and not result.check.reported]
    reasons = "; ".join(f"{result.check.quantity}: {result.explanation()}" for result in failed)
    return (WRONG, reasons) if failed else (SURVIVED, "")


def resolved_scene(outcome: Outcome) -> dict[str, Any]:
    """The scene that ran, with every default filled in."""
    with h5py.File(outcome.result.path, "r") as file:
        return tomllib.loads(str(file.attrs["scene"]))


def base_scene(subject: Subject, options: argparse.Namespace, folder: Path) -> tuple[Trial, dict[str, Any]]:
    """The run at the defaults and its scene; of a run that was stopped only what the case says is known."""
    trial, outcome = attempt(subject, {}, 1.0, options, folder)
    try:
        scene = resolved_scene(outcome)
    except (OSError, KeyError):
        scene = run_for_defaults(subject, options, folder)
    return trial, scene


def run_for_defaults(subject: Subject, options: argparse.Namespace, folder: Path) -> dict[str, Any]:
    """The scene with every default, from a run of a single step."""
    tiny = {"output.end_time": 1e-30, "output.snapshot_times": [], "output.probe_samples": 1}
    shorter = dataclasses.replace(subject.variant, set={**subject.variant.set, **tiny})
    _, outcome = attempt(dataclasses.replace(subject, variant=shorter), {}, 1.0, options, folder)
    try:
        scene = resolved_scene(outcome)
    except (OSError, KeyError) as error:
        raise CaseError(f"{subject.label}: not even a step: {outcome.failure}") from error
    scene["output"]["end_time"] = subject.case.scene(subject.variant)["output"]["end_time"]
    return scene
