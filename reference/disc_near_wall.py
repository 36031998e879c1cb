"""Force and torque on a disc that is held between two walls of which one slides by, by finite elements.

Stokes' equations, periodic in x with period L:
    -div(2 mu e(u)) + grad p = 0,   div u = 0,   u = (U, 0) on one wall,   u = 0 on disc and other wall.
Seen in a mirror at the disc's centre line the flow is its own reverse: on the lines half a period apart
through the centre and between two discs, u_y and the traction across vanish, and half a period is enough.
Weak form: for all (v, q), v = 0 on disc and walls, v_y = 0 on the two lines,
    (2 mu e(u), e(v)) - (p, div v) - (q, div u) = 0.
Force and torque are the residual of the momentum equation for test functions that are a unit velocity, or
spin, on the rim (consistent flux: gresho1987).
Mesh: rays from the centre and rings between rim and walls, the corners on rays; elements as in
rotating_disc.py.

Inertia: a reversed wall reverses the force, so its first correction is of order Re^2, Re = U R / nu; Re above
MOST_REYNOLDS is refused.
Own convergence: MESHES meshes, each halving the one before; the error estimate is the last relative change.
`python -m reference.make disc_near_wall` prints it.
"""

import dataclasses
import math
import time
from pathlib import Path

import numpy as np
import skfem
from skfem import MeshQuad, MeshQuad2

from reference import base, rotating_disc
from reference import scene as scenes
from reference.base import Array, digest_of
from reference.rotating_disc import MOST_REYNOLDS, ROUNDING, stokes
from reference.scene import Scene

NAME = "disc_near_wall"
MESHES = 3
PER_PIECE = (6, 8, 6)  # rays between line and corner, corner and corner, corner and line
RINGS = 4


def half_period(below: float, above: float, half: float, refinement: int) -> MeshQuad2:
    """The half to the right of a disc of radius 1, from `below` to `above` its centre and `half` wide."""
    corners = [-math.pi / 2, -math.atan2(below, half), math.atan2(above, half), math.pi / 2]
    pieces = [
        np.linspace(start, end, count * 2**refinement + 1)
        for start, end, count in zip(corners, corners[1:], PER_PIECE, strict=False)
    ]
    rays = np.unique(np.concatenate(pieces).round(14))
    grid = MeshQuad2.from_mesh(MeshQuad.init_tensor(np.linspace(0, 1, RINGS * 2**refinement + 1), rays))
    sides = {
        "disc": lambda at: at[0] < ROUNDING,
        "bottom": lambda at: (at[0] > 1 - ROUNDING) & (at[1] < corners[1]),
        "middle": lambda at: (at[0] > 1 - ROUNDING) & (corners[1] < at[1]) & (at[1] < corners[2]),
        "top": lambda at: (at[0] > 1 - ROUNDING) & (at[1] > corners[2]),
        "line": lambda at: np.abs(at[1]) > math.pi / 2 - ROUNDING,
    }
    share, angle = grid.doflocs
    cosine, sine = np.cos(angle), np.sin(angle)
    with np.errstate(divide="ignore"):
        to_wall = np.where(sine > 0, above, below) / np.abs(sine)
        distance = np.minimum(to_wall, half / np.maximum(cosine, 0))
    places = (1 + share * (distance - 1)) * np.array([cosine, sine])
    return dataclasses.replace(grid.with_boundaries(sides), doflocs=places)


def force_and_torque(half: MeshQuad2, sliding: str) -> Array:
    """Of the fluid on the whole disc, (2,) over mu U and mu U R, when the wall of that name slides at U."""
    velocity, _, matrix = stokes(half)
    value = np.zeros(matrix.shape[0])
    value[velocity.get_dofs(sliding).all("u^1")] = 1
    held = [velocity.get_dofs(side).all() for side in ("disc", "bottom", "top")]
    across = [velocity.get_dofs(side).all("u^2") for side in ("line", "middle")]
    fixed = np.unique(np.concatenate(held + across))
    state = skfem.solve(*skfem.condense(matrix, np.zeros_like(value), x=value, D=fixed))
    residual = (matrix @ state)[: velocity.N]
    along, up = (velocity.get_dofs("disc").all(axis) for axis in ("u^1", "u^2"))
    x, y = velocity.doflocs
    turned = x[up] @ residual[up] - y[along] @ residual[along]
    return -2 * np.array([residual[along].sum(), turned])


class DiscNearWall:
    kind = "finite-element"
    source = "Stokes flow around a disc near a sliding wall, Q2/Q1 finite elements (gustafsson2020)"

    def __init__(self, scene: Scene):
        started = time.perf_counter()
        self.scene = scene
        self.held, self.sliding = self._check(scene)
        radius, centre = self.held.radius, self.held.position[1]
        box = (centre - scene.lower[1], scene.upper[1] - centre, scene.size[0] / 2)
        side = "top" if self.sliding.fluid_side == "below" else "bottom"
        meshes = [half_period(*(length / radius for length in box), n) for n in range(MESHES)]
        self.sizes = [half.nelements for half in meshes]
        self.values = np.array([force_and_torque(half, side) for half in meshes])
        self.changes = np.abs(np.diff(self.values, axis=0) / self.values[-1])
        self.error_estimate = float(self.changes[-1].max())
        unit = scene.dynamic_viscosity * self.sliding.velocity[0]
        self.force, self.torque = self.values[-1] * unit * np.array([1, radius])  # N/m and N
        scripts = (Path(base.__file__), Path(scenes.__file__), Path(rotating_disc.__file__), Path(__file__))
        self.digest = digest_of(NAME, scene.flow(), scripts)
        self.seconds = time.perf_counter() - started

    @staticmethod
    def _check(scene: Scene) -> tuple[scenes.DiscScene, scenes.WallScene]:
        moving = [wall for wall in scene.walls if wall.velocity != (0.0, 0.0)]
        flat = len(scene.walls) == 2 and all(wall.shape == "line" for wall in scene.walls)
        if not flat or scene.periodic != "x" or len(moving) != 1 or moving[0].velocity[1] != 0:
            raise scene.refuse(f"{NAME} needs a domain periodic in x between two lines, one of which slides")
        if len(scene.discs) != 1 or scene.discs[0].motion != "fixed" or scene.body_force != (0.0, 0.0):
            raise scene.refuse(f"{NAME} needs one disc, fixed, and no body force")
        disc = scene.discs[0]
        apart = min(disc.position[1] - scene.lower[1], scene.upper[1] - disc.position[1], scene.size[0] / 2)
        if not disc.radius < apart:
            raise scene.refuse(f"{NAME}: the disc does not fit between the walls, or touches the next one")
        reynolds = abs(moving[0].velocity[0]) * disc.radius / scene.kinematic_viscosity
        if reynolds > MOST_REYNOLDS:
            raise scene.refuse(f"{NAME} needs Re of at most {MOST_REYNOLDS}: {reynolds:g}")
        return disc, moving[0]

    def disc(self, name: str, quantity: str, t: Array) -> Array:
        """The steady force (n, 2), N/m, or torque (n,), N, of the fluid on the disc at times t (n,)."""
        if name == self.held.name and quantity == "torque":
            return np.full(np.shape(t), self.torque)
        if name == self.held.name and quantity == "force":
            return np.tile([self.force, np.nan], (*np.shape(t), 1))
        raise self.scene.refuse(f"{NAME} knows force along x and torque on {self.held.name} only")

    def error_table(self) -> str:
        """The convergence of the meshes, as text."""
        rows = ["elements   force / (mu U)   change   torque / (mu U R)   change"]
        for size, value, change in zip(self.sizes, self.values, [None, *self.changes], strict=True):
            text = ["-", "-"] if change is None else [f"{part:.1e}" for part in change]
            rows.append(f"{size:8d}  {value[0]:15.8f}  {text[0]:>7}  {value[1]:18.8f}  {text[1]:>7}")
        return "\n".join(rows)


def create(scene: Scene, cache: Path) -> DiscNearWall:
    return DiscNearWall(scene)
