"""Pressures of moving_channel.py stored in data/: a CSV under a header with the scene and a checksum.

A row is what (wall, field or point), the phase in periods, and pressures in Pa: of the wall at the nodes in
x, of a field at those in x and, fastest, eta, of all points. The nodes are the Gauss-Lobatto points, degree
4, of the header's mesh lines.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.base import Array, ReferenceError, canonical
from reference.stored_rows import read_rows, write_rows

HEAD = (
    "# Pressure in Pa over one period by reference/moving_channel.py; nothing published. SI units.",
    "# Made by `python -m reference.moving_channel`; rows: reference/moving_channel_store.py.",
)
COLUMNS = "what,phase,pressure_pa..."
RUN = ("x_lines", "eta_lines", "points", "sizes", "changes", "seconds")
DIGITS = 5


@dataclass(frozen=True)
class Stored:
    identity: str  # of the scene's flow, canonical
    arrays: dict[str, Array]
    digest: str  # of the file


def _rows(arrays: dict[str, Array]) -> Iterator[str]:
    tables = {"wall": arrays["wall"], "field": arrays["fields"], "point": arrays["at_points"].T}
    for what, table in tables.items():
        for number, row in enumerate(table):
            values = ",".join(f"{value:.{DIGITS}g}" for value in row.ravel())
            if values:
                yield f"{what},{number / len(table):g},{values}\n"


def write_stored(file: Path, problem: dict[str, object], arrays: dict[str, Array]) -> None:
    """Raises ReferenceError where the file cannot be written."""
    header = {"problem": problem, "run": {key: arrays[key].tolist() for key in RUN}}
    write_rows(file, HEAD, COLUMNS, header, "".join(_rows(arrays)))


def read_stored(file: Path) -> Stored:
    """Raises ReferenceError for a file that was changed."""
    try:
        header, rows, digest = read_rows(file, HEAD, COLUMNS)
        arrays = {key: np.array(header["run"][key], dtype=float) for key in RUN}
        tables = {what: [row[2:] for row in rows if row[0] == what] for what in ("wall", "field", "point")}
        arrays["wall"] = np.array(tables["wall"], dtype=float)
        arrays["fields"] = np.array(tables["field"], dtype=float).reshape(
            len(tables["field"]), arrays["wall"].shape[1], -1
        )
        arrays["points"] = arrays["points"].reshape(-1, 2)
        shape = len(arrays["points"]), len(arrays["wall"])
        arrays["at_points"] = np.array(tables["point"], dtype=float).T.reshape(shape)
        if not all(np.isfinite(array).all() for array in arrays.values()):
            raise ValueError("it has values that are not finite")
    except (KeyError, OSError, ValueError) as error:
        raise ReferenceError(f"{file}: not a stored pressure ({error}); make it again") from error
    return Stored(canonical(header["problem"]), arrays, digest)
