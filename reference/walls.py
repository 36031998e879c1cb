"""Walls that are graphs y(x) over a domain periodic in x: height, slope and kinks.

A feature (gaussian, arc, sine) repeats with the period of the domain, its nearest image counting.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from reference.base import Array
from reference.scene import Scene, WallScene

Function = Callable[[Array], Array]
LAST_POWER = 36  # harmonics of a random profile weaker than exp(-36) of the first are left out


@dataclass(frozen=True)
class Graph:
    """A wall at time 0; height and slope take any x (m), periodic; kinks are positions in the domain (m)."""

    wall: WallScene
    height: Function
    slope: Function
    kinks: tuple[float, ...] = ()

    @property
    def flat(self) -> bool:
        return self.wall.shape == "line"


def _feature(scene: Scene, centre: float, height: Function, slope: Function) -> tuple[Function, Function]:
    """The periodic repetition of functions of the distance x - centre."""
    width = scene.size[0]

    def offset(x: Array) -> Array:
        distance = np.asarray(x, dtype=float) - centre
        return distance - width * np.round(distance / width)

    return lambda x: height(offset(x)), lambda x: slope(offset(x))


def _within(scene: Scene, positions: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(scene.lower[0] + (x - scene.lower[0]) % scene.size[0] for x in positions)


def _line(scene: Scene, wall: WallScene) -> Graph:
    (x0, y0), (x1, y1) = wall.parameters["from"], wall.parameters["to"]
    if y0 != y1:
        raise scene.refuse(f"walls.{wall.name}: a line along a periodic channel must be horizontal")
    slack = 1e-9 * scene.size[0]
    if min(x0, x1) > scene.lower[0] + slack or max(x0, x1) < scene.upper[0] - slack:
        raise scene.refuse(f"walls.{wall.name}: the line must span the domain")
    return Graph(wall, lambda x: np.full(np.shape(x), y0), lambda x: np.zeros(np.shape(x)))


def _cosine(scene: Scene, wall: WallScene) -> Graph:
    p = wall.parameters
    waves = scene.size[0] / p["wavelength"]
    if round(waves) < 1 or not math.isclose(waves, round(waves), rel_tol=1e-9):
        raise scene.refuse(f"walls.{wall.name}: whole wavelengths must fit the periodic domain")
    k = 2 * math.pi / p["wavelength"]
    return Graph(
        wall,
        lambda x: p["mean_height"] + p["amplitude"] * np.cos(k * (x - p["crest"])),
        lambda x: -p["amplitude"] * k * np.sin(k * (x - p["crest"])),
    )


def _gaussian(scene: Scene, wall: WallScene) -> Graph:
    p = wall.parameters

    def bell(d: Array) -> Array:
        return p["amplitude"] * np.exp(-(d**2) / (2 * p["width"] ** 2))

    height, slope = _feature(
        scene, p["centre"], lambda d: p["base_height"] + bell(d), lambda d: -d / p["width"] ** 2 * bell(d)
    )
    return Graph(wall, height, slope, _within(scene, (p["centre"] + scene.size[0] / 2,)))


def _arc(scene: Scene, wall: WallScene) -> Graph:
    p = wall.parameters
    radius, sign = p["radius"], 1.0 if p["upward"] else -1.0
    half = radius * math.sin(p["angle"] / 2)
    if radius <= 0 or not 0 < p["angle"] < math.pi or 2 * half >= scene.size[0]:
        raise scene.refuse(
            f"walls.{wall.name}: an arc needs radius > 0, 0 < angle < pi and room in the domain"
        )
    drop = radius * math.cos(p["angle"] / 2)

    def rise(d: Array) -> Array:
        return np.where(np.abs(d) < half, np.sqrt(np.maximum(radius**2 - d**2, drop**2)) - drop, 0.0)

    def tilt(d: Array) -> Array:
        return np.where(np.abs(d) < half, -d / np.sqrt(np.maximum(radius**2 - d**2, drop**2)), 0.0)

    height, slope = _feature(
        scene, p["centre"], lambda d: p["base_height"] + sign * rise(d), lambda d: sign * tilt(d)
    )
    return Graph(wall, height, slope, _within(scene, (p["centre"] - half, p["centre"] + half)))


def _sine(scene: Scene, wall: WallScene) -> Graph:
    p = wall.parameters
    if not 0 < p["length"] <= scene.size[0]:
        raise scene.refuse(f"walls.{wall.name}: the length of a sine must be positive and fit the domain")
    k, half = 2 * math.pi / p["length"], p["length"] / 2

    def wave(d: Array) -> Array:
        return np.where(np.abs(d) < half, np.sin(k * d), 0.0)

    def tilt(d: Array) -> Array:
        return np.where(np.abs(d) < half, k * np.cos(k * d), 0.0)

    base, amplitude = p["base_height"], p["amplitude"]
    height, slope = _feature(
        scene, p["centre"], lambda d: base + amplitude * wave(d), lambda d: amplitude * tilt(d)
    )
    return Graph(wall, height, slope, _within(scene, (p["centre"] - half, p["centre"] + half)))


def _profile(scene: Scene, wall: WallScene) -> Graph:
    x, y = np.array(wall.parameters["points"]).T
    slack = 1e-9 * scene.size[0]
    spans = abs(x[0] - scene.lower[0]) <= slack and abs(x[-1] - scene.upper[0]) <= slack
    if not spans or abs(y[0] - y[-1]) > slack:
        raise scene.refuse(f"walls.{wall.name}: a profile must span the domain and end as high as it starts")
    y[-1] = y[0]
    spline = CubicSpline(x, y + wall.parameters["base_height"], bc_type="periodic")
    return Graph(wall, spline, spline.derivative())


def uniform_numbers(seed: int) -> Iterator[float]:
    """SplitMix64 (steele2014), as the solver has it: numbers in [0, 1) of 53 bits."""
    mask = (1 << 64) - 1
    while True:
        seed = (seed + 0x9E3779B97F4A7C15) & mask
        mixed = ((seed ^ (seed >> 30)) * 0xBF58476D1CE4E5B9) & mask
        mixed = ((mixed ^ (mixed >> 27)) * 0x94D049BB133111EB) & mask
        yield math.ldexp((mixed ^ (mixed >> 31)) >> 11, -53)


def _random(scene: Scene, wall: WallScene) -> Graph:
    """Harmonics of the correlation rms_height^2 exp(-(r / correlation_length)^2) with random phases, scaled
    to the RMS height over the period: solver/geometry/random_profile.hpp.
    """
    p = wall.parameters
    if p["rms_height"] <= 0 or p["correlation_length"] <= 0:
        raise scene.refuse(
            f"walls.{wall.name}: rms_height and correlation_length of a random profile must be positive"
        )
    first = 2 * math.pi / scene.size[0]
    power = (first * p["correlation_length"] / 2) ** 2
    n = np.arange(1, max(1, int(math.sqrt(LAST_POWER / power))) + 1)
    weight = np.exp(-power * (n**2 - 1))
    amplitude = p["rms_height"] * np.sqrt(weight / (weight.sum() / 2))
    numbers = uniform_numbers(int(p["seed"]))
    phase = np.array([2 * math.pi * next(numbers) for _ in n])

    def angle(x: Array) -> Array:
        return first * np.multiply.outer(np.asarray(x, dtype=float) - scene.lower[0], n) + phase

    return Graph(
        wall,
        lambda x: p["mean_height"] + np.cos(angle(x)) @ amplitude,
        lambda x: -np.sin(angle(x)) @ (first * n * amplitude),
    )


SHAPES = {
    "line": _line,
    "cosine": _cosine,
    "gaussian": _gaussian,
    "arc": _arc,
    "sine": _sine,
    "profile": _profile,
    "random": _random,
}


def graph(scene: Scene, wall: WallScene) -> Graph:
    """Raises ReferenceError where the wall is not a graph over the periodic domain."""
    if wall.fluid_side not in ("above", "below"):
        raise scene.refuse(f"walls.{wall.name}: the fluid must lie above or below the wall")
    return SHAPES[wall.shape](scene, wall)
