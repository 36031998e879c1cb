"""What the start-up flows between two plane walls have in common.

Between y = y0 and y = y0 + h, with s = (y - y0) / h and nothing depending on x, Navier-Stokes reduces to
    du/dt = nu d2u/dy2 + f,    u(0, t) = V0,  u(1, t) = V1,  u(s, 0) = 0  for 0 < s < 1,
and, with a_n the sine coefficients of the steady profile u_inf,
    u = u_inf(s) - sum_n a_n exp(-n^2 T) sin(n pi s),    T = pi^2 nu t / h^2   (batchelor1967, Sec. 4.3).
The kinetic energy uses sum_n a_n sin(n pi s) = u_inf, so that every series decays like exp(-n^2 T):
    E = rho L h / 2 [ int u_inf^2 ds - sum a_n^2 exp(-n^2 T) + 1/2 sum a_n^2 exp(-2 n^2 T) ].
A series ends where exp(-n^2 T) falls below 1e-20: the tail is then far below rounding.
"""

import math
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from reference import base
from reference import scene as scenes
from reference.base import Array, ReferenceError, digest_of
from reference.scene import Scene, WallScene

NEGLIGIBLE = 1e-20
MOST_TERMS = 100_000


def channel_walls(scene: Scene) -> tuple[WallScene, WallScene]:
    """The lower and the upper wall: horizontal lines across a domain periodic in x, nothing else in it."""
    if scene.periodic != "x" or len(scene.walls) != 2 or any(wall.shape != "line" for wall in scene.walls):
        raise scene.refuse("a start-up flow needs a domain periodic in x and exactly two walls, both lines")
    if any(wall.parameters["from"][1] != wall.parameters["to"][1] for wall in scene.walls):
        raise scene.refuse("a start-up flow needs horizontal walls")
    lower, upper = sorted(scene.walls, key=lambda wall: wall.parameters["from"][1])
    if (lower.fluid_side, upper.fluid_side) != ("above", "below"):
        raise scene.refuse("the fluid must lie above the lower wall and below the upper one")
    if any(wall.velocity[1] != 0 for wall in scene.walls) or scene.body_force[1] != 0:
        raise scene.refuse("a start-up flow needs walls and a body force along x only")
    if scene.start_velocity != "rest":
        raise scene.refuse("a start-up flow starts from rest: start.velocity must be 'rest'")
    return lower, upper


@dataclass
class StartUp:
    """A start-up flow: its steady profile and that profile's sine coefficients come from the subclass."""

    scene: Scene
    name: str
    script: Path
    source: str = "series solution (batchelor1967, Sec. 4.3)"
    kind: str = "exact"
    error_estimate: float = 1e-14
    seconds: float = 0.0
    digest: str = field(init=False)

    def __post_init__(self) -> None:
        started = time.perf_counter()
        self.lower, self.upper = channel_walls(self.scene)
        self.y0 = self.lower.parameters["from"][1]
        self.height = self.upper.parameters["from"][1] - self.y0
        self.decay = math.pi**2 * self.scene.kinematic_viscosity / self.height**2
        scripts = (Path(base.__file__), Path(scenes.__file__), Path(__file__), self.script)
        self.digest = digest_of(self.name, self.scene.flow(), scripts)
        self.seconds = time.perf_counter() - started

    def steady(self, s: Array) -> Array:
        """u_inf, m/s."""
        raise NotImplementedError

    def steady_slope(self, s: float) -> float:
        """du_inf/ds, m/s."""
        raise NotImplementedError

    def steady_square(self) -> float:
        """Integral of u_inf^2 over s, m2/s2."""
        raise NotImplementedError

    def coefficients(self, n: Array) -> Array:
        """a_n, m/s."""
        raise NotImplementedError

    def _terms(self, t: float) -> tuple[Array, Array, Array]:
        """n, a_n and exp(-n^2 T) of the terms that count at a time t > 0."""
        if not (math.isfinite(t) and t > 0):
            raise ReferenceError(f"{self.name}: the series needs a finite time t > 0, not {t}")
        count = math.ceil(math.sqrt(-math.log(NEGLIGIBLE) / (self.decay * t)))
        if count > MOST_TERMS:
            raise ReferenceError(f"{self.name}: t = {t} s needs {count} terms; the flow has hardly started")
        n = np.arange(1, count + 1, dtype=float)
        return n, self.coefficients(n), np.exp(-(n**2) * self.decay * t)

    def profile(self, y: Array, t: float) -> Array:
        """u at heights y; points outside the channel take the wall's value. Shape of y, m/s."""
        s = np.clip((np.asarray(y, dtype=float) - self.y0) / self.height, 0.0, 1.0)
        if t == 0:
            inside = (s > 0) & (s < 1)
            return np.where(inside, 0.0, self.steady(s))
        u = self.steady(s)
        for n, a, decayed in zip(*self._terms(t), strict=True):
            u = u - a * decayed * np.sin(n * math.pi * s)
        return u

    def velocity(self, x: Array, y: Array, t: float) -> Array:
        u = self.profile(y, t)
        return np.column_stack((u, np.zeros_like(u)))

    def pressure(self, x: Array, y: Array, t: float) -> Array:
        return np.zeros(np.shape(x))

    def wall_pressure(self, wall: str, x: Array, t: float) -> Array:
        self._sign(wall)
        return np.zeros(np.shape(x))

    def wall_shear(self, wall: str, x: Array, t: float) -> Array:
        sign = self._sign(wall)
        n, a, decayed = self._terms(t)
        s = 0.0 if sign < 0 else 1.0
        slope = self.steady_slope(s) - float(np.sum(a * decayed * n * math.pi * np.cos(n * math.pi * s)))
        return np.full(np.shape(x), sign * self.scene.dynamic_viscosity * slope / self.height)

    def kinetic_energy(self, t: float) -> float:
        if t == 0:
            return 0.0
        _, a, decayed = self._terms(t)
        mean_square = self.steady_square() - float(np.sum(a**2 * decayed * (1 - decayed / 2)))
        return 0.5 * self.scene.density * self.scene.size[0] * self.height * mean_square

    def _sign(self, wall: str) -> float:
        """+1 where the normal into the fluid points down, so that the traction on the fluid is +eta du/dy."""
        if wall not in (self.lower.name, self.upper.name):
            raise ReferenceError(f"{self.name}: no wall {wall!r}")
        return -1.0 if wall == self.lower.name else 1.0
