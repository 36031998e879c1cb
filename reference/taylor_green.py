"""Decaying Taylor-Green vortices in a box periodic in both axes, x and y measured from its lower corner.

    u = -U exp(-b t) cos(k x) sin(k y),    v = U exp(-b t) sin(k x) cos(k y),    k = 2 pi / L,  b = 2 nu k^2,
    p = -rho U^2 / 4 exp(-2 b t) [cos(2 k x) + cos(2 k y)],    E = rho U^2 A / 4 exp(-2 b t)
solve the incompressible Navier-Stokes equations exactly (taylor1937): the pressure gradient balances
convection, and the viscous term is -b times the velocity. L is the width of the box; its area A must hold
whole vortices.
"""

import math
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from reference import base
from reference import scene as scenes
from reference.base import Array, ReferenceError, digest_of
from reference.scene import Scene


@dataclass
class TaylorGreen:
    scene: Scene
    kind: str = "exact"
    source: str = "decaying Taylor-Green vortices (taylor1937)"
    error_estimate: float = 1e-15
    seconds: float = 0.0
    digest: str = field(init=False)

    def __post_init__(self) -> None:
        started = time.perf_counter()
        scene = self.scene
        width, height = scene.size
        if scene.periodic != "xy" or scene.walls or scene.body_force != (0.0, 0.0):
            raise scene.refuse("taylor_green needs a domain periodic in x and y, no wall and no body force")
        boxes = height / width
        if round(boxes) < 1 or not math.isclose(boxes, round(boxes), rel_tol=1e-12):
            raise scene.refuse("taylor_green needs a domain as high as wide, or a whole multiple")
        if scene.start_velocity != "taylor_green" or scene.start_speed == 0:
            raise scene.refuse("taylor_green needs start.velocity = 'taylor_green' and a start.speed")
        self.wavenumber = 2 * math.pi / width
        self.decay = 2 * scene.kinematic_viscosity * self.wavenumber**2
        scripts = (Path(base.__file__), Path(scenes.__file__), Path(__file__))
        problem = {**scene.flow(), "speed": scene.start_speed}
        self.digest = digest_of("taylor_green", problem, scripts)
        self.seconds = time.perf_counter() - started

    def velocity(self, x: Array, y: Array, t: float) -> Array:
        speed = self.scene.start_speed * math.exp(-self.decay * t)
        kx, ky = self._phases(x, y)
        return speed * np.column_stack((-np.cos(kx) * np.sin(ky), np.sin(kx) * np.cos(ky)))

    def pressure(self, x: Array, y: Array, t: float) -> Array:
        kx, ky = self._phases(x, y)
        peak = self.scene.density * self.scene.start_speed**2 / 4 * math.exp(-2 * self.decay * t)
        return -peak * (np.cos(2 * kx) + np.cos(2 * ky))

    def wall_pressure(self, wall: str, x: Array, t: float) -> Array:
        raise ReferenceError(f"taylor_green: no wall {wall!r}: the box is periodic")

    def wall_shear(self, wall: str, x: Array, t: float) -> Array:
        raise ReferenceError(f"taylor_green: no wall {wall!r}: the box is periodic")

    def kinetic_energy(self, t: float) -> float:
        width, height = self.scene.size
        at_start = self.scene.density * self.scene.start_speed**2 * width * height / 4
        return at_start * math.exp(-2 * self.decay * t)

    def _phases(self, x: Array, y: Array) -> tuple[Array, Array]:
        lower = self.scene.lower
        return self.wavenumber * (np.asarray(x) - lower[0]), self.wavenumber * (np.asarray(y) - lower[1])


def create(scene: Scene, cache: Path) -> TaylorGreen:
    return TaylorGreen(scene)
