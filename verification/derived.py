"""Quantities over time that no dataset of a result holds: of discs, with the fluid or alone, or of a wall.

Each takes a Result and returns times (n,) and values, or raises DataError.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from verification.budgets import BUDGETS
from verification.compare import Array, DataError
from verification.measure import Result
from verification.phases import PHASES, phases

Series = tuple[Array, Array]


def momentum(result: Result) -> Series:
    """Linear momentum of fluid and discs together (n, 2), kg/s."""
    times, x = result.series("momentum_x")
    total = np.stack([x, result.series("momentum_y")[1]], axis=1)
    for name in result.disc_names():
        stamps, velocity = result.disc(name, "velocity")
        if not np.array_equal(stamps, times):
            raise DataError("the discs and the fluid are not sampled at the same times")
        total = total + result.disc_constant(name, "mass") * velocity
    return times, total


def _pair(result: Result) -> tuple[str, str]:
    names = result.disc_names()
    if len(names) != 2:
        raise DataError(f"a pair is two discs, not {len(names)}")
    return names[0], names[1]


def gap(result: Result) -> Series:
    """Distance between the rims of the scene's two discs (n,), m."""
    first, second = _pair(result)
    times, position = result.disc(first, "position")
    apart = np.linalg.norm(position - result.disc(second, "position")[1], axis=1)
    return times, apart - sum(result.disc_constant(name, "radius") for name in (first, second))


def phases_missing(result: Result) -> Series:
    """How many of drafting, kissing, tumbling and separation do not follow one another (1,)."""
    first, second = _pair(result)
    times, leading = result.disc(first, "position")
    trailing = result.disc(second, "position")[1]
    diameter = sum(result.disc_constant(name, "radius") for name in (first, second))
    found = phases(times, leading, trailing, diameter)
    return times[-1:], np.array([float(len(PHASES) - len(found))])


def _array(result: Result) -> tuple[float, float, str]:
    """Of a periodic array driven along x by a body force: area of a cell in m2, rho f in N/m3, disc."""
    scene = result.scene
    names = result.disc_names()
    if scene["domain"].get("periodic") != "xy" or len(names) != 1:
        raise DataError("an array is one disc in a domain periodic in x and y")
    width, height = np.subtract(scene["domain"]["upper"], scene["domain"]["lower"])
    return float(width * height), scene["fluid"]["density"] * scene["fluid"]["body_force"][0], names[0]


def array_drag(result: Result) -> Series:
    """F / (mu U) of a fixed array (n,): F the body force on a whole cell, for the mean pressure gradient acts
    on the disc as well, U the flux over a cell's width, the disc at rest included.
    """
    area, force, _ = _array(result)
    times, flow = result.series("momentum_x")
    speed = flow / (result.scene["fluid"]["density"] * area)
    moving = np.where(speed > 0, speed, math.inf)  # at rest, at the start, there is no such number
    return times, force * area / (result.scene["fluid"]["dynamic_viscosity"] * moving)


def array_balance(result: Result) -> Series:
    """The force measured on the disc of an array and its share of the mean pressure gradient, over F (n,)."""
    area, force, name = _array(result)
    times, measured = result.disc(name, "force_x")
    own = math.pi * result.disc_constant(name, "radius") ** 2
    return times, (measured + force * own) / (force * area)


def greatest_wafer_shear(result: Result) -> Series:
    """The greatest |shear| along the wafer (n,), Pa, at every sample of the probe "wafer"."""
    times, _, shear = result.wall_samples("wafer", "shear")
    return times, np.abs(shear).max(axis=1)


DERIVED: dict[str, Callable[[Result], Series]] = {
    "momentum": momentum,
    "gap": gap,
    "phases_missing": phases_missing,
    "array_drag": array_drag,
    "array_balance": array_balance,
    "greatest_wafer_shear": greatest_wafer_shear,
    **BUDGETS,
}
