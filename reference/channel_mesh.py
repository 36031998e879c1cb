"""The channel bottom(x) <= y <= top(x) as the image of a rectangle, exactly, and fields on it.

The rectangle (x, eta), 0 <= eta <= 1, is meshed by rectangles and mapped by
    Phi(x, eta) = (x, bottom + eta (top - bottom)),
so that no element approximates a wall; scikit-fem (gustafsson2020) sees Phi as the mapping of its elements.
Mesh lines stand on the kinks of the walls and crowd towards them, where a corner can make the solution
singular.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from skfem import Basis, MeshQuad1DG
from skfem.element import ElementQuadP
from skfem.mapping import Mapping

from reference.base import Array
from reference.walls import Function

CHUNK = 50_000  # points evaluated at once
MOST_BEND = 1.0  # change of a wall's slope within an element of the coarsest mesh


@dataclass(frozen=True)
class Channel:
    """The walls of a periodic channel in units of its mean gap; kinks that matter as (x, at the top?)."""

    start: float
    length: float
    bottom: Function
    top: Function
    bottom_slope: Function
    top_slope: Function
    kinks: tuple[tuple[float, bool], ...]

    def gap(self, x: Array) -> Array:
        return self.top(x) - self.bottom(x)

    def bends(self, x: Array) -> Array:
        """How fast the slopes of bottom and top change along x (2, n)."""
        step = 1e-5 * self.length
        slopes = (self.bottom_slope, self.top_slope)
        return np.array([np.abs(slope(x + step) - slope(x - step)) / (2 * step) for slope in slopes])


class ChannelMapping(Mapping):
    """Phi after the affine mapping of the rectangle's elements."""

    def __init__(self, mesh: MeshQuad1DG, channel: Channel):
        self.affine, self.channel = mesh.mapping(), channel

    def F(self, X: Array, tind: Array | None = None) -> Array:  # noqa: N802 (scikit-fem's names)
        x, eta = self.affine.F(X, tind)
        return np.array([x, self.channel.bottom(x) + eta * self.channel.gap(x)])

    def detDF(self, X: Array, tind: Array | None = None) -> Array:  # noqa: N802
        return self.affine.detDF(X, tind) * self.channel.gap(self.affine.F(X, tind)[0])

    def invDF(self, X: Array, tind: Array | None = None) -> Array:  # noqa: N802
        x, eta = self.affine.F(X, tind)
        gap = self.channel.gap(x)
        bottom_slope = self.channel.bottom_slope(x)
        slope = bottom_slope + eta * (self.channel.top_slope(x) - bottom_slope)
        inverse = np.array([[np.ones_like(x), np.zeros_like(x)], [-slope / gap, 1 / gap]])
        return np.einsum("ijkl,jmkl->imkl", self.affine.invDF(X, tind), inverse)


def _graded(start: float, end: float, size: Function, refinement: int) -> Array:
    """Points from start to end, spaced by about size(position); each refinement halves every interval."""
    fine = np.linspace(start, end, 4001)
    middle = (fine[1:] + fine[:-1]) / 2
    count = np.concatenate(([0.0], np.cumsum(np.diff(fine) / size(middle))))
    intervals = max(1, math.ceil(count[-1])) * 2**refinement
    points = np.interp(np.linspace(0, count[-1], intervals + 1), count, fine)
    points[0], points[-1] = start, end
    return points


def joined_lines(breaks: list[float], size: Function, refinement: int) -> Array:
    """Mesh lines on the breaks, spaced by about size(position) between; each refinement halves intervals."""
    pieces = [_graded(a, b, size, refinement) for a, b in zip(breaks, breaks[1:], strict=False)]
    return np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])


def mesh_lines(channel: Channel, per_gap: float, smallest: float, refinement: int) -> tuple[Array, Array]:
    """Mesh lines x and eta with about `per_gap` elements a gap, shrinking to `smallest` gaps at the kinks.

    Along x they shrink to the length over which a wall's slope changes by MOST_BEND as well, and across at a
    wall where that is less than half an element.
    """
    end = channel.start + channel.length
    everywhere = np.linspace(channel.start, end, 4001)
    radii = [
        np.min(MOST_BEND / (bend * channel.gap(everywhere) + 1e-12)) for bend in channel.bends(everywhere)
    ]
    thinnest = [max(radius, smallest) if radius < 0.5 / per_gap else 1 / per_gap for radius in radii]

    def x_size(x: Array) -> Array:
        steepest = np.maximum(np.abs(channel.bottom_slope(x)), np.abs(channel.top_slope(x)))
        size = np.minimum(channel.gap(x) / np.maximum(1, steepest) / per_gap, channel.length / 8)
        size = np.minimum(size, np.maximum(MOST_BEND / (channel.bends(x).max(axis=0) + 1e-12), smallest))
        for kink, _ in channel.kinks:
            away = np.abs(x - kink)
            away = np.minimum(away, channel.length - away)
            size = np.minimum(size, 1.5 * away + smallest)
        return size

    def eta_size(eta: Array) -> Array:
        size = np.minimum(1 / per_gap, np.minimum(1.5 * eta + thinnest[0], 1.5 * (1 - eta) + thinnest[1]))
        for _, top in channel.kinks:
            size = np.minimum(size, 1.5 * (1 - eta if top else eta) + smallest)
        return size

    inner = sorted({x for x, _ in channel.kinks if channel.start < x < end})
    x_lines = joined_lines([channel.start, *inner, end], x_size, refinement)
    return x_lines, joined_lines([0.0, 1.0], eta_size, refinement)


def lobatto_points(degree: int) -> Array:
    """Gauss-Lobatto points of [0, 1]; a polynomial of the degree is known from its values there."""
    inner = legendre.Legendre.basis(degree).deriv().roots()
    return np.concatenate(([0.0], (np.real(inner) + 1) / 2, [1.0]))


@dataclass(frozen=True)
class Polynomials:
    """Piecewise polynomials on mesh lines x (periodic) and eta, kept as values at Gauss-Lobatto points.

    Evaluation is exact: it is the finite element function itself, not an interpolation of it.
    """

    x_lines: Array
    eta_lines: Array
    degree: int

    def _local(self, lines: Array, position: Array) -> tuple[Array, Array]:
        """First node of each position's element, and the weights of its degree + 1 nodes (n, degree + 1)."""
        element = np.clip(np.searchsorted(lines, position, side="right") - 1, 0, len(lines) - 2)
        s = (position - lines[element]) / (lines[element + 1] - lines[element])
        inverse = np.linalg.inv(legendre.legvander(2 * lobatto_points(self.degree) - 1, self.degree))
        return element * self.degree, legendre.legvander(2 * s - 1, self.degree) @ inverse

    def _wrapped(self, x: Array) -> Array:
        start, end = self.x_lines[0], self.x_lines[-1]
        return start + (np.asarray(x, dtype=float) - start) % (end - start)

    def along(self, values: Array, x: Array) -> Array:
        """A function of x alone; values (nodes,) -> (n,)."""
        first, weights = self._local(self.x_lines, self._wrapped(x))
        return np.sum(values[first[:, None] + np.arange(self.degree + 1)] * weights, axis=1)

    def at(self, fields: Array, x: Array, eta: Array) -> Array:
        """Fields (fields, x nodes, eta nodes) at n points -> (fields, n)."""
        result = np.empty((len(fields), len(x)))
        nodes = np.arange(self.degree + 1)
        for begin in range(0, len(x), CHUNK):
            part = slice(begin, begin + CHUNK)
            i, along_x = self._local(self.x_lines, self._wrapped(x[part]))
            j, along_eta = self._local(self.eta_lines, eta[part])
            index = (i[:, None, None] + nodes[:, None], j[:, None, None] + nodes)
            for field, out in zip(fields, result, strict=True):
                out[part] = np.einsum("nij,ni,nj->n", field[index], along_x, along_eta)
        return result


class Elements:
    """Continuous elements of one degree over the mapped mesh, periodic in x.

    An element's first local coordinate runs along eta, its second along x: so init_tensor numbers them.
    """

    def __init__(self, mesh: MeshQuad1DG, mapping: ChannelMapping, degree: int, points: int):
        self.mesh, self.mapping, self.degree = mesh, mapping, degree
        roots, weights = legendre.leggauss(points)
        self.line = (roots + 1) / 2, weights / 2
        self.basis = self._on(*self._square(*self.line))

    def _on(self, points: Array, weights: Array, elements: Array | None = None) -> Basis:
        return Basis(
            self.mesh,
            ElementQuadP(self.degree),
            self.mapping,
            quadrature=(points, weights),
            elements=elements,
            disable_doflocs=True,
        )

    @staticmethod
    def _square(points: Array, weights: Array) -> tuple[Array, Array]:
        x, y = np.meshgrid(points, points, indexing="ij")
        return np.array([x.ravel(), y.ravel()]), np.outer(weights, weights).ravel()

    def wall(self, top: bool) -> Basis:
        """The elements along a wall with their quadrature on it: fields there, to be integrated by hand."""
        centre = self.mapping.affine.F(np.array([[0.5], [0.5]]))[1, :, 0]
        at_wall = np.flatnonzero(np.isclose(centre, centre.max() if top else centre.min()))
        points, weights = self.line
        return self._on(np.array([np.full_like(points, float(top)), points]), weights, at_wall)

    def nodal(self, coefficients: Array, polynomials: Polynomials) -> Array:
        """Values at the nodes of `polynomials` (x nodes, eta nodes)."""
        degree = polynomials.degree
        local = lobatto_points(degree)
        nodes = self._on(*self._square(local, np.ones_like(local)))
        values = np.asarray(nodes.interpolate(coefficients)).reshape(-1, degree + 1, degree + 1)
        centre = self.mapping.affine.F(np.array([[0.5], [0.5]]))[:, :, 0]
        lines = (polynomials.x_lines, polynomials.eta_lines)
        column, row = (np.searchsorted(line, c) - 1 for line, c in zip(lines, centre, strict=True))
        result = np.empty([(len(line) - 1) * degree + 1 for line in lines])
        for a in range(degree + 1):
            for b in range(degree + 1):
                result[column * degree + b, row * degree + a] = values[:, a, b]
        return result
