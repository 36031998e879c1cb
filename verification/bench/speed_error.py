"""Error against wall time for the cases of the plan: spacings, schemes, pair arithmetics and threads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from verification.bench.session import Job, Measured, Session, finite
from verification.case import load_case

COUNTERS = ("list_rebuilds", "list_pairs", "list_evaluated")  # of solvers that count them


def jobs(session: Session) -> list[Job]:
    plan = session.plan["speed_error"]
    arithmetics = session.arithmetics(plan["arithmetics"])
    made = []
    for name in plan["cases"]:
        case = load_case(name)
        for scheme in plan["schemes"]:
            gate = case.spacings(scheme, "gate") if plan["gate_spacings"] else []
            for spacing in sorted({*gate, *plan["more_spacings"].get(name, [])}, reverse=True):
                made += [
                    Job(case, variant, spacing, scheme, arithmetic, threads)
                    for variant in case.variants
                    for arithmetic in arithmetics
                    for threads in plan["threads"]
                ]
    return made


def point(measured: Measured) -> dict[str, Any]:
    job, attributes = measured.job, measured.attributes
    return {
        "case": job.case.name,
        "variant": job.variant.name,
        "scheme": job.scheme,
        "arithmetic": job.arithmetic,
        "threads": job.threads,
        "threads_used": int(attributes.get("threads", 0)),
        "spacing_m": job.spacing,
        "settings": dict(job.settings),
        "fluid_particles": int(attributes.get("fluid_particles", 0)),
        "dummy_particles": int(attributes.get("dummy_particles", 0)),
        "steps": int(attributes.get("steps", 0)),
        "repetitions": measured.repetitions,
        "wall_s": finite(measured.wall),
        "step_s": finite(measured.step_seconds),
        "particle_steps_per_s": attributes.get("particle_steps_per_second"),
        "errors": {quantity: finite(value) for quantity, value in measured.readings.items()},
        "failure": measured.failure,
    } | {name: attributes[name] for name in COUNTERS if name in attributes}


def thread_dependence(points: Sequence[dict[str, Any]]) -> list[str]:
    """Points that differ in nothing but the threads must have the same errors to the last bit."""
    found = []
    first: dict[tuple[Any, ...], dict[str, Any]] = {}
    for item in points:
        if item["failure"]:
            continue  # a failure already, and by itself
        key = tuple(item[name] for name in ("case", "variant", "scheme", "arithmetic", "spacing_m"))
        other = first.setdefault(key, item)
        for quantity, value in item["errors"].items():
            if value != other["errors"].get(quantity):
                found.append(
                    f"{' '.join(map(str, key))} m: the error of {quantity} depends on the threads: "
                    f"{other['errors'].get(quantity)} with {other['threads']}, {value} with {item['threads']}"
                )
    return found


def measure(session: Session) -> list[dict[str, Any]]:
    points = [point(measured) for measured in session.measure_all(jobs(session), session.errors)]
    for difference in thread_dependence(points):
        session.fail(difference)
    return points
