"""Start-up of Couette flow: two plane walls that move along x, the fluid between them at rest at t = 0.

    u_inf = V0 + (V1 - V0) s,    a_n = 2 / (n pi) [V0 - (-1)^n V1]
in the series of reference/start_up.py (batchelor1967, Sec. 4.3). Exact: no discretisation, only rounding.
"""

import math
from pathlib import Path

import numpy as np

from reference.base import Array
from reference.scene import Scene
from reference.start_up import StartUp


class Couette(StartUp):
    def __post_init__(self) -> None:
        super().__post_init__()
        if self.scene.body_force != (0.0, 0.0):
            raise self.scene.refuse("start_up_couette needs fluid.body_force = [0, 0]")
        self.bottom, self.top = self.lower.velocity[0], self.upper.velocity[0]
        if self.bottom == self.top == 0:
            raise self.scene.refuse("start_up_couette needs a wall that moves along x")

    def steady(self, s: Array) -> Array:
        return self.bottom + (self.top - self.bottom) * s

    def steady_slope(self, s: float) -> float:
        return self.top - self.bottom

    def steady_square(self) -> float:
        return (self.bottom**2 + self.bottom * self.top + self.top**2) / 3

    def coefficients(self, n: Array) -> Array:
        return 2 / (n * math.pi) * (self.bottom - np.where(n % 2 == 0, 1.0, -1.0) * self.top)


def create(scene: Scene, cache: Path) -> Couette:
    return Couette(scene, "start_up_couette", Path(__file__))
