"""The time stepping of moving_channel.py, whose docstring has equations and weak form."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import LinearOperator, SuperLU, gmres, splu
from skfem import MeshQuad1DG

from reference.base import Array, ReferenceError
from reference.channel_mesh import Channel, ChannelMapping, Elements, Polynomials, joined_lines
from reference.channel_solution import DEGREE
from reference.walls import Function

PER_GAP = 3  # elements across the narrowest gap on the coarsest mesh
# Of the factored matrix, per pressure mass: pivots do not vanish, and a few iterations undo it.
COMPRESSIBILITY = 1e-5
GRADING = 1.5  # growth of elements over the distance to a corner
KINK_SIZE = 2e-3  # smallest element at a kink, in mean gaps, on the coarsest mesh
DERIVATIVE = {1: (1, -1), 2: (3 / 2, -2, 1 / 2), 3: (11 / 6, -3, 3 / 2, -1 / 3)}  # of BDF, newest first
EXTRAPOLATION = {1: (1,), 2: (2, -1), 3: (3, -3, 1)}
ORDER = 3
RESIDUAL = 1e-6  # relative, of the correction of the extrapolated state
SMALLEST = 1e-11  # absolute
MOST_ITERATIONS = 16  # with an old factorisation, before a new one is made


@dataclass(frozen=True)
class MovingProblem:
    """Without dimensions: the mean gap, the moving wall's speed U and eta U / gap are the units.

    The top is at rest; the bottom is bottom(x - direction t).
    """

    start: float
    length: float
    bottom: Function
    top: Function
    bottom_slope: Function
    top_slope: Function
    highest: float  # of the bottom
    kinks: tuple[tuple[float, bool], ...]  # of the top: x, and whether the corner points into the fluid
    reynolds: float
    direction: float  # 1 or -1

    def lines(self, refinement: int) -> tuple[Array, Array]:
        """Mesh lines for the narrowest gap that passes each x, crowding towards corners that point into the
        fluid; elsewhere the solution is smooth enough.
        """

        def x_size(x: Array) -> Array:
            size = (self.top(x) - self.highest) / PER_GAP
            for kink, sharp in self.kinks:
                if sharp:
                    size = np.minimum(size, GRADING * self.distance(x, kink) + KINK_SIZE)
            return size

        def eta_size(eta: Array) -> Array:
            size = np.full(np.shape(eta), 1 / PER_GAP)
            if any(sharp for _, sharp in self.kinks):
                size = np.minimum(size, GRADING * (1 - eta) + KINK_SIZE)
            return size

        end = self.start + self.length
        inner = sorted(x for x, _ in self.kinks if self.start < x < end)
        x_lines = joined_lines([self.start, *inner, end], x_size, refinement)
        return x_lines, joined_lines([0.0, 1.0], eta_size, refinement)

    def distance(self, x: Array, other: float) -> Array:
        """Along the periodic channel."""
        away = np.abs(x - other)
        return np.minimum(away, self.length - away)


class Space:
    """Velocity and pressure on the rectangle (x, eta), and the pattern of the matrix of a step."""

    def __init__(self, problem: MovingProblem, refinement: int):
        self.lines = lines = problem.lines(refinement)
        self.polynomials = Polynomials(*lines, DEGREE)
        mesh = MeshQuad1DG.init_tensor(*lines, periodic=[0])
        self.rectangle = ChannelMapping(mesh, _rectangle(problem))
        self.velocity = Elements(mesh, self.rectangle, DEGREE, DEGREE + 2)
        self.pressure = Elements(mesh, self.rectangle, DEGREE - 1, DEGREE + 2)
        self.pressure_polynomials = Polynomials(*lines, DEGREE - 1)
        self.weights = self.velocity.basis.dx
        self.x, self.eta = self.rectangle.affine.F(self.velocity.basis.X)
        self.phi, self.phi_x, self.phi_eta = _shape_functions(self.velocity)
        self.psi = _shape_functions(self.pressure)[0]
        self.size, self.pressures = self.velocity.basis.N, self.pressure.basis.N
        self.top_dofs, self.bottom_dofs = (self._wall_dofs(top) for top in (True, False))
        self.set_pattern()

    def _wall_dofs(self, top: bool) -> Array:
        wall = self.velocity.wall(top)
        present = [np.abs(np.asarray(function[0])).max() > 1e-12 for function in wall.basis]
        return np.unique(wall.element_dofs[present])

    def set_pattern(self) -> None:
        """Where the entries of the elements' matrices go in the matrix of all unknowns, and of the free ones:
        velocities on the walls and one pressure are held.
        """
        u = self.velocity.basis.element_dofs.T
        p = self.pressure.basis.element_dofs.T + 2 * self.size
        v = u + self.size
        blocks = [(u, u), (v, v), (u, p), (v, p), (p, u), (p, v)]  # rows and columns (elements, functions)
        rows = np.concatenate([np.repeat(r, c.shape[1], axis=1).ravel() for r, c in blocks])
        columns = np.concatenate([np.tile(c, (1, r.shape[1])).ravel() for r, c in blocks])
        total = 2 * self.size + self.pressures
        keys, self.place = np.unique(columns.astype(np.int64) * total + rows, return_inverse=True)
        self.indices = keys % total
        self.pointers = np.searchsorted(keys, np.arange(total + 1, dtype=np.int64) * total)
        self.total = total
        walls = np.concatenate([self.top_dofs, self.bottom_dofs])
        self.fixed = np.concatenate([walls, self.size + walls, [2 * self.size]])
        self.free = np.setdiff1d(np.arange(total), self.fixed)
        self.kept = np.flatnonzero(np.isin(self.indices, self.free) & np.isin(keys // total, self.free))
        self.kept_indices = np.searchsorted(self.free, self.indices[self.kept])
        column = np.searchsorted(self.free, keys[self.kept] // total)
        mass = np.einsum("eiq,eq->ei", self.psi**2, self.weights)
        masses = np.bincount(self.pressure.basis.element_dofs.T.ravel(), mass.ravel(), self.pressures)
        self.compressibility = COMPRESSIBILITY * np.concatenate([np.zeros(2 * self.size), masses])[self.free]
        self.kept_pointers = np.searchsorted(column, np.arange(len(self.free) + 1))

    def matrix(self, parts: list[Array]) -> csc_matrix:
        """Of the elements' matrices in the order of the blocks."""
        values = np.concatenate([part.ravel() for part in parts])
        data = np.bincount(self.place, weights=values, minlength=len(self.indices))
        return csc_matrix((data, self.indices, self.pointers), shape=(self.total, self.total))

    def reduced(self, matrix: csc_matrix) -> csc_matrix:
        """The matrix of the free unknowns."""
        size = len(self.free)
        return csc_matrix((matrix.data[self.kept], self.kept_indices, self.kept_pointers), shape=(size, size))

    def pressure_nodes(self, problem: MovingProblem, state: "State") -> Array:
        """Pressure, mean zero over the channel, at the nodes of pressure_polynomials."""
        coefficients = state.unknowns[2 * self.size :]
        gap = problem.top(self.x) - problem.bottom(self.x - problem.direction * state.time)
        weights = self.weights * gap
        values = self.gather(coefficients, self.pressure.basis.element_dofs, self.psi)
        nodes = self.pressure.nodal(coefficients, self.pressure_polynomials)
        return nodes - np.sum(values * weights) / np.sum(weights)

    def gather(self, values: Array, basis_dofs: Array, functions: Array) -> Array:
        """A function of coefficients `values` at the quadrature points (elements, points)."""
        return np.einsum("ei,eiq->eq", values[basis_dofs.T], functions)


def _rectangle(problem: MovingProblem) -> Channel:
    def constant(value: float) -> Function:
        return lambda x: np.full(np.shape(x), value)

    zero, one = constant(0.0), constant(1.0)
    return Channel(problem.start, problem.length, zero, one, zero, zero, ())


def _shape_functions(elements: Elements) -> tuple[Array, Array, Array]:
    """Values and derivatives by x and eta (elements, functions, points)."""
    basis = elements.basis

    def stacked(parts: list[Array]) -> Array:
        return np.stack([np.broadcast_to(part, basis.dx.shape) for part in parts], axis=1)

    functions = [function[0] for function in basis.basis]
    values = stacked([np.asarray(function) for function in functions])
    return values, *(stacked([function.grad[axis] for function in functions]) for axis in (0, 1))


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
        shifted = x - problem.direction * time
        bottom, bottom_slope = problem.bottom(shifted), problem.bottom_slope(shifted)
        gap = problem.top(x) - bottom
        slope = bottom_slope + eta * (problem.top_slope(x) - bottom_slope)
        weights = (space.weights * gap)[:, None, :]
        along = space.phi_x - (slope / gap)[:, None, :] * space.phi_eta  # derivatives by x and y
        across = space.phi_eta / gap[:, None, :]
        dofs = space.velocity.basis.element_dofs
        speed_x = space.gather(carrier[: space.size], dofs, space.phi)
        speed_y = space.gather(carrier[space.size :], dofs, space.phi)
        speed_y += (1 - eta) * problem.direction * bottom_slope  # less the mesh's velocity
        weighted = problem.reynolds * weights * space.phi
        inertia = weighted @ _transposed(space.phi)
        convection = weighted @ _transposed(speed_x[:, None] * along + speed_y[:, None] * across)
        friction = (weights * along) @ _transposed(along) + (weights * across) @ _transposed(across)
        momentum = rate * inertia + convection + friction
        psi = _transposed(weights * space.psi)
        gradient = [-along @ psi, -across @ psi]
        parts = [momentum, momentum, *gradient, *map(_transposed, gradient)]
        return space.matrix(parts), inertia

    def _solved(self, matrix: csc_matrix, load: Array, newest: list[Array]) -> Array:
        """The unknowns with the walls' velocities and the mean of the pressure as they should be."""
        space = self.space
        unknowns = sum(c * u for c, u in zip(EXTRAPOLATION[len(newest)], newest, strict=True))
        unknowns[space.fixed] = 0
        unknowns[np.intersect1d(space.bottom_dofs, space.velocity.basis.nodal_dofs)] = self.problem.direction
        residual = (load - matrix @ unknowns)[space.free]
        unknowns[space.free] += self._corrected(space.reduced(matrix), residual)
        return unknowns

    def _corrected(self, matrix: csc_matrix, residual: Array) -> Array:
        """Solves by GMRES, with the factors of an earlier step as long as they help."""
        for factors in (self.factors, None):
            self.factors = factors or _factors(matrix, self.space.compressibility)
            operator = LinearOperator(matrix.shape, self.factors.solve)
            solution, missed = gmres(
                matrix, residual, M=operator, rtol=RESIDUAL, atol=SMALLEST, maxiter=3, restart=MOST_ITERATIONS
            )
            if missed == 0:
                return solution
        raise ReferenceError(f"no convergence of a step after time {self.history[-1].time:.4g}")


def _factors(matrix: csc_matrix, compressibility: Array) -> SuperLU:
    """Without pivoting: the fill is that of a symmetric ordering."""
    ordering = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    return splu((matrix - diags(compressibility)).tocsc(), **ordering)


def _transposed(matrices: Array) -> Array:
    return matrices.transpose(0, 2, 1)


def _projected(source: Space, unknowns: Array, target: Space) -> Array:
    """The same functions of (x, eta) on another mesh."""
    if source is target:
        return unknowns
    pieces = np.split(unknowns, [source.size, 2 * source.size])
    own = (source.velocity, source.velocity, source.pressure)
    other = (target.velocity, target.velocity, target.pressure)
    nodal = np.array([e.nodal(piece, source.polynomials) for e, piece in zip(own, pieces, strict=True)])
    values = source.polynomials.at(nodal, target.x.ravel(), target.eta.ravel()).reshape(3, *target.x.shape)
    return np.concatenate([e.basis.project(value) for e, value in zip(other, values, strict=True)])
