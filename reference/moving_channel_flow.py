"""The time stepping of moving_channel.py, whose docstring has equations and weak form."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import LinearOperator, gmres, splu
from skfem import MeshQuad1DG

from reference.base import Array, ReferenceError
from reference.channel_mesh import Channel, ChannelMapping, Elements, Polynomials, mesh_lines
from reference.channel_solution import COMPRESSIBILITY, DEGREE, load
from reference.walls import Function

PER_GAP = 2  # elements across the narrowest gap on the coarsest mesh
KINK_SIZE = 1e-3  # smallest element at a kink, in mean gaps, on the coarsest mesh
DERIVATIVE = {1: (1, -1), 2: (3 / 2, -2, 1 / 2), 3: (11 / 6, -3, 3 / 2, -1 / 3)}  # of BDF, newest first
EXTRAPOLATION = {1: (1,), 2: (2, -1), 3: (3, -3, 1)}
ORDER = 3
RESIDUAL = 1e-9  # relative, of the linear system of a step
MOST_ITERATIONS = 14  # with an old factorisation, before a new one is made


@dataclass(frozen=True)
class MovingProblem:
    """Without dimensions: the mean gap, the moving wall's speed U and eta U / gap are the units.

    The top is at rest; the bottom is bottom(x - t).
    """

    start: float
    length: float
    bottom: Function
    top: Function
    bottom_slope: Function
    top_slope: Function
    highest: float  # of the bottom
    kinks: tuple[tuple[float, bool], ...]  # of the top
    reynolds: float

    def lines(self, refinement: int) -> tuple[Array, Array]:
        """Mesh lines for the narrowest gap that passes each x."""
        narrowest = Channel(
            self.start,
            self.length,
            lambda x: np.full(np.shape(x), self.highest),
            self.top,
            lambda x: np.zeros(np.shape(x)),
            self.top_slope,
            self.kinks,
        )
        return mesh_lines(narrowest, PER_GAP, KINK_SIZE, refinement)


class Space:
    """Velocity and pressure on the rectangle (x, eta), and the pattern of the matrix of a step."""

    def __init__(self, problem: MovingProblem, refinement: int):
        lines = problem.lines(refinement)
        self.polynomials = Polynomials(*lines, DEGREE)
        mesh = MeshQuad1DG.init_tensor(*lines, periodic=[0])
        self.rectangle = ChannelMapping(mesh, _rectangle(problem))
        self.velocity = Elements(mesh, self.rectangle, DEGREE, DEGREE + 2)
        self.pressure = Elements(mesh, self.rectangle, DEGREE - 1, DEGREE + 2)
        self.weights = self.velocity.basis.dx
        self.x, self.eta = self.rectangle.affine.F(self.velocity.basis.X)
        self.phi, self.phi_x, self.phi_eta = _shape_functions(self.velocity)
        self.psi = _shape_functions(self.pressure)[0]
        self.size, self.pressures = self.velocity.basis.N, self.pressure.basis.N
        self.top_dofs, self.bottom_dofs = (self._wall_dofs(top) for top in (True, False))
        self._set_pattern()

    def _wall_dofs(self, top: bool) -> Array:
        wall = self.velocity.wall(top)
        present = [np.abs(np.asarray(function[0])).max() > 1e-12 for function in wall.basis]
        return np.unique(wall.element_dofs[present])

    def _set_pattern(self) -> None:
        """Where the entries of the elements' matrices go in the matrix of the unknowns."""
        u = self.velocity.basis.element_dofs.T
        p = self.pressure.basis.element_dofs.T + 2 * self.size
        blocks = [(u, u), (u + self.size, u + self.size), (u, p), (u + self.size, p), (p, u), (p, u + self.size)]
        rows = np.concatenate([np.broadcast_to(r[:, :, None], (*r.shape, c.shape[1])).ravel() for r, c in blocks])
        columns = np.concatenate(
            [np.broadcast_to(c[:, None, :], (len(c), r.shape[1], c.shape[1])).ravel() for r, c in blocks]
        )
        total = 2 * self.size + self.pressures
        keys, self.place = np.unique(columns.astype(np.int64) * total + rows, return_inverse=True)
        self.indices = keys % total
        self.pointers = np.searchsorted(keys, np.arange(total + 1, dtype=np.int64) * total)
        self.total = total

    def matrix(self, parts: list[Array]) -> csc_matrix:
        """Of the elements' matrices in the order of the blocks."""
        values = np.concatenate([part.ravel() for part in parts])
        data = np.bincount(self.place, weights=values, minlength=len(self.indices))
        return csc_matrix((data, self.indices, self.pointers), shape=(self.total, self.total))

    def gather(self, values: Array, basis_dofs: Array, functions: Array) -> Array:
        """A function of coefficients `values` at the quadrature points (elements, points)."""
        return np.einsum("ei,eiq->eq", values[basis_dofs.T], functions)


def _rectangle(problem: MovingProblem) -> Channel:
    zero, one = (lambda value: lambda x: np.full(np.shape(x), value))(0.0), lambda x: np.ones(np.shape(x))
    return Channel(problem.start, problem.length, zero, one, zero, zero, problem.kinks)


def _shape_functions(elements: Elements) -> tuple[Array, Array, Array]:
    """Values and derivatives by x and eta (elements, functions, points)."""
    basis = elements.basis
    values = np.stack([np.broadcast_to(np.asarray(f[0]), basis.dx.shape) for f in basis.basis], axis=1)
    gradient = [np.stack([np.broadcast_to(f[0].grad[a], basis.dx.shape) for f in basis.basis], axis=1) for a in (0, 1)]
    return np.ascontiguousarray(values), *map(np.ascontiguousarray, gradient)


@dataclass
class State:
    time: float
    unknowns: Array  # velocity x, velocity y, pressure


class Flow:
    """The flow on one mesh with one time step, from states of another mesh or time step, or from rest."""

    def __init__(self, problem: MovingProblem, space: Space, steps: int, start: "Flow | None"):
        self.problem, self.space = problem, space
        self.step = problem.length / steps
        self.factors = None
        self.factorisations = 0
        if start is None:
            first = State(0.0, np.zeros(space.total))
            self.history: deque[State] = deque([first], maxlen=ORDER + 1)
        else:
            self.history = start.continued(space, self.step)

    def continued(self, space: Space, step: float) -> deque[State]:
        """The last states, projected on another mesh, at multiples of a (not longer) time step."""
        moments = np.array([state.time for state in self.history])
        unknowns = np.array([_projected(self.space, state.unknowns, space) for state in self.history])
        states = deque(maxlen=ORDER + 1)
        for back in range(ORDER, -1, -1):
            time = moments[-1] - back * step
            weights = [np.prod([(time - b) / (a - b) for b in moments if b != a]) for a in moments]
            states.append(State(time, np.tensordot(weights, unknowns, 1)))
        return states

    def run(self, steps: int) -> Iterator[State]:
        for _ in range(steps):
            self._advance()
            yield self.history[-1]

    def _advance(self) -> None:
        order = min(ORDER, len(self.history))
        newest = [state.unknowns for state in reversed(self.history)][:order]
        time = self.history[-1].time + self.step
        space = self.space
        past = sum(c * u[: 2 * space.size] for c, u in zip(DERIVATIVE[order][1:], newest, strict=True))
        carrier = sum(c * u[: 2 * space.size] for c, u in zip(EXTRAPOLATION[order], newest, strict=True))
        matrix, inertia = self._system(time, DERIVATIVE[order][0] / self.step, carrier)
        load = np.zeros(space.total)
        for axis in (0, 1):
            part = slice(axis * space.size, (axis + 1) * space.size)
            coefficients = past[part][space.velocity.basis.element_dofs.T]
            local = -np.einsum("eij,ej->ei", inertia, coefficients) / self.step
            load[part] = np.bincount(space.velocity.basis.element_dofs.T.ravel(), local.ravel(), space.size)
        self.history.append(State(time, self._solved(matrix, load, newest)))

    def _system(self, time: float, rate: float, carrier: Array) -> tuple[csc_matrix, Array]:
        """The matrix of a step and the elements' matrices of Re (u, v)."""
        space, problem = self.space, self.problem
        x, eta = space.x, space.eta
        bottom, bottom_slope = problem.bottom(x - time), problem.bottom_slope(x - time)
        gap = problem.top(x) - bottom
        slope = bottom_slope + eta * (problem.top_slope(x) - bottom_slope)
        weights = (space.weights * gap)[:, None, :]
        along = space.phi_x - (slope / gap)[:, None, :] * space.phi_eta
        across = space.phi_eta / gap[:, None, :]
        dofs = space.velocity.basis.element_dofs
        speed_x = space.gather(carrier[: space.size], dofs, space.phi)
        speed_y = space.gather(carrier[space.size :], dofs, space.phi)
        speed_y += (1 - eta) * bottom_slope  # less the mesh's velocity, of which the bottom has -bottom'
        weighted = problem.reynolds * weights * space.phi
        inertia = weighted @ space.phi.transpose(0, 2, 1)
        convection = weighted @ (speed_x[:, None] * along + speed_y[:, None] * across).transpose(0, 2, 1)
        friction = (weights * along) @ along.transpose(0, 2, 1) + (weights * across) @ across.transpose(0, 2, 1)
        momentum = rate * inertia + convection + friction
        psi = (weights * space.psi).transpose(0, 2, 1)
        gradient = [-along @ psi, -across @ psi]
        parts = [momentum, momentum, *gradient, *(g.transpose(0, 2, 1) for g in gradient)]
        return space.matrix(parts), inertia

    def _solved(self, matrix: csc_matrix, load: Array, newest: list[Array]) -> Array:
        """The unknowns with the walls' velocities and the mean of the pressure as they should be."""
        space = self.space
        walls = np.concatenate([space.top_dofs, space.bottom_dofs])
        fixed = np.concatenate([walls, space.size + walls, [2 * space.size]])
        free = np.setdiff1d(np.arange(space.total), fixed)
        unknowns = sum(c * u for c, u in zip(EXTRAPOLATION[len(newest)], newest, strict=True))
        unknowns[fixed] = 0
        unknowns[np.intersect1d(space.bottom_dofs, space.velocity.basis.nodal_dofs)] = 1
        residual = (load - matrix @ unknowns)[free]
        unknowns[free] += self._corrected(matrix[free][:, free], residual, np.abs(load).max())
        if not np.isfinite(unknowns).all():
            raise ReferenceError(f"the flow has no solution at time {self.history[-1].time:.4g}")
        return unknowns

    def _corrected(self, matrix: csc_matrix, residual: Array, scale: float) -> Array:
        """Solves by GMRES, with the factors of an earlier step as long as they help."""
        for attempt in range(2):
            if self.factors is None:
                self.factors = self._factors(matrix)
            operator = LinearOperator(matrix.shape, self.factors.solve)
            size = max(float(np.linalg.norm(residual)), 1e-300)
            solution, missed = gmres(
                matrix, residual, M=operator, rtol=RESIDUAL, atol=RESIDUAL, maxiter=1, restart=MOST_ITERATIONS
            )
            if missed == 0:
                return solution
            self.factors = None
        return solution

    def _factors(self, matrix: csc_matrix) -> object:
        self.factorisations += 1
        shift = diags(np.where(matrix.diagonal() == 0, -COMPRESSIBILITY, 0.0))
        ordering = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
        return splu((matrix + shift).tocsc(), **ordering)


def _projected(source: Space, unknowns: Array, target: Space) -> Array:
    """The same functions of (x, eta) on another mesh."""
    if source is target:
        return unknowns
    sizes = (source.size, source.size, source.pressures)
    pieces = np.split(unknowns, np.cumsum(sizes)[:-1])
    result = []
    for piece, own, other in zip(pieces, (source.velocity,) * 2 + (source.pressure,), (target.velocity,) * 2 + (target.pressure,), strict=True):
        nodal = own.nodal(piece, source.polynomials)
        values = source.polynomials.at(nodal[None], target.x.ravel(), target.eta.ravel()).reshape(target.x.shape)
        result.append(other.basis.project(values))
    return np.concatenate(result)
