"""A disc at rest that its buoyant weight sets going in the middle of a square box of a fluid at rest.

Until it has moved by a small part of its radius, and vorticity has spread by a small part of it, the fluid's
force is that of a potential flow, of the boundary layer on the disc, and of its curvature:
    (rho_s + C rho) pi R^2 U' + 4 rho R sqrt(pi nu) int_0^t U'(s) / sqrt(t - s) ds + 2 pi mu U
        = (rho_s - rho) pi R^2 g
(Stokes's force on an oscillating cylinder in powers of the boundary layer's thickness over R, to the second,
for any motion [stokes1851]). The added mass C is 1, and a little more in a box of side L, for the images of
the disc in its walls push against it: C = 1 + 2 s (R / L)^2 with
    s = pi^2 / 3 - 2 sum_{n >= 1} (-1)^n pi^2 / sinh^2(pi n).
Steps in time are equal in sqrt(t), in which U' is smooth.
"""

import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from reference import base
from reference import scene as scenes
from reference.base import Array, digest_of
from reference.scene import DiscScene, Scene

STEPS = 800
MOST_SPREAD = 0.2  # sqrt(nu t) / R at the end
MOST_WAY = 0.5  # over R


def image_sum() -> float:
    """s: how much the images of a square's walls push against a disc in its middle."""
    n = np.arange(1, 6)
    return float(np.pi**2 / 3 - 2 * np.sum((-1.0) ** n * (np.pi / np.sinh(np.pi * n)) ** 2))


def accelerations(times: Array, inertia: float, layer: float, drag: float, force: float) -> Array:
    """U' (n,) at times (n,), the first 0, from inertia U' + layer int U' / sqrt(t - s) ds + drag U = force.

    U' is a straight line between two times; U and the integral are exact for that.
    """
    found = np.array([force / inertia])
    speed = 0.0
    for k in range(1, len(times)):
        step = np.diff(times[: k + 1])
        far, near = np.sqrt(times[k] - times[:k]), np.sqrt(times[k] - times[1 : k + 1])
        whole = 2 * (far - near)  # int ds / sqrt(t - s)
        late = (2 / 3) * (far**3 - near**3)  # int (t - s) ds / sqrt(t - s)
        rising = (far**2 * whole - late) / step  # of a function that rises from 0 to 1
        known = found @ (whole - rising) + found[1:] @ rising[:-1]
        own = inertia + layer * rising[-1] + drag * step[-1] / 2
        right = force - layer * known - drag * (speed + step[-1] / 2 * found[-1])
        found = np.append(found, right / own)
        speed += step[-1] / 2 * (found[-1] + found[-2])
    return found


@dataclass
class AddedMass:
    scene: Scene
    kind: str = "exact"
    source: str = "added mass and boundary layer of a cylinder that starts to move (stokes1851)"
    error_estimate: float = field(init=False)
    seconds: float = 0.0
    digest: str = field(init=False)

    def __post_init__(self) -> None:
        started = time.perf_counter()
        disc, side = self._checked()
        scene, radius = self.scene, disc.radius
        nu = scene.dynamic_viscosity / scene.density
        area = np.pi * radius**2
        mass = 1 + 2 * image_sum() * (radius / side) ** 2
        self._times = scene.end_time * np.linspace(0, 1, STEPS + 1) ** 2
        acceleration = accelerations(
            self._times,
            (disc.density + mass * scene.density) * area,
            4 * scene.density * radius * np.sqrt(np.pi * nu),
            2 * np.pi * scene.dynamic_viscosity,
            (disc.density - scene.density) * area * scene.gravity[1],
        )
        steps = np.diff(self._times) * (acceleration[1:] + acceleration[:-1]) / 2
        self._speed = np.concatenate([[0.0], np.cumsum(steps)])
        spread = np.sqrt(nu * scene.end_time) / radius
        way = abs(np.trapezoid(self._speed, self._times)) / radius
        if spread > MOST_SPREAD or way > MOST_WAY:
            reach = f"{way:.2g} radii of way, vorticity spread by {spread:.2g} of one"
            raise scene.refuse(f"added_mass holds for the start alone; the end is at {reach}")
        # The next power of the layer's thickness, and of the disc's size, which are left out.
        self.error_estimate = float(spread**3 + 2 * (radius / side) ** 4)
        scripts = (Path(base.__file__), Path(scenes.__file__), Path(__file__))
        self.digest = digest_of("added_mass", scene.flow(), scripts)
        self.seconds = time.perf_counter() - started

    def _checked(self) -> tuple[DiscScene, float]:
        """The disc, and the side of the box."""
        scene = self.scene
        size = np.subtract(scene.upper, scene.lower)
        middle = np.add(scene.upper, scene.lower) / 2
        if len(scene.discs) != 1 or scene.discs[0].motion != "free" or scene.discs[0].velocity != (0.0, 0.0):
            raise scene.refuse("added_mass needs one free disc at rest")
        square = np.isclose(*size) and scene.periodic == "none"
        if not square or not np.allclose(scene.discs[0].position, middle, atol=1e-9 * size[0]):
            raise scene.refuse("added_mass needs the disc in the middle of a closed square box")
        if scene.gravity[0] != 0 or scene.gravity[1] == 0:
            raise scene.refuse("added_mass needs gravity along y")
        return scene.discs[0], float(size[0])

    def disc(self, name: str, quantity: str, t: Array) -> Array:
        """velocity (n, 2) m/s at times t (n,) s."""
        self.scene.disc(name)
        if quantity != "velocity":
            raise self.scene.refuse(f"added_mass knows velocity of a disc, not {quantity}")
        along = np.interp(t, self._times, self._speed)
        return np.stack([np.zeros_like(along), along], axis=1)


def create(scene: Scene, cache: Path) -> AddedMass:
    return AddedMass(scene)
