"""Published curves: columns of the CSV files in data/, one row a time; blank: outside of a curve."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from verification.compare import Array, Curves, DataError, require_series

FOLDER = Path(__file__).resolve().parent.parent / "data"


def read(curves: Curves, folder: Path = FOLDER) -> tuple[Array, Array]:
    """Times (n,) in s and values (n, columns) as the file has them, transformed; NaN where a cell is blank.

    Raises DataError for a file that cannot be read, a column that is not there or times out of order.
    """
    try:
        lines = (folder / curves.file).read_text(encoding="utf-8").splitlines()
        rows = list(csv.DictReader(line for line in lines if line.strip() and not line.startswith("#")))
        table = [[float(row[name] or "nan") for name in (curves.time, *curves.columns)] for row in rows]
    except (OSError, TypeError, ValueError) as error:
        raise DataError(f"{curves.file} cannot be read: {error}") from error
    except KeyError as error:
        raise DataError(f"{curves.file} has no column {error}") from error
    values = np.array(table).reshape(-1, 1 + len(curves.columns))
    times = require_series(f"the times of {curves.file}", values[:, 0], values[:, 0])
    return times, curves.offset + curves.factor * values[:, 1:]


def within(curves: Curves, window: tuple[float, float], folder: Path = FOLDER) -> tuple[Array, Array]:
    """The rows of the window; raises DataError unless they fill it and no curve has a blank there."""
    times, values = read(curves, folder)
    inside = (times >= window[0]) & (times <= window[1])
    margin = np.diff(times).max(initial=0.0)  # a window may start or end between two rows
    if not np.any(inside) or times[inside][0] > window[0] + margin or times[inside][-1] < window[1] - margin:
        raise DataError(f"{curves.file} does not reach from {window[0]:g} s to {window[1]:g} s")
    return times[inside], require_series(f"{', '.join(curves.columns)} of {curves.file}", values[inside])


def nearest_in_band(values: Array, curves: Array) -> Array:
    """For each value (n,) the nearest one between the least and the greatest of curves (n, k)."""
    return np.clip(values, curves.min(axis=1), curves.max(axis=1))
