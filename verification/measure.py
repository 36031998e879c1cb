"""From a run's result.h5 and its reference to the two arrays that a check compares.

Everything that is not there, too short, out of order or not finite raises DataError with a reason.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from reference import Reference
from verification.compare import (
    Array,
    Check,
    DataError,
    measure,
    require_reference_quality,
    require_series,
)

# A sample stands for a wanted time when it is within this share of the end time. The reference is taken at
# the sample's own time: this only tells a run that ended early from one whose step does not divide the time.
TIME_MATCH = 1e-3


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


class Result:
    """Reads one result.h5 and refuses a run that did not reach `end_time` (of the scene, not of the file)."""

    def __init__(self, path: Path, end_time: float) -> None:
        self.path = path
        self.end_time = end_time

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

    def particles(self, time: float | None = None) -> Particles:
        wanted = self.end_time if time is None else time
        with self._open() as file:
            snapshots = _group(file, "snapshots")
            stamps = require_series(
                "the snapshots", [snapshots[n].attrs.get("time", np.nan) for n in snapshots]
            )
            if np.any(np.diff(stamps) <= 0):
                raise DataError("the times of the snapshots do not increase")
            index = int(np.argmin(np.abs(stamps - wanted)))
            self._near(stamps[index], wanted, f"snapshot {index}")
            snapshot = snapshots[list(snapshots)[index]]
            fluid = _dataset(snapshot, "wall") < 0
            expected = int(_group(file, "run").attrs.get("fluid_particles", -1))
            if np.count_nonzero(fluid) != expected:
                raise DataError(
                    f"snapshot {index} holds {np.count_nonzero(fluid)} of {expected} fluid particles"
                )
            columns = [
                require_series(f"{name} of the particles", _dataset(snapshot, name)[fluid])
                for name in ("position_x", "position_y", "velocity_x", "velocity_y", "pressure")
            ]
            return Particles(
                float(stamps[index]), np.stack(columns[:2], 1), np.stack(columns[2:4], 1), columns[4]
            )

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

    def series(self, name: str) -> tuple[Array, Array]:
        """Times and values of a time series over the whole run."""
        with self._open() as file:
            times = _dataset(_group(file, "series"), "time")
            values = require_series(f"series {name}", _dataset(_group(file, "series"), name), times)
        if len(times) < 2:
            raise DataError(f"series {name} has a single sample")
        self._near(times[-1], self.end_time, f"the last sample of series {name}")
        return times, values


def _group(parent: h5py.Group, name: str) -> h5py.Group:
    if not isinstance(parent.get(name), h5py.Group):
        raise DataError(f"the result has no {name}")
    return parent[name]


def _dataset(parent: h5py.Group, name: str) -> Array:
    if not isinstance(parent.get(name), h5py.Dataset):
        raise DataError(f"the result has no {parent.name.lstrip('/')}/{name}")
    return np.atleast_1d(parent[name][()])


def wall_name(at: str) -> str:
    return at.removeprefix("wall:")


def error_of(check: Check, result: Result, reference: Reference | None, other: Result | None = None) -> float:
    """The check's error for one run; `other` is the run of the variant that the check names, if it does."""
    if check.at == "series":
        return measure(check, *_series_pair(check, result, reference))
    if check.against is not None:
        if other is None or not check.at.startswith("wall:"):
            raise DataError(f"nothing of variant {check.against} to compare with")
        mine, theirs = (run.wall(wall_name(check.at)) for run in (result, other))
        if mine.x.shape != theirs.x.shape or not np.allclose(mine.x, theirs.x, rtol=1e-9, atol=0):
            raise DataError("the two variants' probes have different points")
        return measure(check, getattr(mine, check.field), getattr(theirs, check.field))
    if reference is None:
        raise DataError("there is no reference")
    require_reference_quality(reference.error_estimate)
    if check.at == "particles":
        particles = result.particles(check.time)
        field = getattr(reference, check.field)
        truth = field(particles.position[:, 0], particles.position[:, 1], particles.time)
        return measure(check, getattr(particles, check.field), truth)
    wall = wall_name(check.at)
    sample = result.wall(wall)
    truth = getattr(reference, f"wall_{check.field}")(wall, sample.x, sample.time)
    return measure(check, getattr(sample, check.field), truth)


def _series_pair(check: Check, result: Result, reference: Reference | None) -> tuple[Array, Array]:
    times, values = result.series(check.field)
    if check.from_time is not None:  # against its own final value
        window = values[times >= check.from_time]
        if len(window) < 3:
            raise DataError(f"series {check.field} has {len(window)} samples from {check.from_time:g} s on")
        return window, np.full_like(window, window[-1])
    if reference is None:
        raise DataError("there is no reference")
    require_reference_quality(reference.error_estimate)
    return values[-1:], np.atleast_1d(getattr(reference, check.field)(times[-1]))
