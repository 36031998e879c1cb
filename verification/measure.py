"""What a run left behind: its result.h5, read with distrust.

Everything that is not there, too short, out of order or not finite raises DataError with a reason.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from verification.compare import Array, DataError, require_series

# A sample stands for a wanted time when it is within this share of the end time. The reference is taken at
# the sample's own time: this only tells a run that ended early from one whose step does not divide the time.
TIME_MATCH = 1e-3
# What a run leaves that did not end, or has not yet; one that ends well removes them.
UNENDED = {
    "failed.h5": "the last run there failed",
    "checkpoint.h5": "the last run there was interrupted, or is still going",
    "result.h5.partial": "the last run there was killed, or is still going",
}
COLUMNS = ("position_x", "position_y", "velocity_x", "velocity_y", "pressure")  # of a snapshot that are read


@dataclass(frozen=True)
class Particles:
    """The fluid particles of one snapshot."""

    time: float
    position: Array  # (n, 2) m
    velocity: Array  # (n, 2) m/s
    pressure: Array  # (n,) Pa


@dataclass(frozen=True)
class WallSample:
    """Pressure and shear along a wall at one time, at x where the wall stood at time 0."""

    time: float
    x: Array
    pressure: Array
    shear: Array


class Columns(dict[str, Array]):
    """The datasets of a group by name, and their units; one that is not there raises DataError."""

    def __init__(self, group: str) -> None:
        super().__init__()
        self.group = group
        self.units: dict[str, str] = {}

    def __missing__(self, name: str) -> Array:
        raise DataError(f"the result has no {self.group}/{name}")


class Result:
    """Reads one result.h5 and refuses a run that did not reach `end_time`. That and `scene` are the case's,
    not the file's: what the solver was told beside the case must not go unnoticed.
    """

    def __init__(self, path: Path, end_time: float, scene: Mapping[str, Any] | None = None) -> None:
        self.path = path
        self.end_time = end_time
        self.scene = scene or {}

    def _open(self) -> h5py.File:
        try:
            return h5py.File(self.path, "r")
        except OSError as error:
            raise DataError(f"{self.path.name} cannot be read: {error}") from error

    def _near(self, time: float, wanted: float, what: str) -> None:
        if not abs(time - wanted) <= TIME_MATCH * self.end_time:
            raise DataError(f"{what} is at {time:g} s, wanted {wanted:g} s")

    def attributes(self) -> dict[str, float]:
        with self._open() as file:
            return {name: float(value) for name, value in _group(file, "run").attrs.items()}

    def attribute(self, name: str) -> float:
        attributes = self.attributes()
        if name not in attributes:
            raise DataError(f"the result says nothing of {name}")
        return attributes[name]

    def snapshot_times(self) -> Array:
        with self._open() as file:
            snapshots = _group(file, "snapshots")
            times = [snapshots[name].attrs.get("time", np.nan) for name in snapshots]
        return require_series("the snapshots", times, times)

    def particles(self, time: float | None = None) -> Particles:
        wanted = self.end_time if time is None else time
        stamps = self.snapshot_times()
        index = int(np.argmin(np.abs(stamps - wanted)))
        self._near(stamps[index], wanted, f"snapshot {index}")
        particles, _ = self._snapshot(index, stamps[index])
        expected = int(self.attributes().get("fluid_particles", -1))
        if len(particles.position) != expected:
            raise DataError(f"snapshot {index} holds {len(particles.position)} of {expected} fluid particles")
        columns = np.column_stack([particles.position, particles.velocity, particles.pressure]).T
        for name, values in zip(COLUMNS, columns, strict=True):
            require_series(f"{name} of the particles", values)
        return particles

    def snapshot(self, time: float) -> tuple[Particles, Array]:
        """The fluid as it stands at the snapshot nearest to `time`, with what is not finite, and the places
        (n, 2) in m of the walls' particles.
        """
        stamps = self.snapshot_times()
        index = int(np.argmin(np.abs(stamps - time)))
        return self._snapshot(index, stamps[index])

    def _snapshot(self, index: int, time: float) -> tuple[Particles, Array]:
        with self._open() as file:
            snapshots = _group(file, "snapshots")
            snapshot = snapshots[list(snapshots)[index]]
            owner = _dataset(snapshot, "wall")
            columns = [_dataset(snapshot, name) for name in COLUMNS]
        if any(column.shape != owner.shape for column in columns):
            raise DataError(f"snapshot {index} has not one {', '.join(COLUMNS)} for each particle")
        fluid, wall = owner < 0, (owner >= 0) & (owner < len(self.scene.get("walls", [])))  # then come discs
        values = np.array(columns, dtype=float).T
        particles = Particles(float(time), values[fluid, :2], values[fluid, 2:4], values[fluid, 4])
        return particles, values[wall, :2]

    def holds(self, group: str) -> bool:
        with self._open() as file:
            return isinstance(file.get(group), h5py.Group)

    def columns(self, group: str) -> Columns:
        """Every dataset of a group as it stands: with NaN, where a probe found nothing."""
        found = Columns(group)
        with self._open() as file:
            for name, dataset in _group(file, group).items():
                found[name] = np.atleast_1d(dataset[()]).astype(float)
                found.units[name] = str(dataset.attrs.get("unit", "1"))
        return found

    def wall(self, probe: str) -> WallSample:
        """The probe's last sample."""
        with self._open() as file:
            group = _group(file, f"probes/{probe}")
            times = _dataset(group, "time")
            pressure, shear = (
                require_series(f"{name} of probe {probe}", _dataset(group, name), times)
                for name in ("pressure", "shear")
            )
            self._near(times[-1], self.end_time, f"the last sample of probe {probe}")
            x = require_series(f"x of probe {probe}", _dataset(group, "x"))
            return WallSample(float(times[-1]), x, pressure[-1], shear[-1])

    def wall_samples(self, probe: str, field: str) -> tuple[Array, Array, Array]:
        """Times (t,), x (n,) in m at time 0, and a field (t, n) of a wall probe."""
        with self._open() as file:
            group = _group(file, f"probes/{probe}")
            times, along = _dataset(group, "time"), require_series("x", _dataset(group, "x"))
            values = require_series(f"{field} of probe {probe}", _dataset(group, field), times)
        if values.shape[1:] != along.shape or np.any(np.diff(along) <= 0):
            raise DataError(f"probe {probe} has not one {field} for each x")
        self._near(times[-1], self.end_time, f"the last sample of probe {probe}")
        return times, along, values

    def wall_history(self, probe: str, field: str, x: float) -> tuple[Array, Array]:
        """Times and a field of a wall probe at x (m, at time 0), linear between the probe's points."""
        times, along, values = self.wall_samples(probe, field)
        if not along[0] <= x <= along[-1]:
            raise DataError(f"probe {probe} does not reach to x = {x:g} m")
        return times, np.array([np.interp(x, along, row) for row in values])

    def point(self, probe: str, field: str) -> tuple[Array, Array]:
        """Times and a field of a point probe."""
        with self._open() as file:
            group = _group(file, f"probes/{probe}")
            times = _dataset(group, "time")
            values = require_series(f"{field} of probe {probe}", _dataset(group, field), times)
        self._near(times[-1], self.end_time, f"the last sample of probe {probe}")
        return times, values

    def series(self, name: str) -> tuple[Array, Array]:
        """Times and values of a time series over the whole run."""
        with self._open() as file:
            times = _dataset(_group(file, "series"), "time")
            values = require_series(f"series {name}", _dataset(_group(file, "series"), name), times)
        if len(times) < 2:
            raise DataError(f"series {name} has a single sample")
        self._near(times[-1], self.end_time, f"the last sample of series {name}")
        return times, values

    def disc_names(self) -> list[str]:
        with self._open() as file:
            return str(_group(file, "discs").attrs.get("names", "")).split(",")

    def disc(self, name: str, field: str) -> tuple[Array, Array]:
        """Times (n,) and one disc's values (n,) of a field, or (n, 2) of one that has parts _x and _y."""
        names = self.disc_names()
        if name not in names:
            raise DataError(f"the result has no disc {name}, only {', '.join(names)}")
        with self._open() as file:
            group = _group(file, "discs")
            times = _dataset(group, "time")
            parts = [field] if field in group else [f"{field}_x", f"{field}_y"]
            columns = [_dataset(group, part) for part in parts]
        if any(column.ndim != 2 or column.shape[1] != len(names) for column in columns):
            raise DataError(f"{field} of the discs is not one column for each of {len(names)} discs")
        values = np.stack([column[:, names.index(name)] for column in columns], axis=1)
        values = require_series(f"{field} of disc {name}", values, times)
        self._near(times[-1], self.end_time, f"the last sample of disc {name}")
        return times, values[:, 0] if len(parts) == 1 else values

    def disc_constant(self, name: str, field: str) -> float:
        """radius (m), mass (kg/m), moment_of_inertia (kg m) or density (kg/m3) of a disc."""
        names = self.disc_names()
        with self._open() as file:
            values = require_series(f"{field} of the discs", _dataset(_group(file, "discs"), field))
        if name not in names or len(values) != len(names):
            raise DataError(f"the result has no {field} of disc {name}")
        return float(values[names.index(name)])


def open_run(run: Path) -> Result:
    """The result of a run, by its folder or its file, with the scene that it says it is of."""
    path = run / "result.h5" if run.is_dir() else run
    if not path.is_file():
        hint = "; a run that failed is in failed.h5" if (run / "failed.h5").exists() else ""
        raise DataError(f"there is no {path}: give the folder that `slurry run` wrote{hint}")
    try:
        with h5py.File(path, "r") as file:
            scene = tomllib.loads(str(file.attrs["scene"]))
        return Result(path, scene["output"]["end_time"], scene)
    except (OSError, RuntimeError, KeyError, tomllib.TOMLDecodeError) as error:
        raise DataError(f"{path} is not the result of a run: {error}") from error


def unended_since(path: Path) -> list[str]:
    """What says that a run after that of `path` did not end, so that `path` is not of the last run."""
    found = []
    for name, meaning in UNENDED.items():
        other = path.with_name(name)
        if other.exists() and other.stat().st_mtime_ns > path.stat().st_mtime_ns:
            found.append(f"{other} is newer than {path.name}: {meaning}; {path.name} is of an earlier run")
    return found


def _group(parent: h5py.Group, name: str) -> h5py.Group:
    if not isinstance(parent.get(name), h5py.Group):
        raise DataError(f"the result has no {name}")
    return parent[name]


def _dataset(parent: h5py.Group, name: str) -> Array:
    if not isinstance(parent.get(name), h5py.Dataset):
        raise DataError(f"the result has no {parent.name.lstrip('/')}/{name}")
    return np.atleast_1d(parent[name][()])
