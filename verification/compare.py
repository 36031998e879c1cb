"""The one comparer: metrics, the verdict on a check, and the observed order of convergence.

A check passes only if `isfinite(error) and error <= tolerance`, and, where a band is stated, the observed
order over the spacings lies inside it. Missing, short, NaN or non-monotonic data never become a number: they
raise DataError, whose text is the check's reason for failing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

EVERY = "*"
KINDS = ("exact", "finite-element", "published", "independent")
# A reference has to be ten times better than a tolerance of 1 %; issue 2 asks for 0.1 % of every one.
LARGEST_REFERENCE_ERROR = 1e-3
# Another method of ours is no truth: it only has to be good enough for its tolerances.
LARGEST_INDEPENDENT_ERROR = 2e-2

Array = NDArray[np.float64]


class DataError(ValueError):
    """Data that cannot be compared; the text is one line that says why."""


@dataclass(frozen=True)
class Curves:
    """Columns of a file of data/, each value v as offset + factor v."""

    file: str
    time: str  # the column of times, s
    columns: tuple[str, ...]
    offset: float = 0.0
    factor: float = 1.0


@dataclass(frozen=True)
class Check:
    """One check of one variant at one level, its choices by scheme, level and variant already made.

    What the result is held against is the one of these that is there: `data` (with `against` EVERY: `data`
    against all variants), `against`, `value`, `conserved`, `from_time`, `repeats`; otherwise the reference.
    """

    quantity: str
    # "particles", "wall:<probe>" (its last sample) or "wall:<probe>@<x>" (at x in m, over time),
    # "point:<probe>", "series", "run" (its attributes), "disc:<name>" or "derived"
    at: str
    field: str
    metric: str
    tolerance: float
    kind: str
    why: str
    order_band: tuple[float, float] | None = None
    order_floor: float = 0.0  # errors that are no larger at any spacing have nothing left to converge
    subtract_mean: bool = False
    time: float | None = None  # s; None: the end
    from_time: float | None = None  # s; series only: the start of the window
    against: str | None = None  # another variant, or EVERY variant
    known_shortfall: str | None = None
    reference: str = ""  # its name
    value: tuple[float, ...] = ()  # a number, or the two ends of a band
    source: str = ""  # of the value
    data: Curves | None = None  # published curves; more than one: the band between them
    conserved: bool = False  # every step's value against the one before
    repeats: float | None = None  # s; against the values that much earlier
    window: tuple[float, float] | None = None  # s; of a time series, instead of one time
    statistic: str | None = None  # that stands for the window, or the wall; see case.STATISTICS
    unit: str = ""  # of an absolute error
    stated_scale: float | None = None  # of an error that is relative to a number, in the field's unit
    reported: bool = False  # shown, but decides nothing

    @property
    def scale(self) -> str:
        stated = "none" if self.stated_scale is None else f"{self.stated_scale:g}"
        text = stated if self.metric == "largest_difference" else SCALES[self.metric]
        return text + (", means subtracted from both" if self.subtract_mean else "")


@dataclass
class CheckResult:
    """The measured side of a check. `tolerance` is None at coarser spacings, which serve the order only."""

    check: Check
    value: float
    tolerance: float | None
    source: str = ""
    order: float | None = None
    reason: str = ""

    @property
    def passed(self) -> bool:
        if self.reason or not math.isfinite(self.value):
            return False
        if self.tolerance is None:
            return True
        return self.value <= self.tolerance and in_band(self.order, self.check.order_band)

    @property
    def known_shortfall(self) -> bool:
        """True for a failure that checks.toml owns up to; a run that gave no number is never excused."""
        return bool(self.check.known_shortfall) and not self.passed and math.isfinite(self.value)

    @property
    def reported(self) -> bool:
        """True for a number that decides nothing, inside its tolerance or outside; without one it fails."""
        return self.check.reported and not self.reason and math.isfinite(self.value)

    def explanation(self) -> str:
        """Why the check fails, in one line; empty if it passes."""
        if self.passed:
            return ""
        if self.reason:
            return self.reason
        if not math.isfinite(self.value):
            return f"the error is {self.value}"
        parts = []
        if self.tolerance is not None and self.value > self.tolerance:
            parts.append(f"error {self.value:.3g} above tolerance {self.tolerance:.3g}")
        if not in_band(self.order, self.check.order_band):
            low, high = self.check.order_band or (math.nan, math.nan)
            measured = "unknown" if self.order is None else f"{self.order:.2f}"
            parts.append(f"observed order {measured} outside [{low:g}, {high:g}]")
        return "; ".join(parts)


def in_band(order: float | None, band: tuple[float, float] | None) -> bool:
    """Without a band any order will do; with one, an unknown or NaN order is outside."""
    return band is None or (order is not None and band[0] <= order <= band[1])


def require_series(name: str, values: ArrayLike, times: ArrayLike | None = None) -> Array:
    """Values as floats, refused when empty, not finite, or (with times) not one for each increasing time."""
    array = np.asarray(values, dtype=float)
    if array.size == 0:
        raise DataError(f"{name} holds no data")
    if not np.all(np.isfinite(array)):
        raise DataError(f"{name} holds {np.count_nonzero(~np.isfinite(array))} values that are not finite")
    if times is not None:
        stamps = require_series(f"the times of {name}", times)
        if len(stamps) != len(array):
            raise DataError(f"{name} has {len(array)} samples for {len(stamps)} times")
        if np.any(np.diff(stamps) <= 0):
            raise DataError(f"the times of {name} do not increase")
    return array


def _ratio(error: float, scale: float) -> float:
    if not scale > 0:
        raise DataError(f"the scale of the error is {scale:g}")
    return float(error / scale)


def relative_l1(measured: Array, reference: Array) -> float:
    lengths = [np.linalg.norm(a.reshape(len(a), -1), axis=1).sum() for a in (measured - reference, reference)]
    return _ratio(lengths[0], lengths[1])


def relative_l2(measured: Array, reference: Array) -> float:
    return _ratio(np.linalg.norm(measured - reference), np.linalg.norm(reference))


def relative_peak(measured: Array, reference: Array) -> float:
    lengths = [np.linalg.norm(a.reshape(len(a), -1), axis=1) for a in (measured - reference, reference)]
    return _ratio(np.sqrt(np.mean(lengths[0] ** 2)), lengths[1].max())


def relative_range(measured: Array, reference: Array) -> float:
    return _ratio(np.sqrt(np.mean((measured - reference) ** 2)), np.ptp(reference))


def relative_scalar(measured: Array, reference: Array) -> float:
    if measured.size != 1:
        raise DataError(f"relative_scalar compares single values, not {measured.size}")
    return _ratio(abs(measured - reference).item(), abs(reference).item())


def largest_deviation(measured: Array, reference: Array) -> float:
    return _ratio(np.abs(measured - reference).max(), np.abs(reference).max())


def largest_difference(measured: Array, reference: Array) -> float:
    return float(np.linalg.norm((measured - reference).reshape(len(measured), -1), axis=1).max())


METRICS: dict[str, Callable[[Array, Array], float]] = {
    "relative_l1": relative_l1,
    "relative_l2": relative_l2,
    "relative_peak": relative_peak,
    "relative_range": relative_range,
    "relative_scalar": relative_scalar,
    "largest_deviation": largest_deviation,
    "largest_difference": largest_difference,  # absolute: needs a unit, or a scale of its own
}
SCALES = {
    "relative_l1": "sum of the reference's magnitudes",
    "relative_l2": "L2 norm of the reference",
    "relative_peak": "largest magnitude of the reference at that time (root mean square error over it)",
    "relative_range": "the reference's largest value less its smallest (root mean square error over it)",
    "relative_scalar": "the reference's value",
    "largest_deviation": "largest magnitude of the reference",
}


def measure(check: Check, measured: ArrayLike, reference: ArrayLike) -> float:
    """The check's error; shapes (n,) or (n, 2), equal. Raises DataError for data that cannot be compared."""
    ours = np.atleast_1d(require_series("the result", measured))
    truth = np.atleast_1d(require_series("the reference", reference))
    if ours.shape != truth.shape:
        raise DataError(f"the result has shape {ours.shape}, the reference {truth.shape}")
    if check.subtract_mean:
        ours, truth = ours - ours.mean(axis=0), truth - truth.mean(axis=0)
    error = METRICS[check.metric](ours, truth)
    return error if check.stated_scale is None else _ratio(error, check.stated_scale)


def observed_order(spacings: Sequence[float], errors: Sequence[float]) -> float | None:
    """Slope of log error over log spacing by least squares; None with fewer than three usable points."""
    if len(spacings) < 3 or len(spacings) != len(errors):
        return None
    if not all(math.isfinite(e) and e > 0 for e in errors) or len(set(spacings)) != len(spacings):
        return None
    return float(np.polyfit(np.log(spacings), np.log(errors), 1)[0])


def require_reference_quality(error_estimate: float, kind: str = "exact", tolerance: float = 0.0) -> None:
    """Refuses a reference that has not shown itself to be within 0.1 % or a tenth of the tolerance, or within
    2 % for a check `independent`.
    """
    of_numbers = max(LARGEST_REFERENCE_ERROR, 0.1 * tolerance)
    limit = LARGEST_INDEPENDENT_ERROR if kind == "independent" else of_numbers
    if not error_estimate <= limit:
        raise DataError(f"the reference's own error is {error_estimate:.3g}, above {limit:g}")


def settled(times: Array, errors: Array, bound: float) -> float:
    """The time, s, of the first of the samples (n,) from which on no error (n,) exceeds the bound; NaN if the
    last one does, or is not finite.
    """
    beyond = np.nonzero(~(errors <= bound))[0]
    if len(beyond) == 0:
        return float(times[0])
    return float(times[beyond[-1] + 1]) if beyond[-1] + 1 < len(times) else float("nan")
