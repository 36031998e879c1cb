"""The runs that targets are read from. plan.toml has the limits, verdicts.py the verdict."""

from __future__ import annotations

import dataclasses
import math
import subprocess
from pathlib import Path
from typing import Any

import numpy as np

from verification.bench.session import Measured, Session, finite
from verification.bench.speed_error import point
from verification.case import Variant
from verification.compare import DataError
from verification.execute import Outcome
from verification.run import REPOSITORY

AVX2 = "x86-64-v3"


def measure(session: Session) -> dict[str, Any]:
    return {
        "rate": rates(session),
        "steady": steady(session),
        "decay": decay(session),
        "equal_error": equal_error(session),
    }


def rates(session: Session) -> list[dict[str, Any]]:
    """Particle-steps per second of whole steps, fluid and dummies counted; start and output left out."""
    plan = session.plan["target_runs"]["rate"]
    where = {key: plan[key] for key in ("case", "variant", "spacing")}
    jobs = [
        session.shortened(session.job(**where, arithmetic=arithmetic, threads=threads), plan["steps"])
        for arithmetic in session.arithmetics(["float", "double"])
        for threads in (1, 2)
    ]
    rows = [_rate(measured, "this") for measured in session.measure_all(jobs)]
    if plan["avx2"] and (solver := avx2_build(session)):
        rows.append(_rate(session.measure(jobs[0], solver=solver), "avx2"))
    return rows


def _rate(measured: Measured, build: str) -> dict[str, Any]:
    rate = measured.particles / measured.step_seconds
    return {"build": build, **point(measured), "whole_step_rate": finite(rate)}


def avx2_build(session: Session) -> Path | None:
    """A solver of the same source for AVX2; None, with a note or failure, where it says nothing or fails."""
    information = Path("/proc/cpuinfo")
    if not information.exists() or "avx512f" not in information.read_text():
        session.note("this machine has no AVX-512: no AVX2 build to hold against it")
        return None
    folder = REPOSITORY / "build" / "avx2"
    options = [f"-DSLURRY_ARCHITECTURE={AVX2}", "-DBUILD_TESTING=OFF", "-DCMAKE_BUILD_TYPE=Release"]
    configure = ["cmake", "-S", str(REPOSITORY), "-B", str(folder), *options]
    for command in (configure, ["cmake", "--build", str(folder), "--target", "slurry", "--parallel", "2"]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            errors = [line for line in (done.stdout + done.stderr).splitlines() if "rror" in line]
            session.fail(f"the AVX2 build: {errors[0] if errors else command}")
            return None
    return folder / "slurry"


def steady(session: Session) -> list[dict[str, Any]]:
    """The runs of every variant up to its steady state, with their errors."""
    plan = session.plan["target_runs"]["steady"]
    jobs = []
    for variant, end in plan["end_times"].items():
        job = session.job(plan["case"], variant, plan["spacing"], threads=plan["threads"])
        ended = Variant(variant, {**job.variant.set, "output.end_time": end})
        jobs.append(dataclasses.replace(job, variant=ended))
    return [point(measured) for measured in session.measure_all(jobs, session.errors)]


def decay(session: Session) -> dict[str, Any]:
    """The kinetic energy's relative errors at the planned times; the end is the plan's, not the case's."""
    plan = session.plan["target_runs"]["decay"]
    job = session.job(plan["case"], plan["variant"], plan["spacing"], settings=plan["set"])

    def energy_errors(outcome: Outcome) -> dict[str, float]:
        outcome.result.end_time = plan["set"]["output.end_time"]
        times, energy = outcome.result.series("kinetic_energy")
        reference = session.references.of(job.case, job.variant)
        return {f"{time:g}": energy_error(times, energy, time, reference) for time in plan["times"]}

    return point(session.measure_all([job], energy_errors)[0])


def energy_error(times: np.ndarray, energy: np.ndarray, wanted: float, reference: Any) -> float:
    """At the sample nearest to the wanted time, held against the reference at the sample's own time."""
    nearest = int(np.argmin(np.abs(times - wanted)))
    if not abs(times[nearest] - wanted) <= 1e-2 * wanted:
        raise DataError(f"the kinetic energy was sampled at {times[nearest]:g} s, wanted {wanted:g} s")
    exact = reference.kinetic_energy(times[nearest])
    return float(abs(energy[nearest] / exact - 1)) if exact > 0 else math.nan


def equal_error(session: Session) -> list[dict[str, Any]]:
    """Candidates for the shortest time to a given error, one thread."""
    plan = session.plan["target_runs"]["equal_error"]
    jobs = [
        session.job(plan["case"], plan["variant"], run["spacing"], settings=run["set"])
        for run in plan["runs"]
    ]
    return [point(measured) for measured in session.measure_all(jobs, session.errors)]
