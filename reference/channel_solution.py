"""The finite-element solver of channel_navier_stokes.py, whose docstring has equations and weak form."""

import logging
from dataclasses import dataclass

import numpy as np
from scipy.sparse import bmat, csc_matrix, csr_matrix, diags
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, LinearForm, MeshQuad1DG
from skfem.helpers import dot, grad

from reference.base import Array, ReferenceError
from reference.channel_mesh import Channel, ChannelMapping, Elements, Polynomials, mesh_lines

DEGREE = 4  # of the velocity; the pressure's is one less
PER_GAP = 2  # elements a gap on the coarsest mesh
KINK_SIZE = 1e-2  # smallest element at a kink, in mean gaps, on the coarsest mesh
logging.getLogger("skfem").setLevel(logging.ERROR)  # it warns of its own memory layouts
# Newton's error is about the square of its last step, so 1e-6 leaves rounding only.
LAST_STEP = 1e-6
MOST_STEPS = 15
# Put on the zero diagonal of the pressure, so that no pivot vanishes; far below the Schur complement.
COMPRESSIBILITY = 1e-10


stiffness = BilinearForm(lambda u, v, w: dot(grad(u), grad(v)))
convection = BilinearForm(lambda u, v, w: (w.x_speed * grad(u)[0] + w.y_speed * grad(u)[1]) * v)
weighted_mass = BilinearForm(lambda u, v, w: w.weight * u * v)
divergence_x = BilinearForm(lambda u, q, w: grad(u)[0] * q)
divergence_y = BilinearForm(lambda u, q, w: grad(u)[1] * q)
load = LinearForm(lambda v, w: v)


def solve_saddle_point(matrix: csc_matrix, load: Array) -> Array:
    """LU without pivoting of the slightly compressible matrix, and iterative refinement with the true one.

    Its fill is that of a symmetric ordering, a quarter of what pivoting costs, in a tenth of the time.
    """
    shift = diags(np.where(matrix.diagonal() == 0, -COMPRESSIBILITY, 0.0))
    ordering = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    factors = splu((matrix + shift).tocsc(), **ordering)
    solution = factors.solve(load)
    for _ in range(5):
        solution += factors.solve(load - matrix @ solution)
    return solution


@dataclass(frozen=True)
class Problem:
    """The flow in the units above."""

    channel: Channel
    reynolds: float
    force: tuple[float, float]
    speeds: tuple[float, float]  # of bottom and top along x


class Solution:
    """Newton's solution on one mesh, and what is wanted of it as piecewise polynomials."""

    def __init__(self, problem: Problem, refinement: int, guess: "Solution | None"):
        self.problem = problem
        lines = mesh_lines(problem.channel, PER_GAP, KINK_SIZE, refinement)
        self.polynomials = Polynomials(*lines, DEGREE)
        mesh = MeshQuad1DG.init_tensor(*lines, periodic=[0])
        mapping = ChannelMapping(mesh, problem.channel)
        self.elements = mesh.nelements
        self.velocity = Elements(mesh, mapping, DEGREE, DEGREE + 2)
        self.pressure = Elements(mesh, mapping, DEGREE - 1, DEGREE + 2)
        self.size = self.velocity.basis.N
        self.walls = [self.velocity.wall(top) for top in (False, True)]
        self.wall_dofs = [self._trace_dofs(wall) for wall in self.walls]
        self._assemble_linear()
        self._newton(self._start(guess))
        self._collect()

    def _trace_dofs(self, wall: Basis) -> Array:
        present = [np.abs(np.asarray(function[0])).max() > 1e-12 for function in wall.basis]
        return np.unique(wall.element_dofs[present])

    def _assemble_linear(self) -> None:
        u, p = self.velocity.basis, self.pressure.basis
        self.stiffness = stiffness.assemble(u)
        self.divergence = [form.assemble(u, p) for form in (divergence_x, divergence_y)]
        body = load.assemble(u)
        self.load = [force * body for force in self.problem.force]
        self.area_weights = load.assemble(p)

    def _start(self, guess: "Solution | None") -> Array:
        """Rest, or the solution of the coarser mesh, with the walls' velocities on the walls."""
        state = np.zeros(2 * self.size + self.pressure.basis.N)
        ux, uy, p = self._parts(state)
        if guess is not None:
            spaces = (self.velocity, self.velocity, self.pressure)
            for part, space, values in zip((ux, uy, p), spaces, guess.on_quadrature(self), strict=True):
                part[:] = space.basis.project(values)
        for dofs, speed in zip(self.wall_dofs, self.problem.speeds, strict=True):
            ux[dofs] = uy[dofs] = 0
            ux[np.intersect1d(dofs, self.velocity.basis.nodal_dofs)] = speed
        return state

    def on_quadrature(self, other: "Solution") -> Array:
        """Velocity and pressure at the quadrature points of another mesh (3, elements, points)."""
        x, eta = other.velocity.mapping.affine.F(other.velocity.basis.X)
        return self.polynomials.at(self.fields, x.ravel(), eta.ravel()).reshape(3, *x.shape)

    def square_norms(self, values: Array) -> Array:
        """Integrals over the channel of squares of values (fields, elements, quadrature points)."""
        return np.sum(values**2 * self.velocity.basis.dx, axis=(1, 2))

    def _parts(self, state: Array) -> tuple[Array, Array, Array]:
        return state[: self.size], state[self.size : 2 * self.size], state[2 * self.size :]

    def _momentum(self, state: Array, jacobian: bool) -> tuple[Array, list[list[csr_matrix]] | None]:
        """Residual of the momentum equation, for every test function, and its derivative by velocity."""
        basis = self.velocity.basis
        ux, uy, p = self._parts(state)
        at_points = [basis.interpolate(u) for u in (ux, uy)]
        transport = self.stiffness + self.problem.reynolds * convection.assemble(
            basis, x_speed=np.asarray(at_points[0]), y_speed=np.asarray(at_points[1])
        )
        residual = np.concatenate(
            [
                transport @ u - d.T @ p - f
                for u, d, f in zip((ux, uy), self.divergence, self.load, strict=True)
            ]
        )
        if not jacobian:
            return residual, None
        blocks = [
            [self.problem.reynolds * weighted_mass.assemble(basis, weight=u.grad[axis]) for axis in (0, 1)]
            for u in at_points
        ]
        blocks[0][0] = blocks[0][0] + transport
        blocks[1][1] = blocks[1][1] + transport
        return residual, blocks

    def _newton(self, state: Array) -> None:
        """Velocities on the walls and one pressure are held; the pressure's mean is removed at the end."""
        fixed = np.concatenate([[d, self.size + d] for d in self.wall_dofs], axis=None)
        fixed = np.append(fixed, 2 * self.size)
        free = np.setdiff1d(np.arange(len(state)), fixed)
        for _ in range(MOST_STEPS):
            momentum, blocks = self._momentum(state, jacobian=True)
            ux, uy, _ = self._parts(state)
            continuity = self.divergence[0] @ ux + self.divergence[1] @ uy
            residual = np.concatenate((momentum, -continuity))
            dx, dy = self.divergence
            jacobian = bmat([[*blocks[0], -dx.T], [*blocks[1], -dy.T], [-dx, -dy, None]], "csc")
            step = solve_saddle_point(jacobian[free][:, free], -residual[free])
            state[free] += step
            if not np.isfinite(step).all():
                break
            if np.abs(step).max() <= LAST_STEP * np.abs(state).max():
                self.state = self._without_mean(state)
                return
        raise ReferenceError(
            f"Newton's iteration found no steady flow at Reynolds number {self.problem.reynolds:.3g}"
        )

    def _without_mean(self, state: Array) -> Array:
        pressure = self._parts(state)[2]
        nodal = np.unique(self.pressure.basis.nodal_dofs)
        pressure[nodal] -= self.area_weights @ pressure / self.velocity.basis.dx.sum()
        return state

    def _collect(self) -> None:
        ux, uy, p = self._parts(self.state)
        spaces = (self.velocity, self.velocity, self.pressure)
        self.fields = np.array(
            [s.nodal(c, self.polynomials) for s, c in zip(spaces, (ux, uy, p), strict=True)]
        )
        residual, _ = self._momentum(self.state, jacobian=False)
        self.tractions = np.array([self._traction(residual, top) for top in (False, True)])

    def _traction(self, residual: Array, top: bool) -> Array:
        """Pressure and shear of a wall at the nodes in x (2, nodes)."""
        wall, dofs = self.walls[top], self.wall_dofs[top]
        channel = self.problem.channel
        x, _ = self.velocity.mapping.affine.F(wall.X, wall.tind)
        slope = (channel.top_slope if top else channel.bottom_slope)(x)
        # dS (normal out of the fluid) = sign (-slope, 1) dx and dS (tangent) = (1, slope) dx; dx is the area
        # of the quadrature point over the height of its element.
        sign = 1.0 if top else -1.0
        height = np.abs(self.velocity.mapping.detDF(wall.X, wall.tind)) / self._width(wall)
        normal = [-sign * slope / height, sign / height]
        tangent = [1 / height, slope / height]
        matrix = [
            [weighted_mass.assemble(wall, weight=w)[dofs][:, dofs] for w in (-normal[axis], tangent[axis])]
            for axis in (0, 1)
        ]
        loads = np.concatenate([residual[dofs], residual[self.size + dofs]])
        traction = splu(bmat(matrix, "csc")).solve(loads)
        edge = -1 if top else 0
        values = np.zeros((2, self.size))
        values[:, dofs] = traction.reshape(2, -1)
        return np.array([self.velocity.nodal(v, self.polynomials)[:, edge] for v in values])

    def _width(self, wall: Basis) -> Array:
        """Widths of the elements along a wall (elements, 1)."""
        ends = self.velocity.mapping.affine.F(np.array([[0.5, 0.5], [0.0, 1.0]]), wall.tind)[0]
        return ends[:, 1:] - ends[:, :1]
