"""Torque on a disc that turns steadily in the middle of a square box, by finite elements.

Stokes' equations, disc of radius R and spin W, box of side L, no slip on both:
    -div(2 mu e(u)) + grad p = 0,   div u = 0,   u = W x r on the disc,   u = 0 on the box.
By symmetry a quarter is enough: on the axes x = 0 and y = 0 the velocity along the axis and the traction
across it vanish. Weak form: for all (v, q), v = 0 on disc and box, without component along an axis on it,
    (2 mu e(u), e(v)) - (p, div v) - (q, div u) = 0.
Torque from the power it spends: T W = -(2 mu e(u), e(u)), which converges twice as fast as u itself.
Mesh: rays from the centre and rings between rim and box, the corner on a ray; quadrilaterals with quadratic
edges; velocity of degree 2, pressure of degree 1 (Taylor-Hood: boffi2013, Sec. 8.8), with scikit-fem
(gustafsson2020).

Inertia: a reversed spin reverses the torque, so its first correction is of order Re^2, Re = W R^2 / nu;
Re above MOST_REYNOLDS is refused.
Own convergence: MESHES meshes, each halving the one before; the error estimate is the last relative change.
`python -m reference.make disc_rotating` prints it.
"""

import dataclasses
import math
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import skfem
from scipy.sparse import bmat, csr_matrix
from skfem import Basis, BilinearForm, ElementQuad1, ElementQuad2, ElementVector, MeshQuad, MeshQuad2
from skfem.helpers import ddot, div, sym_grad

from reference import base
from reference import scene as scenes
from reference.base import Array, digest_of
from reference.scene import Scene

NAME = "rotating_disc"
MESHES = 3
MOST_REYNOLDS = 0.2
ROUNDING = 1e-9  # of the box


def square(angle: Array) -> Array:
    """Distance from the centre of a square to its edge, over half its side, along rays in [0, pi / 2]."""
    return 1 / np.maximum(np.cos(angle), np.sin(angle))


def mesh(radius: float, outer: Callable[[Array], Array], refinement: int) -> MeshQuad2:
    """The quarter between the disc and the curve `outer`, a distance for each angle."""
    lines = np.linspace(0, 1, 4 * 2**refinement + 1)
    quarter = MeshQuad2.from_mesh(MeshQuad.init_tensor(lines, math.pi / 2 * lines))
    sides = {
        "disc": lambda at: at[0] < ROUNDING,
        "box": lambda at: at[0] > 1 - ROUNDING,
        "x_axis": lambda at: at[1] < ROUNDING,
        "y_axis": lambda at: at[1] > math.pi / 2 - ROUNDING,
    }
    share, angle = quarter.doflocs
    distance = radius + share * (outer(angle) - radius)
    places = distance * np.array([np.cos(angle), np.sin(angle)])
    return dataclasses.replace(quarter.with_boundaries(sides), doflocs=places)


@BilinearForm
def dissipation(u: Array, v: Array, _: Array) -> Array:
    return 2 * ddot(sym_grad(u), sym_grad(v))


@BilinearForm
def divergence(u: Array, q: Array, _: Array) -> Array:
    return div(u) * q


def stokes(mesh: MeshQuad2) -> tuple[Basis, csr_matrix, csr_matrix]:
    """Velocity's basis and stiffness, and the matrix of velocity and pressure together, all over mu."""
    velocity = Basis(mesh, ElementVector(ElementQuad2()), intorder=6)
    pressure = velocity.with_element(ElementQuad1())
    stiffness, coupling = dissipation.assemble(velocity), divergence.assemble(velocity, pressure)
    return velocity, stiffness, bmat([[stiffness, -coupling.T], [-coupling, None]], "csr")


def torque(quarter: MeshQuad2) -> float:
    """The torque that keeps the disc of the mesh turning, over mu W: in the square of the mesh's unit."""
    velocity, stiffness, matrix = stokes(quarter)
    x, y = velocity.doflocs
    value = np.zeros(matrix.shape[0])
    rim = {axis: velocity.get_dofs("disc").all(axis) for axis in ("u^1", "u^2")}
    value[rim["u^1"]], value[rim["u^2"]] = -y[rim["u^1"]], x[rim["u^2"]]
    along_axes = [velocity.get_dofs("x_axis").all("u^1"), velocity.get_dofs("y_axis").all("u^2")]
    fixed = np.unique(np.concatenate([*rim.values(), velocity.get_dofs("box").all(), *along_axes]))
    flow = skfem.solve(*skfem.condense(matrix, np.zeros_like(value), x=value, D=fixed))[: velocity.N]
    return 4 * float(flow @ stiffness @ flow)


class RotatingDisc:
    kind = "finite-element"
    source = "Stokes flow around a turning disc in a square box, Q2/Q1 finite elements (gustafsson2020)"

    def __init__(self, scene: Scene):
        started = time.perf_counter()
        self.scene, self.turning = scene, self._check(scene)
        half = scene.size[0] / 2
        ratio = self.turning.radius / half
        meshes = [mesh(ratio, square, refinement) for refinement in range(MESHES)]
        self.sizes = [quarter.nelements for quarter in meshes]
        self.torques = np.array([torque(quarter) for quarter in meshes]) / ratio**2  # over mu W R^2
        self.changes = np.abs(np.diff(self.torques)) / self.torques[-1]
        self.error_estimate = float(self.changes[-1])
        unit = scene.dynamic_viscosity * self.turning.spin * self.turning.radius**2
        self.torque = -float(self.torques[-1]) * unit  # of the fluid on the disc, N
        scripts = (Path(base.__file__), Path(scenes.__file__), Path(__file__))
        self.digest = digest_of(NAME, scene.flow(), scripts)
        self.seconds = time.perf_counter() - started

    @staticmethod
    def _check(scene: Scene) -> scenes.DiscScene:
        width, height = scene.size
        boxed = len(scene.walls) == 4 and all(
            wall.shape == "line" and wall.velocity == (0.0, 0.0) for wall in scene.walls
        )
        if not boxed or scene.periodic != "none" or not math.isclose(width, height, rel_tol=ROUNDING):
            raise scene.refuse(f"{NAME} needs a square box of four lines at rest")
        if len(scene.discs) != 1 or scene.discs[0].motion != "prescribed" or scene.discs[0].spin == 0:
            raise scene.refuse(f"{NAME} needs one disc with motion = 'prescribed' and a spin")
        disc = scene.discs[0]
        middle = [(low + high) / 2 for low, high in zip(scene.lower, scene.upper, strict=True)]
        if math.dist(disc.position, middle) > ROUNDING * width or disc.velocity != (0.0, 0.0):
            raise scene.refuse(f"{NAME} needs the disc in the middle of the box, without velocity")
        if not 2 * disc.radius < width:
            raise scene.refuse(f"{NAME}: the disc does not fit into the box")
        reynolds = abs(disc.spin) * disc.radius**2 / scene.kinematic_viscosity
        if reynolds > MOST_REYNOLDS or scene.body_force != (0.0, 0.0):
            raise scene.refuse(f"{NAME} needs no body force and Re of at most {MOST_REYNOLDS}: {reynolds:g}")
        return disc

    def disc(self, name: str, quantity: str, t: Array) -> Array:
        """The steady torque (n,) of the fluid on the disc, N, at times t (n,), whatever they are."""
        if name != self.turning.name or quantity != "torque":
            raise self.scene.refuse(f"{NAME} knows the torque on {self.turning.name} only")
        return np.full(np.shape(t), self.torque)

    def error_table(self) -> str:
        """The convergence of the meshes, as text."""
        rows = ["elements  torque / (mu W R^2)   change"]
        for size, value, change in zip(self.sizes, self.torques, [None, *self.changes], strict=True):
            rows.append(f"{size:8d}  {value:19.8f}  {'-' if change is None else f'{change:.1e}':>7}")
        return "\n".join(rows)


def create(scene: Scene, cache: Path) -> RotatingDisc:
    return RotatingDisc(scene)
