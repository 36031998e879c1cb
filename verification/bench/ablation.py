"""What each part of the default scheme costs in time and brings in accuracy, one switched at a time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from verification.bench.session import ARITHMETIC, Session, default_name, finite
from verification.bench.speed_error import point


def variants(session: Session) -> list[dict[str, Any]]:
    """The plan's changes that this solver knows, `each` spelt out; what it does not know becomes a note."""
    found: list[dict[str, Any]] = []
    for entry in session.plan["ablation"]["variants"]:
        if key := entry.get("each"):
            allowed = session.keys[key] if session.knows(key) else ()
            usual = default_name(session.manual, key)
            found += [
                {**entry, "name": f"{key.split('.')[-1]} {name}", "set": {key: name}}
                for name in allowed
                if name != usual
            ]
        elif all(session.knows(key, value) for key, value in entry["set"].items()):
            found.append(entry)
    return found


def measure(session: Session) -> list[dict[str, Any]]:
    """A row for each case and change, the scheme as it is first; one thread. A change with which the solver
    stops (exit status 3) is an answer as well. `settings` of a case are those of all its runs.
    """
    jobs, names = [], []
    for entry in session.plan["ablation"]["cases"]:
        case = dict(entry)
        common = case.pop("settings", {})
        changes = [v for v in variants(session) if case["case"] in v.get("cases", [case["case"]])]
        for change in [{"name": "default scheme", "set": {}}, *changes]:
            settings = {**common, **change["set"]}
            choices = {"arithmetic": settings.pop(ARITHMETIC, session.arithmetic())}
            choices |= {"settings": settings, "may_stop": bool(change["set"])}
            jobs.append(session.job(**case, **choices))
            names.append(change["name"])
    rows = [
        {"name": name, **point(measured)}
        for name, measured in zip(names, session.measure_all(jobs, session.errors), strict=True)
    ]
    base: dict[str, Any] = {}
    for row in rows:
        base = row if row["name"] == "default scheme" else base
        row |= judge(row, base, session.plan["ablation"]["equal_within"])
    return rows


def judge(row: Mapping[str, Any], base: Mapping[str, Any], equal_within: float) -> dict[str, Any]:
    """Ratios to the scheme as it is, and who is better: in time, and in how many of the errors."""
    nan = math.nan
    time = (row["step_s"] or nan) / (base["step_s"] or nan)
    errors = {
        quantity: (row["errors"].get(quantity) or nan) / (value or nan)
        for quantity, value in base["errors"].items()
    }
    ratios = {
        "relative_step_time": finite(time),
        "relative_errors": {k: finite(v) for k, v in errors.items()},
    }
    if row is base:
        return {**ratios, "better": ""}
    if row["failure"] or not errors or not all(map(math.isfinite, [time, *errors.values()])):
        return {**ratios, "better": "default: this one does not run" if row["failure"] else "unknown"}
    return {**ratios, "better": _better(time, list(errors.values()), equal_within)}


def _better(time: float, errors: list[float], equal_within: float) -> str:
    """ "default", "this" or "equal" where time and errors agree; otherwise what speaks for each."""
    better = sum(ratio < 1 - equal_within for ratio in errors)
    worse = sum(ratio > 1 + equal_within for ratio in errors)
    faster, slower = time < 1 - equal_within, time > 1 + equal_within
    for_this, for_default = faster or better > 0, slower or worse > 0
    if not for_this and not for_default:
        return "equal"
    if for_this != for_default:
        return "this" if for_this else "default"
    speed = "this is faster" if faster else "default is faster" if slower else "same speed"
    return f"{speed}; errors: {better} lower, {worse} higher of {len(errors)}"
