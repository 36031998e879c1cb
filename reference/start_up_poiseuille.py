"""Start-up of plane Poiseuille flow: walls at rest, a body force f per mass along x switched on at t = 0.

    u_inf = f h^2 / (2 nu) s (1 - s),    a_n = 4 f h^2 / (nu pi^3 n^3)  for odd n, 0 for even n
in the series of reference/start_up.py (batchelor1967, Sec. 4.3). Exact: no discretisation, only rounding.
"""

import math
from pathlib import Path

import numpy as np

from reference.base import Array
from reference.scene import Scene
from reference.start_up import StartUp


class Poiseuille(StartUp):
    def __post_init__(self) -> None:
        super().__post_init__()
        if any(wall.velocity[0] != 0 for wall in self.scene.walls):
            raise self.scene.refuse("start_up_poiseuille needs walls at rest")
        if self.scene.body_force[0] == 0:
            raise self.scene.refuse("start_up_poiseuille needs a body force along x")
        self.scale = self.scene.body_force[0] * self.height**2 / self.scene.kinematic_viscosity

    def steady(self, s: Array) -> Array:
        return self.scale / 2 * s * (1 - s)

    def steady_slope(self, s: float) -> float:
        return self.scale / 2 * (1 - 2 * s)

    def steady_square(self) -> float:
        return self.scale**2 / 120

    def coefficients(self, n: Array) -> Array:
        return np.where(n % 2 == 1, 4 * self.scale / (math.pi * n) ** 3, 0.0)


def create(scene: Scene, cache: Path) -> Poiseuille:
    return Poiseuille(scene, "start_up_poiseuille", Path(__file__))
