"""The gate on cost: instructions for each particle and step. Counted, so that a busy machine does not matter.

Small scenes run with one thread under valgrind's cachegrind, in a build for AVX2 (valgrind has no AVX-512).
Each runs with SHORT and with LONG steps, and the difference is what the steps in between took: starting,
reading the scene and HDF5 are in both. What of it the watchdog takes is counted by callgrind. A count depends
on compiler and libraries, so it is compared with counts.json only when those are the same; a limit holds
everywhere. `--accept` stores the figures; the commit of counts.json is where a person reviews them.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import platform
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from verification.case import ROOT
from verification.compare import DataError
from verification.measure import Result

REPOSITORY = ROOT.parent
# Steps: enough between them that one neighbour list more or less changes the count by about what is looked
# for, not by several times that. The longer run ends with the watchdog's first look at places.
SHORT, LONG = 50, 200
ACOUSTIC_CFL = 0.25
KERNEL = "fitted_quintic"  # the default scheme's
LARGEST_CHANGE = 0.02
LARGEST_SPREAD = 0.002  # of two runs of the same: a tenth of the change that is to be found
REPETITIONS = 2
TIMEOUT = 300.0  # s, for one run
CACHEGRIND = ("--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null")
# Counts nothing but solver/time/watchdog.cpp's watch() and what it calls.
WATCHDOG = ("--tool=callgrind", "--callgrind-out-file=/dev/null", "--toggle-collect=slurry::watch(*")

Figures = dict[str, float]


class CountError(Exception):
    """A figure that could not be had: one line."""


@dataclass(frozen=True)
class Scene:
    case: str  # verification/<case>/scene.toml
    spacing: float  # m
    sound_speed: float  # m/s, as in the scene

    def settings(self, steps: int) -> list[str]:
        """Overrides for a run of so many steps that records as little as can be.

        Jittered, because a lattice puts neighbours exactly at the kernel's support, where none is of use.
        """
        end_time = steps * ACOUSTIC_CFL * self.spacing / self.sound_speed
        return [
            f"numerics.particle_spacing={self.spacing!r}", f"numerics.acoustic_cfl={ACOUSTIC_CFL!r}",
            f"output.end_time={end_time!r}", "output.series_samples=2", "output.probe_samples=1",
            "output.snapshot_times=[]", 'start.arrangement="jittered"',
        ]  # fmt: skip


@dataclass(frozen=True)
class Figure:
    """`worse` is +1 where more is worse and -1 where less is; `limit` holds whatever is stored."""

    worse: int
    limit: float | None = None


@dataclass(frozen=True)
class Run:
    instructions: int
    attributes: Mapping[str, float]  # of the result's group `run`


SCENES = (
    Scene("rough_channel", 1e-6, 10.0),
    Scene("taylor_green", 0.04, 10.0),
    Scene("stability/disc_crowd", 0.02, 20.0),
)
FIGURES = {
    "instructions_per_particle_step": Figure(+1),
    "evaluated_per_useful_pair": Figure(+1, limit=1.45),
    "steps_per_list": Figure(-1),
    "bytes_per_particle": Figure(+1),
    "watchdog_share": Figure(+1, limit=0.005),
}


def build(folder: Path, jobs: int) -> Path:
    """The solver for AVX2, built in `folder`; of the pair loops only those that SCENES use."""
    generator = ["-GNinja"] if shutil.which("ninja") and not (folder / "CMakeCache.txt").exists() else []
    options = ["-DSLURRY_ARCHITECTURE=x86-64-v3", "-DBUILD_TESTING=OFF", "-DCMAKE_UNITY_BUILD=ON"]
    options += [f"-DSLURRY_ONLY_KERNEL={KERNEL}"]
    for command in (
        ["cmake", "-S", str(REPOSITORY), "-B", str(folder), *generator, *options],
        ["cmake", "--build", str(folder), "--target", "slurry", "--parallel", str(jobs)],
    ):
        if subprocess.run(command, check=False).returncode != 0:
            raise CountError(f"this failed: {' '.join(command)}")
    return folder.resolve() / "slurry"


def made_with(folder: Path) -> str:
    """Compiler and C library of the build in `folder`."""
    found = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.+)$", (folder / "CMakeCache.txt").read_text(), re.M)
    if not found:
        raise CountError(f"{folder / 'CMakeCache.txt'} names no compiler")
    version = subprocess.run([found[1], "--version"], capture_output=True, text=True, check=True).stdout
    compiler = re.sub(r"^[cg]\+\+\S*", "GCC", version.splitlines()[0])  # the same by any name
    return f"{compiler}, {' '.join(platform.libc_ver())}"


def count(solver: Path, scene: Scene, steps: int, out: Path, tool: Sequence[str] = CACHEGRIND) -> Run:
    """One run of the scene under a tool of valgrind, in the folder `out`."""
    words = [word for setting in scene.settings(steps) for word in ("--set", setting)]
    command = ["valgrind", *tool, str(solver), "run", "scene.toml", *words]
    command += ["--threads", "1", "--quiet", "--out", "."]
    shutil.rmtree(out, ignore_errors=True)  # an earlier result must never pass for this one
    out.mkdir(parents=True)
    shutil.copy(ROOT / scene.case / "scene.toml", out)
    # Lengths of paths and of the environment shift addresses, and with them counts: by up to 2 % seen.
    environment = {"PATH": os.environ["PATH"], "OMP_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            command, cwd=out, env=environment, capture_output=True, text=True, timeout=TIMEOUT, check=False
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise CountError(f"valgrind: {error}") from error
    if done.returncode != 0:
        lines = [line for line in done.stderr.splitlines() if not line.startswith(("==", "--"))]  # valgrind's
        raise CountError(f"exit status {done.returncode}: {lines[-1] if lines else 'no message'}")
    attributes = Result(out / "result.h5", 0).attributes()
    if attributes.get("steps") != steps:
        raise CountError(f"the run made {attributes.get('steps')} steps, not {steps}")
    return Run(parse_instructions(done.stderr), attributes)


def parse_instructions(text: str) -> int:
    found = re.search(r"\bI\s+refs:\s+([\d,]+)", text)
    if not found:
        raise CountError("valgrind printed no number of instructions")
    return int(found[1].replace(",", ""))


def figures(short: Run, long: Run, watchdog: Run) -> Figures:
    """The figures of FIGURES that these runs allow; the lists' come from the longer one.

    `watchdog` is the longer one again, of which nothing else was counted.
    """
    end = long.attributes
    particles = end["fluid_particles"] + end["dummy_particles"]
    per_step = ratio(long.instructions - short.instructions, end["steps"] - short.attributes["steps"])
    result = {
        "instructions_per_particle_step": ratio(per_step, particles),
        "watchdog_share": ratio(watchdog.instructions, per_step * end["steps"]),
    }
    if "list_evaluated" in end and "list_useful" in end:
        result["evaluated_per_useful_pair"] = ratio(end["list_evaluated"], end["list_useful"])
    if "list_rebuilds" in end:
        result["steps_per_list"] = ratio(end["steps"], end["list_rebuilds"])
    if "bytes_per_particle" in end:
        result["bytes_per_particle"] = end["bytes_per_particle"]
    return result


def ratio(numerator: float, denominator: float) -> float:
    return numerator / denominator if denominator and math.isfinite(denominator) else math.nan


def judge(name: str, value: float | None, stored: float | None, comparable: bool) -> tuple[str, str]:
    """("passed", "FAILED" or "not checked", reason) for one figure; `comparable`: with the stored one."""
    figure = FIGURES[name]
    if value is None:
        if stored is None and name != "instructions_per_particle_step":
            return "not checked", "the result has no such attributes"
        return "FAILED", "missing"
    if not 0 < value < math.inf:
        return "FAILED", f"{value} is not a positive number"
    if figure.limit is not None:
        return "passed" if value <= figure.limit else "FAILED", f"{value:.4g}, at most {figure.limit:g}"
    if not comparable:
        return "not checked", f"{value:.6g}, not comparable"
    if stored is None:
        return "FAILED", f"{value:.6g}, but nothing is stored; store it with --accept"
    change = ratio(value, stored) - 1
    reason = f"{value:.6g}, stored {stored:.6g} ({100 * change:+.2f} %)"
    if not figure.worse * change <= LARGEST_CHANGE:
        return "FAILED", f"{reason}, more than {LARGEST_CHANGE:.0%} worse"
    if figure.worse * change < -LARGEST_CHANGE:
        return "passed", f"{reason}, better: store it with --accept"
    return "passed", reason


def judge_spread(runs: Sequence[Figures]) -> tuple[str, str]:
    """Whether the same scene was counted alike every time."""
    counts = np.array([run["instructions_per_particle_step"] for run in runs])
    spread = ratio(float(np.ptp(counts)), float(np.mean(counts)))  # NaN when any is
    reason = f"{100 * spread:.3f} % between {len(counts)} runs, at most {LARGEST_SPREAD:.1%}"
    return "passed" if spread <= LARGEST_SPREAD else "FAILED", reason


def measure(solver: Path, options: argparse.Namespace) -> dict[str, list[Figures] | str]:
    """For each case the figures of every repetition, or why there are none."""
    runs = {"short": (SHORT, CACHEGRIND), "long": (LONG, CACHEGRIND), "watchdog": (LONG, WATCHDOG)}
    with ThreadPoolExecutor(options.jobs) as pool:
        futures = {
            (scene.case, repetition, name): pool.submit(
                count, solver, scene, steps, options.out / scene.case / f"{name}_{repetition}", tool
            )
            for scene in SCENES
            for repetition in range(REPETITIONS)
            for name, (steps, tool) in runs.items()
        }
    measured: dict[str, list[Figures] | str] = {}
    for scene in SCENES:
        try:
            measured[scene.case] = [
                figures(*(futures[scene.case, repetition, name].result() for name in runs))
                for repetition in range(REPETITIONS)
            ]
        except (CountError, DataError) as error:
            measured[scene.case] = str(error)
        except KeyError as error:
            measured[scene.case] = f"the result has no attribute {error}"
    return measured


def verdicts(
    measured: Mapping[str, list[Figures] | str], stored: Mapping[str, Any], compiler: str
) -> list[tuple[str, str, str]]:
    """(case and figure, verdict, reason) of everything."""
    comparable = stored.get("made_with", compiler) == compiler
    rows = []
    for case, runs in measured.items():
        if isinstance(runs, str):
            rows.append((case, "FAILED", runs))
            continue
        rows.append((f"{case} repeats", *judge_spread(runs)))
        before = stored.get("cases", {}).get(case, {})
        for name in FIGURES:
            rows.append((f"{case} {name}", *judge(name, runs[0].get(name), before.get(name), comparable)))
    return rows


def accept(measured: Mapping[str, list[Figures] | str], compiler: str, path: Path) -> None:
    """Stores the figures, if all could be had and keep the limits."""
    for subject, verdict, reason in verdicts(measured, {"made_with": None}, compiler):
        if verdict == "FAILED":
            raise CountError(f"not stored: {subject}: {reason}")
    cases = {
        case: {name: float(f"{value:.6g}") for name, value in runs[0].items()}
        for case, runs in measured.items()
        if not isinstance(runs, str)
    }
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps({"made_with": compiler, "cases": cases}, indent=1, allow_nan=False) + "\n")
    partial.replace(path)


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.counts", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--accept", action="store_true", help="store the figures")
    parser.add_argument("--stored", type=Path, default=ROOT / "counts.json")
    parser.add_argument("--build", type=Path, default=REPOSITORY / "build" / "avx2")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "counts")
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count() or 1, help="of the build, and runs at a time"
    )
    options = parser.parse_args(argv)
    try:
        stored = json.loads(options.stored.read_text()) if options.stored.exists() else {}
        solver = build(options.build, options.jobs)
        compiler = made_with(options.build)
        if stored.get("made_with", compiler) != compiler:
            print(f"not comparable: compiled with {compiler}, stored for {stored['made_with']}")
        measured = measure(solver, options)
        rows = verdicts(measured, stored, compiler)
        for subject, verdict, reason in rows:
            print(f"{verdict}: {subject}: {reason}")
        if options.accept:
            accept(measured, compiler, options.stored)
            print(f"stored in {options.stored}")
            return 0
    except (CountError, OSError, ValueError, subprocess.CalledProcessError) as error:
        print(f"counts: {error}", file=sys.stderr)
        return 2
    passed, failed = (sum(row[1] == verdict for row in rows) for verdict in ("passed", "FAILED"))
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
