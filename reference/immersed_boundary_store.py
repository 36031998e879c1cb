"""Motions of discs stored in data/: a CSV of every grid, under a header with the problem and a checksum.

Rows are sorted by grid (the coarsest first), time, disc (in the order of the problem: by position).
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.base import Array, ReferenceError
from reference.immersed_boundary_run import Problem
from reference.stored_rows import read_rows, write_rows

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
    run = {key: arrays[key].tolist() for key in ("cells", "touched", "seconds")}
    write_rows(file, HEAD, COLUMNS, {"problem": problem.identity(), "run": run}, "".join(rows))


def read_stored(file: Path) -> Stored:
    """Raises ReferenceError for a file that was changed."""
    try:
        header, cells, digest = read_rows(file, HEAD, COLUMNS)
        rows = np.array(cells, dtype=float)
        if not np.isfinite(rows).all():
            raise ValueError("it has values that are not finite")
        arrays = {key: np.array(value, dtype=float) for key, value in header["run"].items()}
        discs = len(header["problem"]["discs"])
        arrays["states"] = rows[:, 3:].reshape(len(arrays["cells"]), -1, discs, 6)
        arrays["times"] = rows[: arrays["states"].shape[1] * discs : discs, 1]
    except (KeyError, OSError, ValueError) as error:
        raise ReferenceError(f"{file}: not a stored motion of discs ({error}); make it again") from error
    return Stored(header["problem"], arrays, digest)
