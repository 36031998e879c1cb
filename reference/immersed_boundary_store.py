"""Motions of discs stored in data/: a CSV of every grid, under a header with the problem and a checksum.

Rows are sorted by grid (the coarsest first), time, disc (in the order of the problem: by position).
"""

import hashlib
import json
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.base import Array, ReferenceError
from reference.immersed_boundary_run import Problem

HEAD = (
    "# Discs moved by reference/immersed_boundary.py; nothing published. Every grid as computed; SI units.",
    "# Made by `python -m reference.immersed_boundary`; the problem's discs are sorted by position.",
)
COLUMNS = "grid,time_s,disc,x_m,y_m,angle_rad,velocity_x_m_s,velocity_y_m_s,spin_rad_s"


@dataclass(frozen=True)
class Stored:
    identity: dict[str, object]  # of the problem
    arrays: dict[str, Array]
    digest: str  # of the file


def write_stored(file: Path, problem: Problem, arrays: dict[str, Array]) -> None:
    """Raises ReferenceError where the file cannot be written."""
    states, rows = arrays["states"], []
    for grid, step, disc in np.ndindex(states.shape[:3]):
        values = ",".join(f"{value:.9g}" for value in states[grid, step, disc])
        rows.append(f"{grid},{arrays['times'][step]:.10g},{disc},{values}\n")
    body = "".join(rows)
    header = {
        "problem": problem.identity(),
        "run": {key: arrays[key].tolist() for key in ("cells", "touched", "seconds")},
        "sha256": hashlib.sha256(body.encode()).hexdigest(),
    }
    head = [*HEAD, *(f"# {key}: {json.dumps(value)}" for key, value in header.items()), COLUMNS]
    part = file.with_name(f"{file.name}.{os.getpid()}.part")
    try:
        try:
            part.write_text("\n".join(head) + "\n" + body, encoding="utf-8")
            part.replace(file)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise ReferenceError(f"{file}: the reference cannot be stored: {error}") from error


def read_stored(file: Path) -> Stored:
    """Raises ReferenceError for a file that was changed."""
    try:
        text = file.read_text(encoding="utf-8")
        head, body = text.split(f"{COLUMNS}\n")
        lines = [line.removeprefix("# ").split(": ", 1) for line in head.splitlines()[len(HEAD) :]]
        header = {key: json.loads(value) for key, value in lines}
        if header["sha256"] != hashlib.sha256(body.encode()).hexdigest():
            raise ValueError("its rows do not have the checksum of its header")
        rows = np.array([line.split(",") for line in body.splitlines()], dtype=float)
        if not np.isfinite(rows).all():
            raise ValueError("it has values that are not finite")
        arrays = {key: np.array(value, dtype=float) for key, value in header["run"].items()}
        discs = len(header["problem"]["discs"])
        arrays["states"] = rows[:, 3:].reshape(len(arrays["cells"]), -1, discs, 6)
        arrays["times"] = rows[: arrays["states"].shape[1] * discs : discs, 1]
    except (KeyError, OSError, ValueError) as error:
        raise ReferenceError(f"{file}: not a stored motion of discs ({error}); make it again") from error
    return Stored(header["problem"], arrays, hashlib.sha256(text.encode()).hexdigest())
