"""What a run must never do, as single numbers: squeeze its fluid, lose a particle, make energy or momentum.

Each takes a Result and returns the time of the end (1,) and a value (1,) without a unit that is 0 when all is
well, or raises DataError.
"""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import numpy as np

from reference.scene import Scene, scene_of
from reference.walls import graph
from verification.compare import Array, DataError
from verification.measure import Result

Series = tuple[Array, Array]
REST = 1e-6  # of the sound speed: slower is at rest


def _single(result: Result, value: float) -> Series:
    return np.array([result.end_time]), np.array([value])


def _names(result: Result) -> list[str]:
    return result.disc_names() if "discs" in result.scene else []


def density_error(result: Result) -> Series:
    """The largest deviation of any particle's density from the reference density at any sample, over it."""
    return _single(result, result.series("largest_density_error")[1].max())


def overlap(result: Result) -> Series:
    """The deepest overlap of two rims, or of a rim and a wall, at any step, in spacings; 0 without discs."""
    depth = result.attribute("greatest_overlap") if _names(result) else 0.0
    return _single(result, depth / _spacing(result))


def leak(result: Result) -> Series:
    """How deep the last snapshot's deepest fluid particle is behind a wall or in a disc, in spacings."""
    particles = result.particles()
    depth = max(
        [-np.min(distance) for distance in _wall_distances(result, particles.position, particles.time)]
        + [-np.min(distance) for distance in _disc_distances(result, particles.position)],
        default=0.0,
    )
    return _single(result, max(0.0, depth) / _spacing(result))


def _spacing(result: Result) -> float:
    """m; from the mass of a particle, which fills a square of this side."""
    return float(np.sqrt(result.attribute("particle_mass") / result.scene["fluid"]["density"]))


def _wall_distances(result: Result, position: Array, time: float) -> list[Array]:
    """The fluid's distances (n,) from each wall, m, negative behind it; of a curve, those of its tangents."""
    return [_from_wall(scene, wall, position, time) for scene in [_walls_of(result)] for wall in scene.walls]


def _walls_of(result: Result) -> Scene:
    tables = copy.deepcopy(dict(result.scene))
    tables.pop("discs", None)  # at random places: not the scene's to know
    return scene_of(Path(result.path), tables)


def _from_wall(scene: Scene, wall: Any, position: Array, time: float) -> Array:
    moved = position - time * np.array(wall.velocity)
    if wall.fluid_side in ("left", "right"):
        across = moved[:, 0] - wall.parameters["from"][0]
        return across if wall.fluid_side == "right" else -across
    curve = graph(scene, wall)
    above = (moved[:, 1] - curve.height(moved[:, 0])) / np.hypot(1, curve.slope(moved[:, 0]))
    return above if wall.fluid_side == "above" else -above


def _disc_distances(result: Result, position: Array) -> list[Array]:
    """Distances (n,) from each disc's rim at the end, m; of the nearest image along periodic axes."""
    domain = result.scene["domain"]
    size = np.subtract(domain["upper"], domain["lower"])
    periodic = np.array([axis in domain.get("periodic", "none").replace("none", "") for axis in "xy"])
    distances = []
    for name in _names(result):
        offset = position - result.disc(name, "position")[1][-1]
        offset -= np.where(periodic, size * np.round(offset / size), 0)
        distances.append(np.linalg.norm(offset, axis=1) - result.disc_constant(name, "radius"))
    return distances


def _motion(result: Result) -> tuple[Array, Array, Array]:
    """Kinetic energy (n,) J/m, momentum (n, 2) kg/s, and what gravity has given the discs (n,) J/m."""
    times, energy = result.series("kinetic_energy")
    flow = np.stack([result.series(f"momentum_{axis}")[1] for axis in "xy"], axis=1)
    fluid = result.scene["fluid"]
    work = np.zeros(len(times))
    for name in _names(result):
        stamps, velocity = result.disc(name, "velocity")
        if not np.array_equal(stamps, times):
            raise DataError("the discs and the fluid are not sampled at the same times")
        mass = result.disc_constant(name, "mass")
        inertia, spin = result.disc_constant(name, "moment_of_inertia"), result.disc(name, "spin")[1]
        energy = energy + (mass * np.sum(velocity**2, axis=1) + inertia * spin**2) / 2
        flow = flow + mass * velocity
        way = result.disc(name, "position")[1] - result.disc(name, "position")[1][0]
        displaced = fluid["density"] * np.pi * result.disc_constant(name, "radius") ** 2
        work = work + (mass - displaced) * way @ np.array(fluid.get("gravity", (0.0, 0.0)))
    return energy, flow, work


def energy_created(result: Result) -> Series:
    """The most kinetic energy of fluid and discs beyond what was there and what gravity gave, over the larger
    of these two. No work of moving walls or of a body force is counted: for scenes without them, whose discs
    feel their buoyant weight.
    """
    energy, _, work = _motion(result)
    fluid = result.attribute("particle_mass") * result.attribute("fluid_particles")
    least = fluid * (REST * result.scene["numerics"]["sound_speed"]) ** 2
    scale = max(energy[0], np.abs(work).max(), least)
    return _single(result, max(0.0, (energy - energy[0] - work).max()) / scale)


def momentum_created(result: Result) -> Series:
    """The largest change of the momentum of fluid and discs over sqrt(2 mass energy) at the start, the most
    momentum that this energy can have; for scenes without walls and forces.
    """
    energy, flow, _ = _motion(result)
    masses = [result.disc_constant(name, "mass") for name in _names(result)]
    mass = sum(masses) + result.attribute("particle_mass") * result.attribute("fluid_particles")
    scale = np.sqrt(2 * mass * energy[0])
    if not scale > 0:
        raise DataError("nothing moves at the start: its momentum has no scale")
    return _single(result, np.linalg.norm(flow - flow[0], axis=1).max() / scale)


def energy_growth(result: Result) -> Series:
    """How much larger the mean kinetic energy of fluid and discs is over the last quarter of the run than
    over the quarter before, over the latter.
    """
    energy, _, _ = _motion(result)
    quarter = len(energy) // 4
    if quarter < 2:
        raise DataError(f"{len(energy)} samples are too few to tell the energy's growth")
    before, after = energy[-2 * quarter : -quarter].mean(), energy[-quarter:].mean()
    return _single(result, (after - before) / before if before > 0 else float(after > 0))


def density_drift(result: Result) -> Series:
    """The largest deviation of the mean density from that at the start at any sample, over it."""
    density = result.series("mean_density")[1]
    return _single(result, np.abs(density - density[0]).max() / density[0])


BUDGETS = {
    function.__name__: function
    for function in (
        density_error, overlap, leak, energy_created, momentum_created, energy_growth, density_drift,
    )
}  # fmt: skip
