"""Free flight of discs without fluid, weight and contact: each keeps its velocity V and its spin W.

    r = r_0 + V t,    angle = W t
Exact. Whether discs meet is not looked at: the scene must keep them apart.
"""

import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from reference import base
from reference import scene as scenes
from reference.base import Array, digest_of
from reference.scene import Scene


@dataclass
class FreeFlight:
    scene: Scene
    kind: str = "exact"
    source: str = "Newton's first law"
    error_estimate: float = 1e-15
    seconds: float = 0.0
    digest: str = field(init=False)

    def __post_init__(self) -> None:
        started = time.perf_counter()
        scene = self.scene
        moved = [disc for disc in scene.discs if disc.motion == "fixed"]
        if not scene.discs or moved or not scene.dry or scene.gravity != (0.0, 0.0):
            raise scene.refuse("free_flight needs discs, none fixed, start.arrangement = 'empty', no gravity")
        scripts = (Path(base.__file__), Path(scenes.__file__), Path(__file__))
        self.digest = digest_of("free_flight", scene.flow(), scripts)
        self.seconds = time.perf_counter() - started

    def disc(self, name: str, quantity: str, t: Array) -> Array:
        """position (n, 2) m, angle (n,) rad, velocity (n, 2) m/s, spin (n,) rad/s at times t (n,)."""
        disc = self.scene.disc(name)
        t = np.asarray(t, dtype=float)
        velocity = np.broadcast_to(disc.velocity, (len(t), 2))
        known = {
            "position": np.array(disc.position) + velocity * t[:, None],
            "angle": disc.spin * t,
            "velocity": velocity,
            "spin": np.full_like(t, disc.spin),
        }
        if quantity not in known:
            raise self.scene.refuse(f"free_flight knows {', '.join(known)} of a disc, not {quantity}")
        return known[quantity]


def create(scene: Scene, cache: Path) -> FreeFlight:
    return FreeFlight(scene)
