"""The solver's own bench of the machine: `slurry bench --json`, where the solver has it."""

from __future__ import annotations

import json
from typing import Any

from verification.bench.files import write_whole
from verification.bench.session import Session, ask
from verification.case import CaseError


def measure(session: Session) -> dict[str, Any] | None:
    """What it writes, or None with a note."""
    try:
        manual = ask([str(session.solver), "bench", "--help"])
    except CaseError:
        session.note(
            "this solver has no command `bench`: nothing on the machine's peak and neighbour searches"
        )
        return None
    quick = ["--quick"] if session.plan["machine_bench"]["quick"] else []
    if quick and "--quick" not in manual:
        session.note("`slurry bench` has no --quick: left out")
        return None
    session.out.mkdir(parents=True, exist_ok=True)
    path = session.out / "machine_bench.json"
    path.unlink(missing_ok=True)
    try:
        ask([str(session.solver), "bench", "--json", str(path), *quick])
        content = json.loads(path.read_text())
        write_whole(path, json.dumps(content, allow_nan=False))  # refuses NaN
        return content
    except (CaseError, OSError, ValueError) as error:
        session.fail(f"slurry bench: {error}")
        return None
