"""Passages of immersed_channel.py stored in data/: a CSV of every grid, its header has scene and checksum.

Rows are sorted by grid (the coarsest first) and time.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.base import Array, ReferenceError, canonical
from reference.stored_rows import read_rows, write_rows

HEAD = (
    "# Wafer shear and disc by reference/immersed_channel.py; nothing published. Every grid, SI units.",
    "# Made by `python -m reference.immersed_channel`, whose docstring has the command.",
)
COLUMNS = "grid,time_s,greatest_wafer_shear_pa,x_m,y_m,angle_rad,velocity_x_m_s,velocity_y_m_s,spin_rad_s"


@dataclass(frozen=True)
class Stored:
    identity: str  # of the scene's flow, canonical
    arrays: dict[str, Array]
    digest: str  # of the file


def write_stored(file: Path, problem: dict[str, object], arrays: dict[str, Array]) -> None:
    """Raises ReferenceError where the file cannot be written."""
    rows = []
    for grid, step in np.ndindex(arrays["shear"].shape):
        values = (arrays["shear"][grid, step], *arrays["states"][grid, step])
        text = ",".join(f"{value:.7g}" for value in values)
        rows.append(f"{grid},{arrays['times'][step]:.10g},{text}\n")
    run = {key: arrays[key].tolist() for key in ("cells", "seconds")}
    write_rows(file, HEAD, COLUMNS, {"problem": problem, "run": run}, "".join(rows))


def read_stored(file: Path) -> Stored:
    """Raises ReferenceError for a file that was changed."""
    try:
        header, cells, digest = read_rows(file, HEAD, COLUMNS)
        rows = np.array(cells, dtype=float)
        if not np.isfinite(rows).all():
            raise ValueError("it has values that are not finite")
        arrays = {key: np.array(value, dtype=float) for key, value in header["run"].items()}
        rows = rows.reshape(len(arrays["cells"]), -1, rows.shape[1])
        arrays |= {"times": rows[0, :, 1], "shear": rows[..., 2], "states": rows[..., 3:]}
    except (KeyError, OSError, ValueError) as error:
        raise ReferenceError(f"{file}: not a stored passage of a disc ({error}); make it again") from error
    return Stored(canonical(header["problem"]), arrays, digest)
