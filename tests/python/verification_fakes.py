"""Stand-ins for the solver and the references: the verification is tested by itself and within seconds.

FakeSolver.call takes the place of verification.execute.call: it writes a small result.h5 in which every field
is the fake reference's times (1 + error s^2), s = spacing / (height / 20). A run that is told
fluid.dynamic_viscosity with --set is off by 10 % instead.
"""

import tomllib
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from reference.scene import override

ERROR = 1e-3
CELL = 20


class FakeReference:
    kind, source, error_estimate, seconds, digest = "exact", "fake (nobody2026)", 0.0, 0.0, "0"

    def velocity(self, x, y, t):
        return np.stack([1 + np.sin(1e5 * y), 0 * x], axis=1)

    def pressure(self, x, y, t):
        return 5 + 100 * np.cos(2e5 * x)

    def wall_pressure(self, wall, x, t):
        return 5 + 100 * np.cos(2e5 * x)

    def wall_shear(self, wall, x, t):
        return 120 + 70 * np.cos(2e5 * x)

    def kinetic_energy(self, t):
        return 2.0


def load(name, scene_path, overrides, cache):
    return FakeReference()


@dataclass
class FakeSolver:
    """`fault`: "nan", "short", "backwards", "lost", "no_probe", "no_file", or the error message of a run."""

    fault: str = ""
    error: float = ERROR
    calls: int = 0

    def call(self, command, timeout):
        self.calls += 1
        scene_path, out = Path(command[2]), Path(command[command.index("--out") + 1])
        scene = tomllib.loads(scene_path.read_text())
        settings = [text for flag, text in zip(command, command[1:], strict=False) if flag == "--set"]
        for text in settings:
            key, value = text.split("=", 1)
            override(scene, key, tomllib.loads(f"value = {value}")["value"], scene_path)
        if " " in self.fault:
            return self.fault
        ratio = scene["numerics"]["particle_spacing"] * CELL / scene["domain"]["upper"][1]
        wrong = any(text.startswith("fluid.dynamic_viscosity") for text in settings)
        if self.fault != "no_file":
            self._write(out, scene, 1.1 if wrong else 1 + self.error * ratio**2)
        return ""

    def _write(self, out, scene, factor):
        truth, upper = FakeReference(), scene["domain"]["upper"]
        end = scene["output"]["end_time"] * (0.9 if self.fault == "short" else 1)
        x, y = (a.ravel() for a in np.meshgrid(*(np.linspace(0.02, 0.98, CELL) * s for s in upper)))
        with h5py.File(out / "result.h5", "w") as file:
            facts = {"fluid_particles": len(x), "steps": 10, "threads": 2, "wall_seconds": 2.0}
            file.create_group("run").attrs.update(facts | {"particle_steps_per_second": 1e6})
            times = np.linspace(0, end, 201)
            if self.fault == "backwards":
                times[100] = times[99]
            file["series/time"] = times
            file["series/kinetic_energy"] = [factor * truth.kinetic_energy(t) for t in times]
            for probe in [] if self.fault == "no_probe" else scene.get("probes", []):
                along = np.linspace(0, upper[0], 120, endpoint=False)
                group = file.create_group(f"probes/{probe['name']}")
                group["time"], group["x"] = [0.0, end], along
                group["pressure"] = np.tile(factor * truth.wall_pressure("wafer", along, end), (2, 1))
                group["shear"] = np.tile(factor * truth.wall_shear("wafer", along, end), (2, 1))
            for index, time in enumerate([*scene["output"].get("snapshot_times", []), end]):
                group = file.create_group(f"snapshots/{index:04}")
                group.attrs["time"] = time
                fields = [x, y, *(factor * truth.velocity(x, y, time)).T, factor * truth.pressure(x, y, time)]
                if self.fault == "nan":
                    fields[2][3] = np.nan
                names = ("position_x", "position_y", "velocity_x", "velocity_y", "pressure")
                for name, values in zip(names, fields, strict=True):
                    group[name] = np.append(values, np.nan)  # a dummy, whose values no check may read
                wall = np.append(np.full(len(x), -1), 0)
                group["wall"] = np.where(np.arange(len(wall)) == 7, 0, wall) if self.fault == "lost" else wall
