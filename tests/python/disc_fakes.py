"""Small result.h5 files with discs, written as slurry writes them, for tests of what reads them."""

from pathlib import Path

import h5py
import numpy as np

from verification.compare import Check
from verification.measure import Result

END = 1.0
TIMES = np.linspace(0, END, 101)
PARTS = ("position", "velocity", "force", "contact_force")


def fields(position, **changes):
    """The datasets of one disc; `position` (n, 2), everything else zero unless given."""
    n = len(position)
    columns = {f"{part}_{axis}": np.zeros(n) for part in PARTS for axis in "xy"}
    columns |= {"angle": np.zeros(n), "spin": np.zeros(n), "torque": np.zeros(n)}
    columns |= {"position_x": position[:, 0], "position_y": position[:, 1]}
    return columns | {key: np.broadcast_to(value, n) for key, value in changes.items()}


def falling(name="disc", speed=0.5, radius=0.1):
    position = np.stack([np.full_like(TIMES, 0.3), 1 - speed * TIMES], axis=1)
    return {name: fields(position, velocity_y=-speed)}, radius


def write(folder: Path, discs, radius=0.1, times=TIMES, series=None, run=None, mass=2.0, scene=None):
    """A Result; `discs` maps names to fields(), `series` and `run` add to the fluid's series and to /run."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "result.h5"
    with h5py.File(path, "w") as file:
        file.create_group("run").attrs.update({"steps": len(times) - 1, "fluid_particles": 0} | (run or {}))
        file["series/time"] = times
        still = dict.fromkeys(("momentum_x", "momentum_y", "largest_speed"), np.zeros(len(times)))
        for name, values in (still | (series or {})).items():
            file[f"series/{name}"] = values
        group = file.create_group("discs")
        group.attrs["names"] = ",".join(discs)
        group["time"] = times
        for key in next(iter(discs.values())):
            group[key] = np.stack([columns[key] for columns in discs.values()], axis=1)
        for key, value in (("radius", radius), ("mass", mass), ("moment_of_inertia", 1.0), ("density", 2.0)):
            group[key] = np.full(len(discs), value)
    return Result(path, END, scene)


def check(**changes):
    values = {"quantity": "q", "at": "disc:disc", "field": "position_y", "metric": "largest_difference"}
    return Check(**(values | {"tolerance": 0.01, "kind": "exact", "why": "test", "unit": "m"} | changes))
