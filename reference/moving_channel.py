"""Unsteady flow in a periodic channel between a wall at rest and one that moves along it, by finite elements.

Equations, in units of the mean gap, the moving wall's speed U and eta U / gap (Re = rho U gap / eta), in the
frame of the wall at rest (the top; a feature's corners stay on mesh lines), u periodic in x:
    Re (du/dt + (u . grad) u) = -grad p + lap u,   div u = 0,   u = wall velocity on the walls,
    mean of p over the channel = 0.
The channel bottom(x - V t) <= y <= top(x) is the image of a rectangle (x, eta) by
    y = bottom(x - V t) + eta (top(x) - bottom(x - V t)),
exact and analytic (of bottom the first waves: moving_channel_units.py), whose points move in y alone, at
w = (0, -(1 - eta) V bottom'). At a point of the mesh
    du/dt = d/dt at fixed (x, eta) - (w . grad) u                      (arbitrary Lagrangian-Eulerian form).
Weak form: for all (v, q) with v = 0 on the walls, D the BDF3 formula at fixed (x, eta), u* the velocity
extrapolated with the same order from the steps before,
    Re (D u, v) + Re (((u* - w) . grad) u, v) + (grad u, grad v) - (p, div v) = 0,    (q, div u) = 0,
all integrals over the channel at the new time: one linear system a step, solved by GMRES with the factors
of an earlier step. Mesh: rectangles in (x, eta) with lines on the corners of the feature, crowding towards
those that point into the fluid (reference/channel_mesh.py); velocity continuous of degree 4, pressure of
degree 3 (Taylor-Hood), with scikit-fem (gustafsson2020). reference/moving_channel_flow.py steps.

Own convergence: from rest, SPIN_UP periods T of SPIN_UP_STEPS steps on the coarser mesh; from their end
SETTLING and one period more, of STEPS and of 2 STEPS steps on it, and of STEPS steps on the finer mesh,
which halves it. The result is the last period of the finer one, plus the change from STEPS to 2 STEPS on
the coarser. Error estimates are relative, in L2, of the wall pressure over wall and period and of the
pressure field at INSTANTS: the change from STEPS to 2 STEPS over 7 (order 3); the change from the coarser
mesh to the finer over 3 (order 2; smooth walls have more); what storing at the nodes of the coarser mesh
changes; and the change from one period of the spin-up to the next, which shows that the flow is periodic.
On corners that point into the fluid the pressure is unbounded; errors have the weight min(1, distance to a
corner / CORNER_SHARE mean gaps).

verification/wafer_feature, wall pressure and field:
                            arc              cavity             sine
  from period to period     2.1e-05 1.6e-05  3.1e-04 1.9e-04  3.1e-05 2.0e-05
  of the time step          1.7e-03 3.6e-03  2.0e-03 4.0e-03  1.5e-03 3.6e-03
  of the mesh               5.6e-03 2.2e-03  4.0e-03 3.2e-03  1.3e-03 3.1e-03
  by storing                1.6e-03 6.2e-04  4.3e-03 1.1e-03  6.5e-04 9.4e-04

A flow takes minutes. Those of verification/wafer_feature are stored in data/moving_channel_*.csv by
    python -m reference.moving_channel SCENE --name NAME [--set KEY=VALUE] [--point X Y]
and recognised by the scene in the header (moving_channel_store.py). Other scenes are computed when asked for
and kept in the cache.
"""

import argparse
import sys
import time
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference import base, channel_mesh, channel_solution, moving_channel_flow, moving_channel_units, walls
from reference import scene as scenes
from reference.base import Array, ReferenceError, cache_file, canonical, digest_of, read_arrays, write_arrays
from reference.channel_mesh import Polynomials, lobatto_points
from reference.channel_solution import DEGREE
from reference.moving_channel_flow import Flow, MovingProblem, Space
from reference.moving_channel_store import read_stored, write_stored
from reference.moving_channel_units import NAME, Units
from reference.scene import Scene

MODULES = (base, scenes, walls, channel_mesh, channel_solution, moving_channel_flow, moving_channel_units)
SCRIPTS = tuple(Path(module.__file__) for module in MODULES)
DATA = Path(__file__).resolve().parents[1] / "data"
INSTANTS = (0.0, 0.2, 0.4, 0.6, 0.8)  # of a period, at which fields are kept
SAMPLES = 50  # of a period, at which wall and points are kept
SPIN_UP, SPIN_UP_STEPS, STEPS, SETTLING = 4, 50, 100, 0.2
CORNER_SHARE = 0.1
WALL_POINTS = 400  # where wall pressures are compared
TIME_REDUCTION = 7.0  # of the change over the error of the finer: order 3 says 7
MESH_REDUCTION = 3.0  # order 2 says 3; the flat wafer converges with more
SAME_INSTANT = 1e-3  # of a period


@dataclass(frozen=True)
class Period:
    """The pressure of one period, in the problem's units: at each phase, at the nodes of `polynomials`."""

    polynomials: Polynomials
    fields: Sequence[Array]  # (x nodes, eta nodes) each

    @classmethod
    def run(cls, flow: Flow, steps: int, total: int) -> "Period":
        """Runs `total` steps, `steps` to a period, and keeps the last period of them."""
        fields: list[Array] = [np.empty(0)] * steps
        for state in flow.run(total):
            fields[round(state.time / flow.step) % steps] = flow.space.pressure_nodes(flow.problem, state)
        return cls(flow.space.pressure_polynomials, fields)

    def at(self, phase: float, x: Array, eta: Array) -> Array:
        """At points (n,), at a phase that is one of the steps."""
        number = round(phase * len(self.fields)) % len(self.fields)
        return self.polynomials.at(self.fields[number][None], x, eta)[0]

    def on(self, lines: tuple[Array, Array], phase: float) -> Array:
        """At the nodes of degree DEGREE of other mesh lines (x nodes, eta nodes)."""
        x, eta = np.meshgrid(*(lobatto_nodes(line, DEGREE) for line in lines), indexing="ij")
        return self.at(phase, x.ravel(), eta.ravel()).reshape(x.shape)


def _change(problem: MovingProblem, coarse: Period, fine: Period, space: Space) -> tuple[float, float]:
    """Relative changes, in L2, of the wall pressure over wall and period and of the fields at INSTANTS."""

    def relative(phases: Array, x: Array, eta: Array, area: Array) -> float:
        depth = (1 - eta) * (problem.top(x) - problem.highest)  # below the top, or less
        for kink, _ in problem.kinks:
            away = np.hypot(problem.distance(x, kink), depth)
            area = area * np.minimum(1, away / CORNER_SHARE) ** 2
        square = norm = 0.0
        for phase in phases:
            values = fine.at(phase, x, eta)
            square += np.sum(area * (coarse.at(phase, x, eta) - values) ** 2)
            norm += np.sum(area * values**2)
        return float(np.sqrt(square / norm))

    x = problem.start + problem.length * (np.arange(WALL_POINTS) + 0.5) / WALL_POINTS
    wall = relative(np.arange(SAMPLES) / SAMPLES, x, np.ones_like(x), np.ones_like(x))
    return wall, relative(np.array(INSTANTS), space.x.ravel(), space.eta.ravel(), space.weights.ravel())


def solve(units: Units, points: Sequence[tuple[float, float]]) -> dict[str, Array]:
    """Pressures of one period in SI units, and how they changed with period, time step and mesh."""
    started = time.process_time()
    problem = units.problem()
    coarse, fine = (Space(problem, refinement) for refinement in (0, 1))
    spin_up = Flow(problem, coarse, SPIN_UP_STEPS, None)
    before = Period.run(spin_up, SPIN_UP_STEPS, (SPIN_UP - 1) * SPIN_UP_STEPS)
    spun = Period.run(spin_up, SPIN_UP_STEPS, SPIN_UP_STEPS)

    def last_period(space: Space, steps: int) -> Period:
        return Period.run(Flow(problem, space, steps, spin_up), steps, steps + round(SETTLING * steps))

    slow, quick, final = last_period(coarse, STEPS), last_period(coarse, 2 * STEPS), last_period(fine, STEPS)
    phases = np.arange(SAMPLES) / SAMPLES
    kept, kept_quick, kept_slow = (
        Period(Polynomials(*coarse.lines, DEGREE), [period.on(coarse.lines, phase) for phase in phases])
        for period in (final, quick, slow)
    )
    fields = np.array(kept.fields) + np.array(kept_quick.fields) - np.array(kept_slow.fields)

    def at_point(x: float, y: float, phase: float) -> Array:
        place = units.place(x, y, phase)
        return final.at(phase, *place) + quick.at(phase, *place) - slow.at(phase, *place)

    pairs = ((before, spun), (slow, quick), (slow, final), (kept, final))
    return {
        "x_lines": coarse.lines[0] * units.length,
        "eta_lines": coarse.lines[1],
        "wall": fields[:, :, -1] * units.stress,
        "fields": fields[[round(phase * SAMPLES) for phase in INSTANTS]] * units.stress,
        "points": np.array(points, dtype=float).reshape(-1, 2),
        "at_points": np.reshape(
            [[at_point(*point, phase) for phase in phases] for point in points], (len(points), SAMPLES)
        )
        * units.stress,
        "sizes": np.array([[len(space.weights), space.total] for space in (coarse, fine)]),
        "changes": np.array([_change(problem, *pair, fine) for pair in pairs]),
        "seconds": np.array(time.process_time() - started),
    }


class MovingChannel:
    kind = "finite-element"
    source = "unsteady Navier-Stokes, moving mesh, Q4/Q3 elements, BDF3 (gustafsson2020, boffi2013)"

    def __init__(self, units: Units, digest: str, arrays: dict[str, Array]):
        self.scene, self.units, self.digest = units.scene, units, digest
        self.polynomials = Polynomials(arrays["x_lines"], arrays["eta_lines"], DEGREE)
        self.wall, self.fields = arrays["wall"], arrays["fields"]
        self.points, self.at_points = arrays["points"], arrays["at_points"]
        self.sizes, self.changes = arrays["sizes"], arrays["changes"]
        self.seconds = float(arrays["seconds"])
        self.repetition = float(self.changes[0].max())
        self.error_estimate = float(max(self.errors().max(), self.repetition))

    def errors(self) -> Array:
        """Estimates for time step, mesh and storage (3, 2), of wall pressure and fields."""
        return self.changes[1:] / np.array([TIME_REDUCTION, MESH_REDUCTION, 1.0])[:, None]

    def pressure(self, x: Array, y: Array, t: float) -> Array:
        """At INSTANTS anywhere; at other times at the stored points alone."""
        phase = t / self.units.period % 1
        number = int(np.argmin([abs((phase - instant + 0.5) % 1 - 0.5) for instant in INSTANTS]))
        if abs((phase - INSTANTS[number] + 0.5) % 1 - 0.5) <= SAME_INSTANT:
            x, eta = self.units.laboratory(x, y, phase)
            return self.polynomials.at(self.fields[number][None], x, np.clip(eta, 0, 1))[0]
        places = np.stack(np.broadcast_arrays(x, y), axis=-1).reshape(-1, 2)
        apart = np.linalg.norm(places[:, None] - self.points[None], axis=2)
        if not self.points.size or apart.min(axis=1).max() > 1e-9 * self.scene.size[0]:
            known = ", ".join(f"{instant:g} T" for instant in INSTANTS)
            raise self.scene.refuse(f"{NAME} has the field at {known} alone, not at {t:g} s, {phase:.4g} T")
        return _periodic(self.at_points.T, phase)[apart.argmin(axis=1)]

    def wall_pressure(self, wall: str, x: Array, t: float) -> Array:
        if wall != self.units.top.wall.name:
            raise self.scene.refuse(f"{NAME} knows {self.units.top.wall.name!r} alone, not {wall!r}")
        return self.polynomials.along(_periodic(self.wall, t / self.units.period), np.atleast_1d(x))

    def velocity(self, x: Array, y: Array, t: float) -> Array:
        raise self.scene.refuse(f"{NAME} keeps pressures alone")

    def wall_shear(self, wall: str, x: Array, t: float) -> Array:
        raise self.scene.refuse(f"{NAME} keeps pressures alone")

    def kinetic_energy(self, t: float) -> float:
        raise self.scene.refuse(f"{NAME} keeps pressures alone")

    def error_table(self) -> str:
        """The convergence, as text."""
        sizes = " and ".join(
            f"{elements:.0f} elements ({unknowns:.0f} unknowns)" for elements, unknowns in self.sizes
        )
        rows = [f"{sizes}, {self.seconds:.0f} s", f"{'change':>22}  wall pressure    field"]
        names = ("from period to period", "of the time step", "of the mesh", "by storing")
        for name, change in zip(names, self.changes, strict=True):
            rows.append(f"{name:>22}  {change[0]:13.1e}  {change[1]:7.1e}")
        return "\n".join([*rows, f"{'error estimate':>22}  {self.error_estimate:13.1e}"])


def lobatto_nodes(lines: Array, degree: int) -> Array:
    """Nodes of Polynomials of one direction (elements degree + 1,)."""
    inner = lines[:-1, None] + np.diff(lines)[:, None] * lobatto_points(degree)[:-1]
    return np.append(inner.ravel(), lines[-1])


def _periodic(samples: Array, phase: float) -> Array:
    """The trigonometric polynomial through samples at even phases (samples, n), at a phase (n,)."""
    count = len(samples)
    waves = np.fft.rfft(samples, axis=0)
    turns = np.exp(2j * np.pi * phase * np.arange(len(waves)))
    share = np.full(len(waves), 2.0)
    share[0] = 1.0
    if count % 2 == 0:
        share[-1] = 1.0
    return np.real(np.tensordot(share * turns, waves, 1)) / count


def create(scene: Scene, cache: Path) -> MovingChannel:
    units, identity = Units(scene), scene.flow()
    for file in sorted(DATA.glob(f"{NAME}_*.csv")):
        stored = read_stored(file)
        if stored.identity == canonical(identity):
            return MovingChannel(units, stored.digest, stored.arrays)
    digest = digest_of(NAME, identity, (*SCRIPTS, Path(__file__)))
    file = cache_file(cache, NAME, digest)
    if file.exists():
        arrays = read_arrays(file, digest, identity)
    else:
        arrays = solve(units, [])
        write_arrays(file, digest, identity, arrays)
    return MovingChannel(units, digest, arrays)


def main() -> int:
    parser = argparse.ArgumentParser(
        prog=f"python -m reference.{NAME}", description="Stores the pressure of a scene's flow in data/."
    )
    parser.add_argument("scene", type=Path)
    parser.add_argument("--name", required=True, help=f"the file is data/{NAME}_NAME.csv")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="as of slurry run")
    parser.add_argument("--point", nargs=2, type=float, action="append", default=[], metavar=("X", "Y"))
    arguments = parser.parse_args()
    try:
        settings = dict(text.split("=", 1) for text in arguments.set)
        overrides = {key: tomllib.loads(f"value = {value}")["value"] for key, value in settings.items()}
        scene = scenes.read_scene(arguments.scene, overrides)
        units = Units(scene)
        arrays = solve(units, arguments.point)
        write_stored(DATA / f"{NAME}_{arguments.name}.csv", scene.flow(), arrays)
        print(MovingChannel(units, "", arrays).error_table())
    except (ReferenceError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
