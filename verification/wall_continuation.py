"""Errors of what is continued from the fluid to the dummies behind a wall, of the exact field.

Behind a real wall there is no exact field to compare with. So an artificial straight wall is laid through the
fluid: what the particles on one side of it make of the points behind it is held against the exact field
there, from both sides in turn. Velocities are relative to the exact one at the foot of each point on the
wall, so that they vanish on it as those relative to a real wall do. Values and places are without noise; what
noise would become is told by `Continued.noise`.

Forms: the kernel mean about the dummy (Eqs. 2.16, reflected, and 2.17 without acceleration); and least
squares about the foot with the solver's weights (1 - (r / 3h)^2)^2, by polynomials of the distance n from the
wall and the offset s along it. The default scheme's are NO_SLIP and GIVEN_SLOPE.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from reference import Reference
from verification.compare import Array
from verification.operator_forms import SUPPORT, Cloud, kernel_value

DEPTHS = (0.5, 1.5, 2.5)  # spacings behind the wall: where the solver's dummies are
MEAN, FIRST, SECOND = "kernel mean", "first order", "second order"
FIRST_NO_SLIP, NO_SLIP = "first order, no slip on the wall", "second order, no slip on the wall"
GIVEN_SLOPE = "first order, slope across given"
FORMS = {
    "velocity": (MEAN, FIRST, FIRST_NO_SLIP, SECOND, NO_SLIP),
    "pressure": (MEAN, FIRST, GIVEN_SLOPE, SECOND),
}
POWERS = {  # of n and s in each function
    FIRST: ((0, 0), (1, 0), (0, 1)),
    SECOND: ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)),
    FIRST_NO_SLIP: ((1, 0),),
    NO_SLIP: ((1, 0), (2, 0), (1, 1)),
    GIVEN_SLOPE: ((0, 0), (0, 1)),
}


@dataclass(frozen=True)
class Continued:
    """For each of DEPTHS the error, over the root mean square of the field in the fluid; and by how much
    the noise of a dummy's value is larger than independent noise of the particles' values.
    """

    error: tuple[float, ...]
    noise: tuple[float, ...]


@dataclass(frozen=True)
class Side:
    """An artificial wall seen from one side: its `feet` (m, 2) in m, `normal` +1 if the fluid is above."""

    cloud: Cloud
    feet: Array
    normal: float

    def near(self, depth: float) -> tuple[Array, Array, Array]:
        """Of the points `depth` spacings behind the feet: indices of points and of particles within the
        kernel's support, and their offsets (pairs, 2) from it in spacings: n from the wall, and s.
        """
        cloud, spacing = self.cloud, self.cloud.spacing
        inside = cloud.wrapped(cloud.position)
        behind = self.normal * cloud.nearest(inside - self.feet[0])[:, 1] < 0
        points = cloud.wrapped(self.feet - [0.0, self.normal * depth * spacing])
        found = cKDTree(inside, boxsize=cloud.period).query_ball_point(points, SUPPORT * spacing)
        i = np.repeat(np.arange(len(points)), [len(one) for one in found])
        j = np.concatenate(found).astype(int)
        i, j = i[~behind[j]], j[~behind[j]]
        apart = cloud.nearest(inside[j] - points[i]) / spacing
        return i, j, np.column_stack([self.normal * apart[:, 1] - depth, apart[:, 0]])

    def shares(self, form: str, depth: float) -> tuple[Array, Array, Array, Array]:
        """What is continued to point i is the sum of share times the value at particle j: i, j, the shares,
        and the distances of the particles from the wall in spacings.
        """
        i, j, offset = self.near(depth if form == MEAN else 0.0)
        across, along = offset.T
        if form == MEAN:
            weight = kernel_value((across + depth) ** 2 + along**2)
            return i, j, weight / np.bincount(i, weight)[i], across
        weight = np.maximum(0.0, 1 - (across**2 + along**2) / SUPPORT**2) ** 2
        functions = np.column_stack([across**n * along**s for n, s in POWERS[form]])
        target = np.array([(-depth) ** n * 0.0**s for n, s in POWERS[form]])
        products = weight[:, None, None] * functions[:, :, None] * functions[:, None, :]
        matrix = np.zeros((len(self.feet), len(target), len(target)))
        np.add.at(matrix, i, products)
        factors = np.linalg.solve(matrix, np.broadcast_to(target[:, None], (*matrix.shape[:2], 1)))[..., 0]
        return i, j, weight * (functions * factors[i]).sum(axis=1), across

    def continued(self, form: str, depth: float, values: Array, slopes: Array) -> tuple[Array, Array]:
        """The values (m, k) continued from those of the particles (n, k) with the slopes (m, 1) across the
        wall, 1/m, that are given (0: none is), NaN where there is no particle; and the noise of each (m,).
        """
        i, j, share, across = self.shares(form, depth)
        count, given = len(self.feet), slopes * self.cloud.spacing
        terms = share[:, None] * (values[j] - given[i] * across[:, None])
        total = np.column_stack([np.bincount(i, term, count) for term in terms.T]) - depth * given
        reached = np.bincount(i, minlength=count) > 0  # a kernel mean may have no particle
        return np.where(reached[:, None], total, np.nan), np.sqrt(np.bincount(i, share**2, count))


def _slope_of_pressure(reference: Reference, side: Side, step: float) -> Array:
    """(m, 1) in Pa/m along the normal into the fluid, at the feet; by differences of fourth order."""

    def at(steps: int) -> Array:
        x, y = side.cloud.wrapped(side.feet + [0.0, steps * step]).T
        return reference.pressure(x, y, side.cloud.time)

    return (side.normal * (at(-2) - 8 * at(-1) + 8 * at(1) - at(2)) / (12 * step))[:, None]


def _off(side: Side, reference: Reference, step: float, field: str, form: str) -> list[tuple[Array, Array]]:
    """For each of DEPTHS: how far the continued values (m, k) are off, and their noise (m,), of those points
    that the form reaches.
    """
    cloud, height = side.cloud, side.feet[0, 1]

    def exact(places: Array) -> Array:
        x, y = cloud.wrapped(places).T
        if field == "pressure":
            return reference.pressure(x, y, cloud.time)[:, None]
        here = reference.velocity(x, y, cloud.time)
        return here - reference.velocity(x, np.full(len(x), height), cloud.time)

    values = exact(cloud.position)
    slopes = _slope_of_pressure(reference, side, step) if form == GIVEN_SLOPE else 0 * side.feet[:, :1]
    found = []
    for depth in DEPTHS:
        truth = exact(side.feet - [0.0, side.normal * depth * cloud.spacing])
        continued, noise = side.continued(form, depth, values, slopes)
        if (field, form) == ("velocity", MEAN):
            continued = -continued  # reflected, Eq. 2.16
        reached = np.isfinite(continued[:, 0])
        found.append(((continued - truth)[reached], noise[reached]))
    return found


def continuations(
    cloud: Cloud, reference: Reference, height: float, step: float
) -> dict[tuple[str, str], Continued]:
    """By field and form, for a wall along x at `height` in m; `step`: of differences, m. On both sides the
    fluid must fill a kernel's support.
    """
    x, y = cloud.wrapped(cloud.position).T
    along = np.arange(0.5, round(cloud.period[0] / cloud.spacing)) * cloud.spacing
    feet = np.column_stack([along, np.full(len(along), height)])
    sides = [Side(cloud, feet, normal) for normal in (1.0, -1.0)]
    scale = {
        "velocity": np.sqrt((reference.velocity(x, y, cloud.time) ** 2).sum(axis=1).mean()),
        "pressure": np.sqrt((reference.pressure(x, y, cloud.time) ** 2).mean()),
    }
    table = {}
    for field, form in [(field, form) for field, forms in FORMS.items() for form in forms]:
        both = zip(*(_off(side, reference, step, field, form) for side in sides), strict=True)
        errors, noises = [], []
        for depth in both:
            off, noise = (np.concatenate(parts) for parts in zip(*depth, strict=True))
            errors.append(float(np.sqrt((off**2).sum(axis=1).mean()) / scale[field]))
            noises.append(float(np.sqrt((noise**2).mean())))
        table[field, form] = Continued(tuple(errors), tuple(noises))
    return table
