"""A solver for tests of verification.bench: it knows its manual, its time step, and how to write a result."""

from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
from verification_fakes import FakeReference, FakeSolver

from verification.bench import machine_bench, peers, session
from verification.case import CaseError

MANUAL = """[scene]  what this is
  title                      one line; ""

[numerics]  the discretisation
  particle_spacing           a number > 0 (m); required
                             distance between particles
  pair_arithmetic            one of "float", "double"; "float"
                             of the pair sums
  kernel                     one of "quintic", "wendland_c2", "gaussian"; "quintic"
                             its shape
  background_pressure_ratio  a number >= 0 and <= 10; 1.0
  acoustic_cfl               a number > 0 and <= 10; 0.25
  gradient_correction        true or false; true

[[walls]]  solid walls
  name                       a string; required
"""
MACHINE = {
    "search": [],
    "pair_sweeps": [{"arithmetic": "float", "sweep": "forces", "share_of_fma_peak": 0.3}],
}


@dataclass
class FakeBench(FakeSolver):
    """`broken`: part of a command whose run fails; `by_threads`: what each thread adds to the errors."""

    manual: str = MANUAL
    broken: str = "nothing is broken"
    by_threads: float = 0.0
    commands: list = field(default_factory=list)

    def install(self, monkeypatch):
        monkeypatch.setattr("verification.execute.call", self.call)
        for module in (session, machine_bench, peers):
            monkeypatch.setattr(module, "ask", self.ask)
        monkeypatch.setattr("os.getloadavg", lambda: (2.0, 0.0, 0.0))
        return self

    def ask(self, command):
        match command[1]:
            case "help":
                return self.manual
            case "info":
                return "fluid particles   400\ntime step         0.0005 s\n"
            case "-c":
                return "1.0b1\n"
        raise CaseError("slurry bench: exit status 2: no such command")

    def call(self, command, timeout):
        self.commands.append(command)
        if any(self.broken in part for part in command):
            return "exit status 3: step 12: a velocity is not finite"
        start = command.index("run") - 1
        own = command[start:]
        if start:  # the wrapper of peak_memory.py
            Path(command[start - 2]).write_text(str(10_000_000 + 2000 * self.calls))
        self.error += self.by_threads * int(own[own.index("--threads") + 1])
        return super().call(own, timeout)

    def _write(self, out, scene, factor):
        super()._write(out, scene, factor)
        with h5py.File(out / "result.h5", "a") as file:
            count = round(1 / scene["numerics"]["particle_spacing"] ** 2)
            facts = {"dummy_particles": count, "seconds_start": 0.5, "seconds_output_and_checks": 0.5}
            file["run"].attrs.update(facts | {"list_rebuilds": 3.0})


@dataclass
class FakePeer:
    """PySPH's driver: writes what an example leaves behind, velocities off by `error`."""

    solver: FakeBench
    error: float = 0.02
    completed: str = "true"

    def call(self, command, timeout):
        if "run" in command:
            return self.solver.call(command, timeout)
        out = Path(command[command.index("--directory") + 1])
        out.mkdir(parents=True)
        x = y = np.linspace(0.1, 0.9, 30)
        u, v = (FakeReference().velocity(x, y, 0) * (1 + self.error)).T
        np.savez(out / "final.npz", x=x, y=y, u=u, v=v, t=2.0, steps=44)
        np.savez(out / "results.npz", l1=np.array([0.0, self.error / 2]))
        example = command[command.index(str(peers.DRIVER)) + 1]
        (out / f"{example}.info").write_text(f'{{"completed": {self.completed}, "cpu_time": 30.0}}')
        return ""
