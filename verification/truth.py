"""From a run and what it is held against to the two arrays that a check compares, and its error."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from reference import Reference
from verification import curves
from verification.compare import Array, Check, DataError, measure, require_reference_quality
from verification.derived import DERIVED
from verification.measure import TIME_MATCH, Result

Series = tuple[Array, Array]  # times (n,) and values (n,) or (n, 2)


def peak(values: Array) -> float:
    """Where the largest of evenly spaced samples is, by a parabola, as a share of their window."""
    top = int(np.argmax(values))
    if not 0 < top < len(values) - 1:
        raise DataError("the largest value is at an end of the window")
    before, at, after = values[top - 1 : top + 2]
    return (top + 0.5 * (before - after) / (before - 2 * at + after)) / (len(values) - 1)


REDUCTIONS = {"min": np.min, "max": np.max, "mean": np.mean, "deviation": np.std, "peak": peak}


def error_of(
    check: Check, result: Result, reference: Reference | None = None, others: Sequence[Result] = ()
) -> float:
    """The check's error for one run; `others` are the runs of the variants that the check names, if any."""
    if check.against is not None and not others:
        raise DataError(f"nothing of variant {check.against} to compare with")
    if check.at == "particles":
        return measure(check, *_at_particles(check, result, reference))
    along = check.at.startswith("wall:") and "@" not in check.at  # else a place of the wall over time
    pair = _along_wall if along else _over_time
    measured, truth = pair(check, result, reference, others)
    if check.statistic:
        measured, truth = (reduced(check, values) for values in (measured, truth))
        check = dataclasses.replace(check, subtract_mean=False)  # of one value nothing would be left
    return measure(check, measured, truth)


def reduced(check: Check, values: Array) -> float:
    """The check's statistic of values (n,), less their mean where the check says so."""
    return float(REDUCTIONS[check.statistic](values - values.mean() if check.subtract_mean else values))


def trusted(reference: Reference | None, check: Check) -> Reference:
    if reference is None:
        raise DataError("there is no reference")
    require_reference_quality(reference.error_estimate, check.kind, check.tolerance)
    return reference


def of_disc(reference: Reference, name: str, field: str, times: Array) -> Array:
    """A disc's field (n,) or (n, 2) at times (n,); of vectors references know the whole only."""
    vector, _, axis = field.rpartition("_")
    if axis in ("x", "y"):
        return np.asarray(reference.disc(name, vector, times))[:, "xy".index(axis)]
    return np.asarray(reference.disc(name, field, times))


def _at_particles(check: Check, result: Result, reference: Reference | None) -> tuple[Array, Array]:
    particles = result.particles(check.time)
    values = getattr(particles, check.field)
    if check.value:
        return values, np.clip(values, min(check.value), max(check.value))
    field = getattr(trusted(reference, check), check.field)
    return values, field(particles.position[:, 0], particles.position[:, 1], particles.time)


def _along_wall(
    check: Check, result: Result, reference: Reference | None, others: Sequence[Result]
) -> tuple[Array, Array]:
    wall = check.at.removeprefix("wall:")
    mine = result.wall(wall)
    if not others:
        field = getattr(trusted(reference, check), f"wall_{check.field}")
        return getattr(mine, check.field), field(wall, mine.x, mine.time)
    theirs = others[0].wall(wall)
    if mine.x.shape != theirs.x.shape or not np.allclose(mine.x, theirs.x, rtol=1e-9, atol=0):
        raise DataError("the two variants' probes have different points")
    return getattr(mine, check.field), getattr(theirs, check.field)


def samples(result: Result, at: str, field: str) -> Series:
    """What a run has of a field over time: of the fluid, of a disc, derived, or the run's own numbers."""
    if at == "run":
        return np.array([result.end_time]), np.array([result.attribute(field)])
    if at.startswith("disc:"):
        return result.disc(at.removeprefix("disc:"), field)
    if at.startswith("wall:"):
        probe, _, x = at.removeprefix("wall:").partition("@")
        return result.wall_history(probe, field, float(x))
    if at.startswith("point:"):
        return result.point(at.removeprefix("point:"), field)
    if at == "derived":
        if field not in DERIVED:
            raise DataError(f"nothing derived is called {field}, only {', '.join(DERIVED)}")
        return DERIVED[field](result)
    return result.series(field)


def _over_time(
    check: Check, result: Result, reference: Reference | None, others: Sequence[Result]
) -> tuple[Array, Array]:
    series = samples(result, check.at, check.field)
    if check.data is not None:
        return _published(check, series, [samples(other, check.at, check.field) for other in others])
    if check.conserved:
        return _step_by_step(result, *series)
    times, values = _chosen(check, series, result.end_time)
    if check.value:
        return values, np.clip(values, min(check.value), max(check.value))
    if check.from_time is not None:
        return values, np.full_like(values, values[-1])
    if others:
        return values, _interpolated(samples(others[0], check.at, check.field), times)
    if check.repeats:
        return values, _interpolated(series, times - check.repeats)
    truth = trusted(reference, check)
    if check.at.startswith(("wall:", "point:")):
        return values, at_probe(truth, result, check.at, check.field, times)
    if check.at.startswith("disc:"):
        return values, of_disc(truth, check.at.removeprefix("disc:"), check.field, times)
    return values, np.array([getattr(truth, check.field)(time) for time in times])


def at_probe(reference: Reference, result: Result, at: str, field: str, times: Array) -> Array:
    """A reference's field (n,) at times (n,), at a place of a wall or where the scene has a point probe."""
    kind, _, place = at.partition(":")
    if kind == "wall":
        probe, _, x = place.partition("@")
        wall = _probe(result, probe)["wall"]
        values = [getattr(reference, f"wall_{field}")(wall, np.array([float(x)]), time) for time in times]
    else:
        x, y = _probe(result, place)["position"]
        values = [getattr(reference, field)(np.array([x]), np.array([y]), time) for time in times]
    return np.concatenate(values)


def _probe(result: Result, name: str) -> Mapping[str, Any]:
    found = [probe for probe in result.scene.get("probes", []) if probe["name"] == name]
    if not found:
        raise DataError(f"the scene has no probe {name}")
    return found[0]


def _published(check: Check, series: Series, ensemble: Sequence[Series]) -> tuple[Array, Array]:
    """The run at the curves' times against the band between them; or the curves against the ensemble's."""
    window = check.window or (series[0][0], series[0][-1])
    times, published = curves.within(check.data, window)
    if not ensemble:
        mine = _interpolated(series, times)
        return mine, curves.nearest_in_band(mine, published)
    members = np.stack([_interpolated(member, times) for member in ensemble], axis=1)
    truth = [curves.nearest_in_band(column, members) for column in published.T]
    return published.ravel(order="F"), np.concatenate(truth)


def _chosen(check: Check, series: Series, end_time: float) -> Series:
    """The samples of the check's window, or from its start on, or the one at its time (else the last)."""
    times, values = series
    margin = TIME_MATCH * end_time
    if check.window is None and check.from_time is None:
        wanted = times[-1] if check.time is None else check.time
        nearest = int(np.argmin(np.abs(times - wanted)))
        if not abs(times[nearest] - wanted) <= margin:
            raise DataError(
                f"{check.field} has no sample at {wanted:g} s, the nearest is at {times[nearest]:g} s"
            )
        return times[[nearest]], values[[nearest]]
    start, end = check.window or (check.from_time, times[-1])
    if end > times[-1] + margin or start < times[0] - margin:
        raise DataError(f"{check.field} does not reach from {start:g} s to {end:g} s")
    inside = (times >= start - margin * (check.window is not None)) & (times <= end + margin)
    if np.count_nonzero(inside) < 3:
        raise DataError(f"{check.field} has {np.count_nonzero(inside)} samples from {start:g} s to {end:g} s")
    return times[inside], values[inside]


def _interpolated(series: Series, times: Array) -> Array:
    """Linear between the samples; raises DataError outside of them. Scalar fields only."""
    stamps, values = series
    slack = 1e-9 * stamps[-1]
    if times[0] < stamps[0] - slack or times[-1] > stamps[-1] + slack:
        raise DataError(f"the run has nothing before {stamps[0]:g} s or after {stamps[-1]:g} s")
    if values.ndim != 1:
        raise DataError("only one part of a vector can be interpolated")
    return np.interp(times, stamps, values)


def _step_by_step(result: Result, times: Array, values: Array) -> tuple[Array, Array]:
    """Every step's value and the one before it."""
    steps = int(result.attribute("steps"))
    if len(times) != steps + 1:
        raise DataError(f"{len(times)} samples of {steps} steps: each step must be one")
    return values[1:], values[:-1]
