"""results.json: the schema of design.md section 3, and what its checks add up to."""

from __future__ import annotations

import math
import os
import platform
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from verification import baseline
from verification.case import ROOT
from verification.compare import CheckResult
from verification.execute import Outcome

REPOSITORY = ROOT.parent


def entry(outcome: Outcome, results: Sequence[CheckResult]) -> dict[str, Any]:
    run, attributes = outcome.run, outcome.attributes
    checks = [
        {
            "quantity": r.check.quantity, "metric": r.check.metric, "scale": r.check.scale,
            "value": r.value if math.isfinite(r.value) else None, "tolerance": r.tolerance,
            "tolerance_at_finest": r.check.tolerance, "order": r.order,
            "order_band": list(r.check.order_band) if r.check.order_band and run.finest else None,
            "kind": r.check.kind, "source": r.source, "why": r.check.why, "passed": r.passed,
            "known_shortfall": r.known_shortfall, "note": r.check.known_shortfall or "",
            "reported": r.reported, "unit": r.check.unit, "reason": r.explanation(),
        }
        for r in results
    ]  # fmt: skip
    return {
        "case": run.case.name,
        "scheme": run.scheme,
        "variant": run.variant.name,
        "spacing_m": run.spacing,
        "finest": run.finest,
        "fluid_particles": int(attributes.get("fluid_particles", 0)),
        "steps": int(attributes.get("steps", 0)),
        "threads": int(attributes.get("threads", 0)),
        "wall_s": attributes.get("wall_seconds", 0.0),
        "particle_steps_per_s": attributes.get("particle_steps_per_second", 0.0),
        "passed": all(check["passed"] or standing(check) == "reported" for check in checks),
        "checks": checks,
    }


def machine() -> dict[str, Any]:
    information = Path("/proc/cpuinfo")
    lines = information.read_text().splitlines() if information.exists() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return {
        "processor": models[0] if models else "unknown",
        "cores": os.cpu_count(),
        "system": platform.platform(),
    }


def commit() -> str:
    """The commit under test, with "+changes" when the tree differs from it."""
    git = ["git", "-C", str(REPOSITORY)]
    head = subprocess.run([*git, "rev-parse", "HEAD"], capture_output=True, text=True, check=False)
    changes = subprocess.run([*git, "status", "--porcelain"], capture_output=True, text=True, check=False)
    if head.returncode != 0:
        return "unknown"
    return head.stdout.strip() + ("+changes" if changes.stdout.strip() else "")


def standing(check: dict[str, Any]) -> str:
    """ "reported" (decides nothing, passed or not), "passed", "known" (a shortfall) or "failed"."""
    if check["reported"]:
        return "reported"
    if check["passed"]:
        return "passed"
    return "known" if check["known_shortfall"] else "failed"


def summary(results: dict[str, Any]) -> tuple[int, int]:
    """Numbers of passed and failed checks: a regression counts as failed; a known shortfall and what is only
    reported count as neither.
    """
    counted = [c for case in results["cases"] for c in case["checks"] if case["finest"] or not c["passed"]]
    found = [standing(check) for check in counted]
    return found.count("passed"), found.count("failed") + len(baseline.failures(results))
