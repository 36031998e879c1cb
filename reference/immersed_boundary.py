"""Rigid discs that move in a box of fluid at rest at the start, by an immersed-boundary method.

Equations and discretisation: immersed_boundary_flow.py (fluid), immersed_boundary_discs.py (rims and Newton's
law), immersed_boundary_run.py (resolution, steps, contact).

Own convergence: three grids, SHARES the shares of the finest's cells along an axis. With f(h) = f0 + C h^p
for each quantity, p from the largest changes from grid to grid and held between 1 and 2, the result is f0,
and the largest |f0 - f| of the finest grid is the error estimate: positions over the largest displacement,
velocities over the largest speed, angle and spin likewise times the radius. This holds until discs, or a disc
and a wall, first come closer than CLEARANCE diameters on any grid (`until`); after that `disc` is NaN, so
that a check fails and a plot ends. `finest` goes on to `end`, on the finest grid alone, for pictures: what
follows contact depends on its model and amplifies disturbances.

The grids that such an estimate needs take minutes, too long for `make verify`. What its cases need is
therefore stored as computed, every grid of it, in data/immersed_boundary_*.csv, by
    python -m reference.immersed_boundary SCENE --end SECONDS --name NAME
and recognised by the physics in its header (immersed_boundary_store.py). A test runs the coarsest grid again
and must find the same. Other scenes are computed when asked for and kept in the cache.

verification/disc_settling to 0.65 s and disc_pair to `until` = 0.164 s, distances from f0:
                  disc_settling                      disc_pair
        cells  position  velocity     position  velocity     angle      spin
    128 x 384   4.9e-03   5.0e-03      1.7e-02   4.9e-02   6.2e-04   2.5e-03
    192 x 576   3.7e-03   3.8e-03      4.4e-03   2.0e-02   5.4e-04   3.9e-03
    256 x 768   2.7e-03   2.9e-03      2.5e-03   1.1e-02   3.2e-04   2.9e-03
        order       1.0       1.0          2.0       2.0       1.8       1.0
The greatest fall speed of the one is 0.0559 m/s. The pair's heights leave the band of the three published
curves by 2e-5 m at most up to 0.14 s, and the finest grid is within 2e-5 m and 1.1e-3 m/s of f0 there.
"""

import argparse
import math
import sys
import time
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from reference import base, immersed_boundary_discs, immersed_boundary_flow, immersed_boundary_run
from reference import scene as scenes
from reference.base import Array, ReferenceError, cache_file, digest_of, read_arrays, write_arrays
from reference.extrapolation import extrapolated
from reference.immersed_boundary_discs import Contact, Disc
from reference.immersed_boundary_run import Problem, run
from reference.immersed_boundary_store import read_stored, write_stored
from reference.scene import Scene

NAME = "immersed_boundary"
MODULES = (base, scenes, immersed_boundary_flow, immersed_boundary_discs, immersed_boundary_run)
SCRIPTS = tuple(Path(module.__file__) for module in MODULES)
DATA = Path(__file__).resolve().parents[1] / "data"
SHARES = (0.5, 0.75, 1.0)
CLEARANCE = 0.25
SAMPLES = 200
FEWEST_SAMPLES = 4  # for cubics
GROUPS = {"position": slice(0, 2), "angle": slice(2, 3), "velocity": slice(3, 5), "spin": slice(5, 6)}
QUANTITIES = {
    "position": slice(0, 2), "position_x": 0, "position_y": 1, "angle": 2,
    "velocity": slice(3, 5), "velocity_x": 3, "velocity_y": 4, "spin": 5,
}  # fmt: skip


def problem_of(scene: Scene) -> tuple[Problem, list[int]]:
    """The problem, its discs sorted by position, and which of them each disc of the scene is."""
    if not scene.discs or scene.dry:
        raise scene.refuse(f"{NAME} needs discs and fluid")
    if scene.body_force != (0.0, 0.0) or scene.start_velocity != "rest":
        raise scene.refuse(f"{NAME} needs a fluid at rest at the start, and no body force but gravity")
    periodic = ("x" in scene.periodic, "y" in scene.periodic)
    _check_walls(scene, periodic)
    order = sorted(range(len(scene.discs)), key=lambda i: scene.discs[i].position)
    discs = [
        Disc(
            disc.radius,
            disc.density,
            (disc.position[0] - scene.lower[0], disc.position[1] - scene.lower[1]),
            disc.velocity,
            disc.spin,
            disc.motion == "free",
        )
        for disc in (scene.discs[i] for i in order)
    ]
    fluid = (scene.density, scene.kinematic_viscosity, scene.gravity)
    problem = Problem(scene.size, periodic, *fluid, tuple(discs))
    if scene.end_time <= 0:
        raise scene.refuse(f"{NAME} needs an output.end_time")
    if problem.speed() == 0:
        raise scene.refuse(f"{NAME}: nothing moves: no disc has weight in the fluid or a velocity")
    return problem, [order.index(i) for i in range(len(order))]


def _check_walls(scene: Scene, periodic: tuple[bool, bool]) -> None:
    """Every side that is not periodic must be one wall at rest."""
    (left, bottom), (right, top) = scene.lower, scene.upper
    sides = [{(left, bottom), (left, top)}, {(right, bottom), (right, top)}] * (not periodic[0])
    sides += [{(left, bottom), (right, bottom)}, {(left, top), (right, top)}] * (not periodic[1])
    for wall in scene.walls:
        ends = {wall.parameters.get("from"), wall.parameters.get("to")}
        if wall.shape != "line" or wall.velocity != (0.0, 0.0) or ends not in sides:
            raise scene.refuse(
                f"walls.{wall.name}: {NAME} needs walls at rest that are whole sides of the domain"
            )
        sides.remove(ends)
    if sides:
        raise scene.refuse(f"{NAME}: {len(sides)} side(s) of the domain neither periodic nor a wall")


def solve(problem: Problem, end: float) -> dict[str, Array]:
    """Runs every grid, the coarsest first, to `end` (s)."""
    started = time.perf_counter()
    times = np.linspace(0, end, SAMPLES + 1)
    grids = [problem.grid(share) for share in SHARES]
    runs = [run(problem, grid, times) for grid in grids]
    return {
        "times": times,
        "states": np.array([states for states, _ in runs]),
        "cells": np.array([grid.cells for grid in grids]),
        "touched": np.array([min(touched, 2 * end) for _, touched in runs]),  # after the end: never
        "seconds": np.array(time.perf_counter() - started),
    }


class ImmersedBoundary:
    kind = "immersed-boundary"
    source = "discs by direct forcing on a staggered grid (uhlmann2005, breugem2012), three grids"

    def __init__(
        self, scene: Scene, problem: Problem, order: list[int], digest: str, arrays: dict[str, Array]
    ):
        self.scene, self.problem, self.digest = scene, problem, digest
        self.order = {disc.name: place for disc, place in zip(scene.discs, order, strict=True)}
        self.seconds, self.cells, self.touched = float(arrays["seconds"]), arrays["cells"], arrays["touched"]
        self.times, self.end = arrays["times"], float(arrays["times"][-1])
        self.shift = np.array([*scene.lower, 0, 0, 0, 0])
        self.states = arrays["states"] + self.shift
        before = self.times < self._near()
        if np.count_nonzero(before) < FEWEST_SAMPLES:
            raise scene.refuse(
                f"{NAME}: discs and walls are closer than {CLEARANCE:g} diameters from the start"
            )
        self.until = float(self.times[before][-1])
        self.extrapolated = np.full_like(self.states[-1], np.nan)
        self.errors, self.orders = {}, {}
        spacings = self.cells[-1, 0] / self.cells[:, 0]
        for name, part in GROUPS.items():
            values, self.orders[name], error = extrapolated(self.states[:, before][..., part], spacings)
            self.extrapolated[before, :, part] = values
            self.errors[name] = error / self._scale(name)
        self.error_estimate = max(self.errors.values())

    def _near(self) -> float:
        """The first sample at which a gap is below CLEARANCE diameters on some grid, infinite if none."""
        radii = np.array([disc.radius for disc in self.problem.discs])
        contact = Contact(radii, self.problem.grid(1.0), 2 * CLEARANCE * radii.min(), 1.0)
        for number, time_now in enumerate(self.times):
            if any(contact.forces(states[number] - self.shift).any() for states in self.states):
                return float(time_now)
        return math.inf

    def _scale(self, group: str) -> float:
        """What an error of the group is divided by."""
        radius = min(disc.radius for disc in self.problem.discs)
        finest = self.states[-1][self.times <= self.until]
        if group in ("position", "angle"):
            moved, turned = finest[:, :, :2] - finest[0, :, :2], finest[:, :, 2]
        else:
            moved, turned = finest[:, :, 3:5], finest[:, :, 5]
        largest = max(np.linalg.norm(moved, axis=2).max(), np.abs(turned).max() * radius)
        return float(largest) / (radius if group in ("angle", "spin") else 1)

    def disc(self, name: str, quantity: str, t: Array) -> Array:
        """A disc's quantity at times t (n,), s; NaN after `until`.

        position (n, 2), position_x, position_y, m; angle, rad; velocity (n, 2), velocity_x, velocity_y, m/s;
        spin, rad/s.
        """
        known = self.times <= self.until
        return self._at(name, quantity, t, self.times[known], self.extrapolated[known])

    def finest(self, name: str, quantity: str, t: Array) -> Array:
        """The same on the finest grid alone, NaN after `end`."""
        return self._at(name, quantity, t, self.times, self.states[-1])

    def _at(self, name: str, quantity: str, t: Array, times: Array, states: Array) -> Array:
        if name not in self.order or quantity not in QUANTITIES:
            known = f"{', '.join(QUANTITIES)} of {', '.join(self.order)}"
            raise self.scene.refuse(f"{NAME} knows {known}; not {quantity} of {name}")
        own = states[:, self.order[name]]
        place = CubicHermiteSpline(times, own[:, :3], own[:, 3:])
        parts = np.hstack((place(t), CubicSpline(times, own[:, 3:])(t)))
        parts[~((np.asarray(t) >= 0) & (np.asarray(t) <= times[-1] * (1 + 1e-9)))] = np.nan
        return parts[:, QUANTITIES[quantity]]

    def error_table(self) -> str:
        """The convergence of the grids, as text."""
        rows = ["     cells  " + "".join(f"{name:>12}" for name in GROUPS)]
        known = self.times <= self.until
        for number, cells in enumerate(self.cells):
            line = [f"{cells[0]:5.0f} x{cells[1]:5.0f}"]
            for name, part in GROUPS.items():
                error = self.states[number][known][..., part] - self.extrapolated[known][..., part]
                line.append(f"{np.abs(error).max() / self._scale(name):12.1e}")
            rows.append("".join(line))
        rows.append(f"{'order':>12}" + "".join(f"{order:12.1f}" for order in self.orders.values()))
        touched = [f"{t:.4g} s" if t <= self.end else "none" for t in self.touched]
        return "\n".join([*rows, f"first contact: {', '.join(touched)}"])


def create(scene: Scene, cache: Path) -> ImmersedBoundary:
    problem, order = problem_of(scene)
    identity = problem.identity()
    for file in sorted(DATA.glob(f"{NAME}_*.csv")):
        stored = read_stored(file)
        if stored.identity == identity:
            found = ImmersedBoundary(scene, problem, order, stored.digest, stored.arrays)
            if found.until < found.end or found.end >= scene.end_time:
                return found
    asked = {**identity, "end_time": scene.end_time}
    digest = digest_of(NAME, asked, (*SCRIPTS, Path(__file__)))
    file = cache_file(cache, NAME, digest)
    if file.exists():
        arrays = read_arrays(file, digest, asked)
    else:
        arrays = solve(problem, scene.end_time)
        write_arrays(file, digest, asked, arrays)
    return ImmersedBoundary(scene, problem, order, digest, arrays)


def main() -> int:
    parser = argparse.ArgumentParser(
        prog=f"python -m reference.{NAME}", description="Stores the motion of a scene's discs in data/."
    )
    parser.add_argument("scene", type=Path)
    parser.add_argument("--end", type=float, help="s; default: the scene's end_time")
    parser.add_argument("--name", required=True, help=f"the file is data/{NAME}_NAME.csv")
    arguments = parser.parse_args()
    try:
        scene = scenes.read_scene(arguments.scene, {})
        problem, order = problem_of(scene)
        arrays = solve(problem, arguments.end or scene.end_time)
        write_stored(DATA / f"{NAME}_{arguments.name}.csv", problem, arrays)
        print(ImmersedBoundary(scene, problem, order, "", arrays).error_table())
    except ReferenceError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
