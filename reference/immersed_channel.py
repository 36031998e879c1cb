"""A disc carried through a channel under a moving wafer, and the greatest shear on that wafer over time.

The immersed-boundary method of immersed_boundary.py, with the pad as a wall immersed in the grid.

Equations and discretisation: immersed_boundary_flow.py (fluid), immersed_boundary_discs.py (disc),
immersed_channel_run.py (walls, samples). Fluid and disc start at rest.

Own convergence: three grids, SHARES the shares of the finest's cells along an axis, extrapolated as in
immersed_boundary.py. The error estimate is the largest change from the finest grid to the result: of the
disc's place over its largest displacement, of its velocity over its largest speed, of the shear over its
largest value. The shear counts, and is known, from Channel.since on: a wafer that starts at once has an
infinite shear at that moment. A disc that comes within CONTACT_CELLS spacings of the coarsest grid of a wall
is refused.

verification/single_abrasive to 4.1e-5 s, distances from the result, greatest shear; then without the disc
(verification/abrasive_free, --end 4e-5), shear at the end, where finite elements have 287.2 Pa:
          cells     shear  position  velocity               shear of the fluid alone
      200 x 100   6.7e-02   2.0e-02   3.0e-02   397.71 Pa   291.03 Pa
      300 x 150   2.9e-02   7.5e-03   1.1e-02   387.33 Pa   289.65 Pa
      400 x 200   1.6e-02   4.2e-03   6.1e-03   384.65 Pa   289.07 Pa
         result                                 381.21 Pa   288.03 Pa
          order       2.0       2.0       2.0                     1.5
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from reference import (
    base,
    extrapolation,
    immersed_boundary_discs,
    immersed_boundary_flow,
    immersed_boundary_run,
    immersed_channel_run,
    walls,
)
from reference import scene as scenes
from reference.base import Array, ReferenceError, cache_file, canonical, digest_of, read_arrays, write_arrays
from reference.extrapolation import extrapolated
from reference.immersed_boundary_run import CONTACT_CELLS
from reference.immersed_channel_run import Channel, run
from reference.immersed_channel_store import read_stored, write_stored
from reference.scene import Scene

NAME = "immersed_channel"
SCRIPTS = tuple(
    Path(module.__file__)
    for module in (
        base, scenes, walls, extrapolation, immersed_boundary_flow, immersed_boundary_discs,
        immersed_boundary_run, immersed_channel_run,
    )
)  # fmt: skip
DATA = Path(__file__).resolve().parents[1] / "data"
SHARES = (0.5, 0.75, 1.0)
SAMPLES = 200
GROUPS = {"position": slice(0, 2), "velocity": slice(3, 5)}


def solve(channel: Channel, end: float) -> dict[str, Array]:
    """Runs every grid, the coarsest first, to `end` (s). Raises ReferenceError for an end before `since`."""
    if end <= channel.since * (1 + 1 / SAMPLES):
        raise channel.scene.refuse(f"{NAME}: the run has to go on beyond {channel.since:.3g} s")
    started = time.perf_counter()
    times = np.linspace(0, end, SAMPLES + 1)
    grids = [channel.grid(share) for share in SHARES]
    runs = [run(channel, grid, times) for grid in grids]
    return {
        "times": times,
        "shear": np.array([passage.shear for passage in runs]),
        "states": np.array([passage.states for passage in runs]),
        "cells": np.array([grid.cells for grid in grids]),
        "seconds": np.array(time.perf_counter() - started),
    }


class ImmersedChannel:
    kind = "immersed-boundary"
    source = "disc and pad by direct forcing on a staggered grid (uhlmann2005, breugem2012), three grids"

    def __init__(self, channel: Channel, digest: str, arrays: dict[str, Array]):
        scene = channel.scene
        self.channel, self.scene, self.digest = channel, scene, digest
        self.seconds, self.cells, self.times = float(arrays["seconds"]), arrays["cells"], arrays["times"]
        self.grids = {"shear": arrays["shear"]}
        if channel.disc:
            self.grids |= {name: arrays["states"][..., part] for name, part in GROUPS.items()}
            self.clearance = channel.clearance(self.grids["position"].reshape(-1, 2))
            coarsest = CONTACT_CELLS * channel.size[0] / float(self.cells[0, 0])
            if self.clearance < coarsest:
                near = f"{self.clearance:.3g} m of a wall, {coarsest:.3g} m are needed"
                raise scene.refuse(f"{NAME}: the disc comes within {near}")
            self.grids["position"] = self.grids["position"] + np.array(scene.lower)
        self.known = self.times >= channel.since * (1 - 1e-9)
        self.values, self.errors, self.orders = {}, {}, {}
        for name, grids in self.grids.items():
            counts = self._counting(name, grids)
            values, self.orders[name], error = extrapolated(counts, self.cells[-1, 0] / self.cells[:, 0])
            self.values[name], self.errors[name] = values, error / self._scale(name)
        self.error_estimate = max(self.errors.values())

    def _counting(self, name: str, grids: Array) -> Array:
        return grids[:, self.known] if name == "shear" else grids

    def _scale(self, name: str) -> float:
        """What an error of the quantity is divided by."""
        finest = self._counting(name, self.grids[name])[-1]
        if name == "position":
            finest = finest - finest[0]
        return float((np.abs(finest) if name == "shear" else np.linalg.norm(finest, axis=1)).max())

    def greatest_wafer_shear(self, t: float) -> float:
        """The greatest |shear| along the wafer at t (s), Pa; NaN before `since` and after the end."""
        times = self.times[self.known]
        return float(np.interp(t, times, self.values["shear"], left=np.nan, right=np.nan))

    def disc(self, name: str, quantity: str, t: Array) -> Array:
        """Position (n, 2), m, or velocity (n, 2), m/s, at times t (n,), s; NaN outside of the run."""
        if self.channel.disc is None or name != self.scene.discs[0].name or quantity not in GROUPS:
            known = f"{' and '.join(GROUPS)} of its one disc"
            raise self.scene.refuse(f"{NAME} knows {known}; not {quantity} of {name}")
        if quantity == "position":
            place, velocity = self.values["position"], self.values["velocity"]
            found = CubicHermiteSpline(self.times, place, velocity)(t)
        else:
            found = CubicSpline(self.times, self.values["velocity"])(t)
        found[~((np.asarray(t) >= 0) & (np.asarray(t) <= self.times[-1] * (1 + 1e-9)))] = np.nan
        return found

    def error_table(self) -> str:
        """The convergence of the grids, as text."""
        names = "".join(f"{name:>12}" for name in self.grids)
        rows = [f"     cells  {names}  greatest shear"]
        for number, cells in enumerate(self.cells):
            line = [f"{cells[0]:5.0f} x{cells[1]:5.0f}"]
            for name, grids in self.grids.items():
                error = np.abs(self._counting(name, grids)[number] - self.values[name]).max()
                line.append(f"{error / self._scale(name):12.1e}")
            shear = self._counting("shear", self.grids["shear"])[number]
            rows.append("".join(line) + f"{shear.max():11.2f} Pa, at the end {shear[-1]:.2f} Pa")
        rows.append(f"{'order':>12}" + "".join(f"{order:12.1f}" for order in self.orders.values()))
        shear = self.values["shear"]
        rows.append(f"extrapolated: {shear.max():.2f} Pa, at the end {shear[-1]:.2f} Pa")
        rows.append(f"{self.seconds:.0f} s")
        if self.channel.disc:
            rows.append(f"least distance of the disc from a wall: {self.clearance:.3g} m")
        return "\n".join(rows)


def create(scene: Scene, cache: Path) -> ImmersedChannel:
    channel, identity = Channel(scene), scene.flow()
    for file in sorted(DATA.glob(f"{NAME}_*.csv")):
        stored = read_stored(file)
        reaches = stored.arrays["times"][-1] >= scene.end_time * (1 - 1e-9)
        if reaches and stored.identity == canonical(identity):
            return ImmersedChannel(channel, stored.digest, stored.arrays)
    asked = {**identity, "end_time": scene.end_time}
    digest = digest_of(NAME, asked, (*SCRIPTS, Path(__file__)))
    file = cache_file(cache, NAME, digest)
    if file.exists():
        arrays = read_arrays(file, digest, asked)
    else:
        arrays = solve(channel, scene.end_time)
        write_arrays(file, digest, asked, arrays)
    return ImmersedChannel(channel, digest, arrays)


def main() -> int:
    parser = argparse.ArgumentParser(
        prog=f"python -m reference.{NAME}", description="Computes a disc's passage and says how it converges."
    )
    parser.add_argument("scene", type=Path)
    parser.add_argument("--end", type=float, help="s; default: the scene's end_time")
    parser.add_argument("--name", help=f"stores it as data/{NAME}_NAME.csv")
    arguments = parser.parse_args()
    try:
        scene = scenes.read_scene(arguments.scene, {})
        channel = Channel(scene)
        if arguments.name and not channel.disc:
            raise scene.refuse("only the passage of a disc is stored")
        arrays = solve(channel, arguments.end or scene.end_time)
        print(ImmersedChannel(channel, "", arrays).error_table())
        if arguments.name:
            write_stored(DATA / f"{NAME}_{arguments.name}.csv", scene.flow(), arrays)
    except ReferenceError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
