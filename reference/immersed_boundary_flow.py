"""Incompressible flow in a rectangular box on a staggered grid, its sides no-slip walls or periodic.

Equations, per mass (p in m2/s2), f the force of what is immersed:
    du/dt + div(u u) = -grad p + nu lap u + f,   div u = 0,   u = 0 on walls.
Grid (staggered, harlow1965): pressure in the centres of cells, velocity components on the faces normal to
them; central differences of second order that keep momentum and, with div u = 0, energy.
Step (fractional, pressure corrected in increments), f0 the f of the step before:
    (1 - a lap) (u* + u^n) = 2 u^n - dt [grad p^n + extrapolated div(u u) - f0],    a = nu dt / 2,
    u** = u* + dt (f - f0),    lap phi = div u** / dt,
    u^(n+1) = u** - dt grad phi,    p^(n+1) = p^n + (1 - a lap) phi:
Crank-Nicolson's and Adams-Bashforth's rules, the latter for steps of changing length; second order in time.
The discrete Laplacian of every field is diagonal in sine or cosine transforms (closed axis) and in Fourier's
(periodic axis), so that each solve is exact to rounding.
"""

from dataclasses import dataclass

import numpy as np
from scipy import fft

from reference.base import Array

# Kinds of transform along a closed axis, by where the values lie: on the faces between cells (zero on the
# walls), in the centres (odd about the walls), in the centres (even about them).
FACES, ODD_CENTRES, EVEN_CENTRES = "faces", "odd centres", "even centres"
_TRANSFORMS = {  # forward, backward, type, wave number of the first coefficient
    FACES: (fft.dst, fft.idst, 1, 1),
    ODD_CENTRES: (fft.dst, fft.idst, 2, 1),
    EVEN_CENTRES: (fft.dct, fft.idct, 2, 0),
}


@dataclass(frozen=True)
class Grid:
    """nx x ny cells on a box with its lower left corner at the origin."""

    cells: tuple[int, int]
    size: tuple[float, float]  # m
    periodic: tuple[bool, bool]

    @property
    def spacing(self) -> tuple[float, float]:
        return self.size[0] / self.cells[0], self.size[1] / self.cells[1]

    def shape(self, component: int) -> tuple[int, int]:
        """Of the unknown values of a velocity component: those on walls are zero and not stored."""
        shape = list(self.cells)
        shape[component] -= not self.periodic[component]
        return shape[0], shape[1]

    def origin(self, component: int) -> tuple[float, float]:
        """Where the first unknown value of a velocity component lies, in spacings."""
        origin = [0.5, 0.5]
        origin[component] = 0.0 if self.periodic[component] else 1.0
        return origin[0], origin[1]


def _cut(axis: int, part: slice) -> tuple[slice, ...]:
    return tuple(part if i == axis else slice(None) for i in range(2))


_FIRST, _LAST, _NOT_FIRST, _NOT_LAST = slice(None, 1), slice(-1, None), slice(1, None), slice(None, -1)


class Differences:
    """Differences and means between the centres of cells and the faces between them, axis by axis.

    Along a closed axis of n cells a field on faces has n - 1 values; those on the walls are zero.
    """

    def __init__(self, grid: Grid):
        self.grid = grid

    def _pair(self, field: Array, axis: int, to_faces: bool) -> tuple[Array, Array]:
        """What lies before and behind each face (centre), without the places next to walls."""
        if self.grid.periodic[axis]:
            shifted = np.roll(field, 1 if to_faces else -1, axis)
            return (shifted, field) if to_faces else (field, shifted)
        return field[_cut(axis, _NOT_LAST)], field[_cut(axis, _NOT_FIRST)]

    def mean_on_faces(self, field: Array, axis: int) -> Array:
        before, behind = self._pair(field, axis, True)
        return 0.5 * (before + behind)

    def slope_on_faces(self, field: Array, axis: int) -> Array:
        before, behind = self._pair(field, axis, True)
        return (behind - before) / self.grid.spacing[axis]

    def mean_in_centres(self, field: Array, axis: int) -> Array:
        before, behind = self._pair(field, axis, False)
        return self._between_walls(field, 0.5 * (before + behind), axis, 0.5, 0.5)

    def slope_in_centres(self, field: Array, axis: int) -> Array:
        before, behind = self._pair(field, axis, False)
        h = self.grid.spacing[axis]
        return self._between_walls(field, (behind - before) / h, axis, 1 / h, -1 / h)

    def _between_walls(self, field: Array, inner: Array, axis: int, first: float, last: float) -> Array:
        if self.grid.periodic[axis]:
            return inner
        ends = first * field[_cut(axis, _FIRST)], last * field[_cut(axis, _LAST)]
        return np.concatenate((ends[0], inner, ends[1]), axis)


class Laplacian:
    """The discrete Laplacian of one kind of field, in the transform that makes it diagonal."""

    def __init__(self, grid: Grid, places: tuple[str, str]):
        self.periodic = [axis for axis in range(2) if grid.periodic[axis]]
        self.closed = [(axis, _TRANSFORMS[places[axis]]) for axis in range(2) if not grid.periodic[axis]]
        axes = [self._eigenvalues(grid, axis, places[axis]) for axis in range(2)]
        self.eigenvalues = axes[0][:, None] + axes[1][None, :]

    def _eigenvalues(self, grid: Grid, axis: int, place: str) -> Array:
        n, h = grid.cells[axis], grid.spacing[axis]
        if grid.periodic[axis]:
            halved = axis == self.periodic[-1]
            angle = 2 * np.pi * (np.arange(n // 2 + 1) if halved else np.arange(n)) / n
        else:
            first = _TRANSFORMS[place][3]
            angle = np.pi * np.arange(first, n + (place == ODD_CENTRES)) / n
        return -((2 * np.sin(angle / 2) / h) ** 2)

    def scaled(self, field: Array, factors: Array) -> Array:
        """The field with its transform multiplied by `factors` (of the shape of the eigenvalues)."""
        shape = [field.shape[axis] for axis in self.periodic]
        for axis, (forward, _, kind, _) in self.closed:
            field = forward(field, kind, axis=axis)
        if self.periodic:
            field = fft.rfftn(field, axes=self.periodic)
        field = field * factors
        if self.periodic:
            field = fft.irfftn(field, s=shape, axes=self.periodic)
        for axis, (_, backward, kind, _) in self.closed:
            field = backward(field, kind, axis=axis)
        return field


class Flow:
    """The state of the fluid and the two halves of a step, between which the immersed force is added."""

    def __init__(self, grid: Grid, viscosity: float):
        """`viscosity` is kinematic, m2/s; the fluid starts at rest."""
        self.grid, self.viscosity = grid, viscosity
        self.differences = Differences(grid)
        self.velocity = [np.zeros(grid.shape(component)) for component in range(2)]
        self.pressure = np.zeros(grid.cells)
        places = ((FACES, ODD_CENTRES), (ODD_CENTRES, FACES))
        self._velocity_laplacians = [Laplacian(grid, place) for place in places]
        self._pressure_laplacian = Laplacian(grid, (EVEN_CENTRES, EVEN_CENTRES))
        self._before: tuple[float, list[Array]] | None = None  # the last step's length and div(u u)

    def divergence(self, velocity: list[Array]) -> Array:
        return sum(self.differences.slope_in_centres(velocity[axis], axis) for axis in range(2))

    def convection(self) -> list[Array]:
        """div(u u), m/s2."""
        on, (u, v) = self.differences, self.velocity
        corner = on.mean_on_faces(u, 1) * on.mean_on_faces(v, 0)
        return [
            on.slope_on_faces(on.mean_in_centres(u, 0) ** 2, 0) + on.slope_in_centres(corner, 1),
            on.slope_in_centres(corner, 0) + on.slope_on_faces(on.mean_in_centres(v, 1) ** 2, 1),
        ]

    def predicted(self, step: float, force: list[Array]) -> list[Array]:
        """u*, the velocity after a step (s) with the old pressure and a first guess of the force (m/s2)."""
        convection = self.convection()
        last, old = self._before or (step, convection)
        share = 0.5 * step / last
        self._before = (step, convection)
        result = []
        for axis, laplacian in enumerate(self._velocity_laplacians):
            change = (1 + share) * convection[axis] - share * old[axis]
            change += self.differences.slope_on_faces(self.pressure, axis) - force[axis]
            right = 2 * self.velocity[axis] - step * change
            factors = 1 / (1 - 0.5 * self.viscosity * step * laplacian.eigenvalues)
            result.append(laplacian.scaled(right, factors) - self.velocity[axis])
        return result

    def project(self, velocity: list[Array], step: float) -> None:
        """Takes u** without its divergence as the new velocity, and the pressure that does it."""
        values = self._pressure_laplacian.eigenvalues
        inverse = np.divide(1.0, values, out=np.zeros_like(values), where=values != 0)
        source = self.divergence(velocity) / step
        potential = self._pressure_laplacian.scaled(source, inverse)
        for axis in range(2):
            slope = self.differences.slope_on_faces(potential, axis)
            self.velocity[axis] = velocity[axis] - step * slope
        self.pressure = self.pressure + potential - 0.5 * self.viscosity * step * source
