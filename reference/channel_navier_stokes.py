"""Steady flow in a periodic channel between two walls by finite elements.

Equations, in units of the mean gap, the largest speed U and eta U / gap (Re = rho U gap / eta), in the frame
in which both walls keep their shape (the curved wall's, or the scene's if both are flat), u periodic in x:
    Re (u . grad) u = -grad p + lap u + f,   div u = 0,   u = wall velocity on the walls,   mean of p = 0.
Weak form: for all (v, q) with v = 0 on the walls
    (grad u, grad v) + Re ((u . grad) u, v) - (p, div v) = (f, v),    (q, div u) = 0.
Mesh: rectangles in (x, eta), mapped exactly onto the channel (reference/channel_mesh.py); velocity continuous
of degree 4, pressure continuous of degree 3 (Taylor-Hood on quadrilaterals, stable: boffi2013, Sec. 8.8),
with scikit-fem (gustafsson2020). Newton's iteration, from rest on the coarsest mesh and from the mesh before
on the others.
Walls: the traction s of a wall on the fluid is the residual of the momentum equation for test functions v
that do not vanish there (consistent flux, the nodal reactions: gresho1987), (s, v)_wall = residual(v), solved
for the normal and the tangential part of s, both in the trace space of the velocity. The normal part is minus
the pressure: where a wall keeps its shape, the normal derivative of the normal velocity vanishes with div u.

Own convergence: three meshes, each halving the one before. The error estimate is the largest relative change,
in L2, of velocity, pressure, wall pressure and wall shear from the second to the third: a bound on the error
of the third wherever the order is above one. Above MOST_ERROR the reference is refused. Case 1 of wang2014
(Sec. 4.1.1):
    elements  unknowns     velocity     pressure  wall pressure   wall shear
          72      3150      2.4e-04      1.2e-03        1.0e-03      6.1e-04
         288     12204      9.2e-06      8.3e-05        7.1e-05      3.5e-05
       order                    4.7          3.9            3.8          4.1
On corners that point into the fluid pressure and shear are unbounded; wall values are therefore compared with
the weight min(1, distance to the corner / 0.1 mean gap). A cavity whose walls rise at 60 degrees is
still refused: its area pressure changes by 3 % to the third mesh (an arc that bulges into the fluid: 0.03 %).
"""

import time
from pathlib import Path

import numpy as np
from numpy.polynomial import legendre

from reference import base, channel_mesh, channel_solution, walls
from reference import scene as scenes
from reference.base import Array, ReferenceError, cache_file, digest_of, read_arrays, write_arrays
from reference.channel_mesh import Channel, Polynomials
from reference.channel_solution import DEGREE, Problem, Solution
from reference.scene import Scene
from reference.walls import Graph

NAME = "channel_navier_stokes"
MESHES = 3
MOST_ERROR = 1e-3
QUANTITIES = ("velocity", "pressure", "wall pressure", "wall shear")
SHARP_KINK = 0.05  # smallest jump of slope that mesh lines crowd towards
SMALL_STRESS = 1e-2  # of eta U / gap: quantities that are zero are compared with this instead of themselves
SCRIPTS = tuple(Path(module.__file__) for module in (base, scenes, walls, channel_mesh, channel_solution))


class Units:
    """The scene as a Problem without dimensions, and the units that lead back."""

    def __init__(self, scene: Scene):
        self.scene = scene
        self.bottom, self.top = self._graphs()
        self.frame = self._frame_speed()
        start, width = scene.lower[0], scene.size[0]
        x = start + width * (np.arange(4096) + 0.5) / 4096
        gap = self.top.height(x) - self.bottom.height(x)
        if gap.min() <= 0:
            raise scene.refuse(f"the walls meet or cross near x = {x[gap.argmin()]:.4g} m")
        self.length = float(gap.mean())
        speeds = [graph.wall.velocity[0] - self.frame for graph in (self.bottom, self.top)]
        driven = abs(scene.body_force[0]) * self.length**2 / (8 * scene.kinematic_viscosity)
        self.speed = max(*map(abs, speeds), abs(speeds[1] - speeds[0]), driven)
        if self.speed == 0:
            raise scene.refuse(f"{NAME}: nothing drives a flow: no wall moves and no force acts along x")
        self.stress = scene.dynamic_viscosity * self.speed / self.length
        self.reynolds = self.speed * self.length / scene.kinematic_viscosity
        self.speeds = (speeds[0] / self.speed, speeds[1] / self.speed)

    def _graphs(self) -> tuple[Graph, Graph]:
        scene = self.scene
        if scene.periodic != "x" or len(scene.walls) != 2:
            raise scene.refuse(f"{NAME} needs a domain periodic in x and exactly two walls")
        if any(wall.velocity[1] != 0 for wall in scene.walls):
            raise scene.refuse(f"{NAME}: walls that move along y have no steady flow")
        graphs = {wall.fluid_side: walls.graph(scene, wall) for wall in scene.walls}
        if len(graphs) != 2:
            raise scene.refuse(f"{NAME} needs one wall with the fluid above it and one with the fluid below")
        return graphs["above"], graphs["below"]

    def _frame_speed(self) -> float:
        speeds = {graph.wall.velocity[0] for graph in (self.bottom, self.top) if not graph.flat}
        if len(speeds) > 1:
            raise self.scene.refuse(
                f"{NAME}: two curved walls that move against each other have no steady flow in any frame"
            )
        return speeds.pop() if speeds else 0.0

    def problem(self) -> Problem:
        unit = self.length

        def scaled(function: walls.Function, by: float) -> walls.Function:
            return lambda x: function(np.asarray(x) * unit) / by

        step = 1e-6 * self.scene.size[0]
        kinks = [(x, graph is self.top) for graph in (self.bottom, self.top) for x in graph.kinks
                 if abs(graph.slope(x + step) - graph.slope(x - step)) > SHARP_KINK]  # fmt: skip
        channel = Channel(
            start=self.scene.lower[0] / unit,
            length=self.scene.size[0] / unit,
            bottom=scaled(self.bottom.height, unit),
            top=scaled(self.top.height, unit),
            bottom_slope=scaled(self.bottom.slope, 1.0),
            top_slope=scaled(self.top.slope, 1.0),
            kinks=tuple((x / unit, at_top) for x, at_top in kinks),
        )
        scale = unit**2 / (self.scene.kinematic_viscosity * self.speed)
        force = (self.scene.body_force[0] * scale, self.scene.body_force[1] * scale)
        return Problem(channel, self.reynolds, force, self.speeds)


def changes(coarse: Solution, fine: Solution) -> list[float]:
    """Relative changes of QUANTITIES from one mesh to the next, in L2."""
    values = fine.on_quadrature(fine)
    difference = fine.square_norms(coarse.on_quadrature(fine) - values)
    norm = fine.square_norms(values)
    floor = SMALL_STRESS**2 * fine.velocity.basis.dx.sum()
    velocity = np.sqrt((difference[0] + difference[1]) / (norm[0] + norm[1]))
    pressure = np.sqrt(difference[2] / max(norm[2], floor))
    return [float(velocity), float(pressure), *_wall_changes(coarse, fine)]


def _wall_changes(coarse: Solution, fine: Solution) -> list[float]:
    channel, lines = fine.problem.channel, fine.polynomials.x_lines
    points, weights = legendre.leggauss(DEGREE + 2)
    x = (lines[:-1, None] + np.diff(lines)[:, None] * (points + 1) / 2).ravel()
    dx = (np.diff(lines)[:, None] * weights / 2).ravel()
    for kink, _ in channel.kinks:
        away = np.abs(x - kink)
        dx = dx * np.minimum(1, np.minimum(away, channel.length - away) / 0.1) ** 2
    result = []
    for quantity in (0, 1):
        square, norm = 0.0, 0.0
        for wall in (0, 1):
            value = fine.polynomials.along(fine.tractions[wall, quantity], x)
            other = coarse.polynomials.along(coarse.tractions[wall, quantity], x)
            square, norm = square + np.sum(dx * (other - value) ** 2), norm + np.sum(dx * value**2)
        result.append(float(np.sqrt(square / max(norm, SMALL_STRESS**2 * channel.length))))
    return result


def solve(units: Units) -> dict[str, Array]:
    """Solves on MESHES meshes; the finest solution in SI units and the changes from mesh to mesh."""
    started = time.perf_counter()
    problem, solutions, table = units.problem(), [], []
    for refinement in range(MESHES):
        try:
            solutions.append(Solution(problem, refinement, solutions[-1] if solutions else None))
        except (RuntimeError, ReferenceError) as error:
            raise units.scene.refuse(f"{NAME}: {error}") from error
        if refinement > 0:
            table.append(changes(*solutions[-2:]))
    finest = solutions[-1]
    if not max(table[-1]) <= MOST_ERROR:
        found = ", ".join(f"{name} {change:.1e}" for name, change in zip(QUANTITIES, table[-1], strict=True))
        raise units.scene.refuse(f"{NAME}: own error above {MOST_ERROR:g}: {found}")
    moving = finest.on_quadrature(finest)[:2] + np.array([units.frame / units.speed, 0])[:, None, None]
    energy = 0.5 * units.scene.density * (units.speed * units.length) ** 2 * finest.square_norms(moving).sum()
    scale = np.array([units.speed, units.speed, units.stress])
    return {
        "x_lines": finest.polynomials.x_lines * units.length,
        "eta_lines": finest.polynomials.eta_lines,
        "fields": finest.fields * scale[:, None, None],
        "tractions": finest.tractions * units.stress,
        "sizes": np.array([[s.elements, len(s.state)] for s in solutions]),
        "changes": np.array(table),
        "kinetic_energy": np.array(energy),
        "seconds": np.array(time.perf_counter() - started),
    }


class ChannelNavierStokes:
    kind = "finite-element"
    source = "steady Navier-Stokes, Q4/Q3 finite elements (gustafsson2020, boffi2013)"

    def __init__(self, units: Units, digest: str, arrays: dict[str, Array]):
        self.scene, self.units, self.digest = units.scene, units, digest
        self.polynomials = Polynomials(arrays["x_lines"], arrays["eta_lines"], DEGREE)
        self.fields, self.tractions = arrays["fields"], arrays["tractions"]
        self.sizes, self.changes = arrays["sizes"], arrays["changes"]
        self.error_estimate = float(self.changes[-1].max())
        self.seconds = float(arrays["seconds"])
        self._energy = float(arrays["kinetic_energy"])

    def velocity(self, x: Array, y: Array, t: float) -> Array:
        fields = self.polynomials.at(self.fields[:2], *self._place(x, y, t))
        return fields.T + np.array([self.units.frame, 0.0])

    def pressure(self, x: Array, y: Array, t: float) -> Array:
        return self.polynomials.at(self.fields[2:], *self._place(x, y, t))[0]

    def wall_pressure(self, wall: str, x: Array, t: float) -> Array:
        return self._traction(wall, 0, x, t)

    def wall_shear(self, wall: str, x: Array, t: float) -> Array:
        return self._traction(wall, 1, x, t)

    def kinetic_energy(self, t: float) -> float:
        return self._energy

    def error_table(self) -> str:
        """The convergence of the three meshes, as text."""
        rows = ["elements  unknowns  " + "".join(f"{quantity:>15}" for quantity in QUANTITIES)]
        for size, change in zip(self.sizes, [None, *self.changes], strict=True):
            cells = ["-"] * len(QUANTITIES) if change is None else [f"{value:.1e}" for value in change]
            rows.append(f"{size[0]:8.0f}  {size[1]:8.0f}  " + "".join(f"{cell:>15}" for cell in cells))
        with np.errstate(divide="ignore", invalid="ignore"):
            orders = np.log2(self.changes[-2] / self.changes[-1])
        rows.append(f"{'order':>18}  " + "".join(f"{order:15.1f}" for order in orders))
        return "\n".join(rows)

    def _place(self, x: Array, y: Array, t: float) -> tuple[Array, Array]:
        """Points of the laboratory at time t as x in the walls' frame and eta, clipped to the channel."""
        x = np.asarray(x, dtype=float) - self.units.frame * t
        bottom = self.units.bottom.height(x)
        eta = (np.asarray(y, dtype=float) - bottom) / (self.units.top.height(x) - bottom)
        return x, np.clip(eta, 0.0, 1.0)

    def _traction(self, wall: str, part: int, x: Array, t: float) -> Array:
        names = [self.units.bottom.wall.name, self.units.top.wall.name]
        if wall not in names:
            raise self.scene.refuse(f"{NAME}: no wall {wall!r}, only {' and '.join(names)}")
        number = names.index(wall)
        speed = (self.units.bottom, self.units.top)[number].wall.velocity[0]
        along = np.asarray(x, dtype=float) + (speed - self.units.frame) * t
        return self.polynomials.along(self.tractions[number, part], along)


def _check_shapes(file: Path, arrays: dict[str, Array]) -> None:
    nodes = [(len(arrays.get(key, ())) - 1) * DEGREE + 1 for key in ("x_lines", "eta_lines")]
    shapes = {
        "fields": (3, *nodes),
        "tractions": (2, 2, nodes[0]),
        "sizes": (MESHES, 2),
        "changes": (MESHES - 1, len(QUANTITIES)),
        "kinetic_energy": (),
        "seconds": (),
    }
    for key, shape in shapes.items():
        if key not in arrays or arrays[key].shape != shape:
            raise ReferenceError(f"{file}: {key} is not of shape {shape}; delete it and run `make reference`")


def create(scene: Scene, cache: Path) -> ChannelNavierStokes:
    units = Units(scene)
    digest = digest_of(NAME, scene.flow(), (*SCRIPTS, Path(__file__)))
    file = cache_file(cache, NAME, digest)
    if file.exists():
        arrays = read_arrays(file, digest, scene.flow())
        _check_shapes(file, arrays)
    else:
        arrays = solve(units)
        write_arrays(file, digest, scene.flow(), arrays)
    return ChannelNavierStokes(units, digest, arrays)
