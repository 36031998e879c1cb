"""One moment of a run: particles coloured by vorticity, discs with a spoke that shows how they turned."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.patches import Circle
from scipy.spatial import cKDTree

from verification.compare import Array, DataError
from verification.measure import Particles, Result

NEIGHBOURS = 20
SHOWN = 0.99  # of the particles lie within the colour scale


def vorticity(particles: Particles) -> Array:
    """dv/dx - du/dy (n,) at the particles, from linear fits to their nearest neighbours."""
    position, velocity = particles.position, particles.velocity
    if len(position) <= NEIGHBOURS:
        raise DataError(f"{len(position)} particles are too few for a vorticity")
    _, near = cKDTree(position).query(position, k=NEIGHBOURS + 1)
    apart = position[near[:, 1:]] - position[:, None]
    change = velocity[near[:, 1:]] - velocity[:, None]
    gradient = np.linalg.solve(
        np.einsum("nki,nkj->nij", apart, apart), np.einsum("nki,nkj->nij", apart, change)
    )
    return gradient[:, 0, 1] - gradient[:, 1, 0]


def draw(axes: Axes, result: Result, time: float, limit: float | None = None) -> PathCollection:
    """Draws the snapshot at `time`; vorticity beyond +- `limit` (1/s) has the colour of the limit."""
    lower, upper = (np.array(result.scene["domain"][key]) for key in ("lower", "upper"))
    particles = result.particles(time)
    values = vorticity(particles)
    limit = np.quantile(np.abs(values), SHOWN) if limit is None else limit
    style = {"cmap": "RdBu_r", "vmin": -limit, "vmax": limit, "linewidths": 0}
    dots = axes.scatter(*particles.position.T, c=values, s=2e4 / len(values), rasterized=True, **style)
    for name in result.disc_names():
        times, centres = result.disc(name, "position")
        moment = int(np.argmin(np.abs(times - particles.time)))
        centre = lower + (centres[moment] - lower) % (upper - lower)  # positions go on across periodic sides
        radius, angle = result.disc_constant(name, "radius"), result.disc(name, "angle")[1][moment]
        axes.add_patch(Circle(centre, radius, facecolor="0.85", edgecolor="black"))
        spoke = centre + radius * np.array([np.cos(angle), np.sin(angle)])
        axes.plot(*np.stack([centre, spoke], axis=1), "k-", linewidth=1)
    axes.set(xlim=(lower[0], upper[0]), ylim=(lower[1], upper[1]), aspect="equal", xlabel="x (m)")
    axes.grid(False)
    return dots
