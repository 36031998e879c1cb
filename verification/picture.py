"""One moment of a run: particles coloured by a field, walls, discs with a spoke that shows their turn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.patches import Circle
from scipy.spatial import cKDTree

from verification.compare import Array, DataError
from verification.measure import Particles, Result
from verification.units import label

NEIGHBOURS = 20
SHOWN = 0.99  # of the particles lie within the colour scale
DOT = 1.8  # diameter of a drawn particle over the distance to its nearest neighbour: no white between them
UNDER = 2.7  # the same of a layer beneath, which fills what is left beside discs and between particles
WALL, MISSING = "0.55", "magenta"
NOTHING = "0.8"  # where there is no fluid: no map has it, as RdBu_r has white for zero
NOISE = 1e-3  # of what the flow's speed makes natural: less is drawn as a constant


def speed(particles: Particles) -> Array:
    """Magnitude of the velocity (n,), m/s."""
    return np.linalg.norm(particles.velocity, axis=1)


def less_mean(values: Array) -> Array:
    """Values less the mean of those along the last axis that are finite."""
    mean = np.ma.masked_invalid(values).mean(axis=-1, keepdims=True)
    return values - np.ma.filled(mean, np.nan)


def pressure(particles: Particles) -> Array:
    """Pressure (n,) less its mean, Pa: the gauge of an incompressible pressure is free."""
    return less_mean(particles.pressure)


def vorticity(particles: Particles) -> Array:
    """dv/dx - du/dy (n,) in 1/s at the particles, from linear fits to their nearest neighbours; NaN where the
    velocity is not finite.
    """
    values = np.full(len(particles.position), np.nan)
    there = np.isfinite(np.hstack([particles.position, particles.velocity])).all(axis=1)
    position, velocity = particles.position[there], particles.velocity[there]
    if len(position) <= NEIGHBOURS:
        raise DataError(f"{len(position)} particles are too few for a vorticity")
    _, near = cKDTree(position).query(position, k=NEIGHBOURS + 1)
    apart = position[near[:, 1:]] - position[:, None]
    change = velocity[near[:, 1:]] - velocity[:, None]
    gradient = np.linalg.solve(
        np.einsum("nki,nkj->nij", apart, apart), np.einsum("nki,nkj->nij", apart, change)
    )
    values[there] = gradient[:, 0, 1] - gradient[:, 1, 0]
    return values


@dataclass(frozen=True)
class Field:
    values: Callable[[Particles], Array]
    name: str
    unit: str
    colours: str
    signed: bool = True

    @property
    def beyond(self) -> str:
        """The ends of the colour scale that some particles are beyond."""
        return "both" if self.signed else "max"


FIELDS = {
    "speed": Field(speed, "speed", "m/s", "viridis", signed=False),
    "pressure": Field(pressure, "pressure - mean", "Pa", "RdBu_r"),
    "vorticity": Field(vorticity, "vorticity", "1/s", "RdBu_r"),
}


def least_shown(result: Result) -> dict[str, float]:
    """By quantity, half the range that a scale has at least: of an exactly uniform one, a scale that suits
    what is there would show the rounding as structure.
    """
    fluid, walls = result.scene.get("fluid", {}), result.scene.get("walls", [])
    speeds = [np.hypot(*wall.get("velocity", (0, 0))) for wall in walls]
    if result.holds("series"):
        speeds.extend(result.columns("series").get("largest_speed", ())[-1:])  # none if it failed at once
    speed = max(filter(np.isfinite, speeds), default=0.0)
    rate = speed / np.subtract(*bounds(result)[::-1]).min()
    shear = fluid.get("dynamic_viscosity", 0.0) * rate
    natural = {"velocity": speed, "vorticity": rate, "shear": shear}
    natural["pressure"] = max(fluid.get("density", 0.0) * speed**2, shear)
    return {name: NOISE * scale for name, scale in natural.items()}


def limit_of(result: Result, times: Sequence[float], field: str) -> float:
    """The end of a colour scale that suits the snapshots at `times`."""
    values = [np.abs(FIELDS[field].values(result.snapshot(time)[0])) for time in times]
    found = np.concatenate(values)
    found = found[np.isfinite(found)]
    if not len(found):
        raise DataError(f"no particle has a {field}")
    return max(float(np.quantile(found, SHOWN)), least_shown(result).get(field, 0.0)) or 1.0


def draw(
    axes: Axes, result: Result, time: float, field: str = "vorticity", limit: float | None = None
) -> EllipseCollection:
    """Draws the snapshot at `time`; a value beyond `limit` has the colour of the limit. Particles whose value
    or place is not finite are counted in a legend, and marked where they have a place.
    """
    particles, wall = result.snapshot(time)
    if not len(particles.position):
        raise DataError("the snapshot holds no fluid particles")
    shown, placed = FIELDS[field], np.isfinite(particles.position).all(axis=1)
    values = np.where(placed, shown.values(particles), np.nan)
    limit = limit_of(result, [time], field) if limit is None else limit
    spacing = _spacing(particles.position)
    places, owners = _images(result, particles.position, UNDER * spacing / 2)
    size = spacing * np.repeat([UNDER, DOT], len(owners))
    dots = _dots(axes, np.tile(places, (2, 1)), size, cmap=shown.colours)
    dots.set_array(np.ma.masked_invalid(np.tile(values[owners], 2)))
    dots.set_clim(-limit if shown.signed else 0.0, limit)
    dots.cmap = dots.cmap.with_extremes(bad=(0, 0, 0, 0))
    scenery(axes, result, wall, particles.time)
    axes.set_facecolor(NOTHING)
    if np.any(missing := ~np.isfinite(values)):
        _dots(axes, particles.position[missing], 2 * DOT * spacing, facecolor=MISSING, zorder=4)
        axes.plot([], [], "o", color=MISSING, label=f"not finite: {np.count_nonzero(missing)} particles")
        axes.legend(loc="upper right")
    return dots


def scenery(axes: Axes, result: Result, wall: Array, time: float) -> None:
    """Walls, by their particles (n, 2) in m, discs at `time`, and the domain with the walls beyond it."""
    lower, upper = bounds(result)
    if len(wall):
        size = DOT * _spacing(wall)
        _dots(axes, _images(result, wall, size / 2)[0], size, facecolor=WALL)
        closed, rim = ~periodic(result), size / 4  # less than a radius: the edge of a row of dots has gaps
        lower = np.where(closed, np.minimum(lower, wall.min(axis=0) - rim), lower)
        upper = np.where(closed, np.maximum(upper, wall.max(axis=0) + rim), upper)
    if result.holds("discs"):
        _draw_discs(axes, result, time)
    axes.set(xlim=(lower[0], upper[0]), ylim=(lower[1], upper[1]), aspect="equal")
    axes.grid(False)
    label(axes.xaxis, "x", "m")
    label(axes.yaxis, "y", "m")


def _spacing(position: Array) -> float:
    """The distance from a particle to its nearest neighbour, the median of all with a place."""
    position = position[np.isfinite(position).all(axis=1)]
    if len(position) < 2:
        raise DataError(f"the snapshot has {len(position)} particles with a place, too few for a picture")
    return float(np.median(cKDTree(position).query(position, k=2)[0][:, 1]))


def _images(result: Result, position: Array, reach: float) -> tuple[Array, Array]:
    """Places (n, 2) of particles and, before them, of their images within `reach` (m) beyond periodic sides,
    and whose each is (n,): what is drawn first lies beneath.
    """
    lower, upper = bounds(result)
    owners = np.arange(len(position))
    for axis in np.flatnonzero(periodic(result)):
        shift = np.where(np.arange(2) == axis, upper - lower, 0.0)
        low, high = position[:, axis] < lower[axis] + reach, position[:, axis] > upper[axis] - reach
        position = np.concatenate([position[low] + shift, position[high] - shift, position])
        owners = np.concatenate([owners[low], owners[high], owners])
    return position, owners


def _dots(axes: Axes, position: Array, size: float | Array, **style: object) -> EllipseCollection:
    """Circles whose diameter is in m, and so fits the spacing whatever the figure's size."""
    sizes = np.broadcast_to(size, len(position))
    dots = EllipseCollection(
        sizes, sizes, np.zeros(len(position)), units="xy", offsets=position,
        offset_transform=axes.transData, linewidths=0, rasterized=True, **style,
    )  # fmt: skip
    return axes.add_collection(dots, autolim=False)


def bounds(result: Result) -> tuple[Array, Array]:
    return tuple(np.array(result.scene["domain"][key]) for key in ("lower", "upper"))


def periodic(result: Result) -> Array:
    """Whether the domain goes on across its sides along x and y (2,)."""
    return np.array([axis in result.scene["domain"].get("periodic", "none") for axis in "xy"])


def _draw_discs(axes: Axes, result: Result, time: float) -> None:
    lower, upper = bounds(result)
    size = (upper - lower) * periodic(result)
    for name in result.disc_names():
        times, centres = result.disc(name, "position")
        moment = int(np.argmin(np.abs(times - time)))
        radius, angle = result.disc_constant(name, "radius"), result.disc(name, "angle")[1][moment]
        home = np.where(size > 0, lower + (centres[moment] - lower) % (upper - lower), centres[moment])
        for image in product(*((-1, 0, 1) if length else (0,) for length in size)):
            centre = home + size * image
            axes.add_patch(Circle(centre, radius, facecolor="0.9", edgecolor="black", zorder=3))
            spoke = centre + radius * np.array([np.cos(angle), np.sin(angle)])
            axes.plot(*np.stack([centre, spoke], axis=1), "k-", linewidth=1, zorder=3)
