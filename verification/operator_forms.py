"""Sums over pairs of particles that stand for derivatives: the solver's, and other forms of them.

A form is called by what it sums. With V the volume of a particle, r_ij = r_i - r_j and F = (dW/dr) / r,

    M_i = -sum V F r_ij r_ij                          the moments, the unit matrix in a continuum
    B_i = M_i^-1                                      the gradient correction, Eqs. 2.21 and 2.22
    "p_i + p_j"          sum V F (p_i + p_j) r_ij     Eq. 2.15 with constant volumes: the solver's
    "p_j - p_i"          sum V F (p_j - p_i) r_ij
    "(p_j - p_i) B_i"    B_i times that               exact for linear fields
    "p_i B_i + p_j B_j"  sum V F (p_i B_i + p_j B_j) r_ij    conserves momentum, as the first
    "v_i - v_j"          2 sum V F (v_i - v_j)        Eq. 2.15: the solver's
    "over moments"       that over half the trace of M_i
    "of the remainder, over moments"   the same with v_i - v_j - r_ij . grad v, the gradient corrected by B_i
    "v_j - v_i", "(v_j - v_i) B_i"     divergences as the pressure's gradients; the second is the solver's
    "second-order fit"   least squares by a quadratic polynomial through the particle, weights -F

A linear fit with these weights would be "(p_j - p_i) B_i".
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from verification.compare import Array, DataError
from verification.run import REPOSITORY

KERNEL = REPOSITORY / "solver" / "kernels" / "fitted_quintic.hpp"  # the default scheme's
SUPPORT = 3.0  # smoothing lengths
GRADIENT, VISCOUS, DIVERGENCE, MOMENTS = "pressure gradient", "viscous force", "divergence", "moments"
FIT = "second-order fit"
OF_NEIGHBOURS = "p_i B_i + p_j B_j"  # its B_j reach two kernel supports from i
FORMS = {
    GRADIENT: ("p_i + p_j", "p_j - p_i", "(p_j - p_i) B_i", OF_NEIGHBOURS, FIT),
    VISCOUS: ("v_i - v_j", "over moments", "of the remainder, over moments", FIT),
    DIVERGENCE: ("v_j - v_i", "(v_j - v_i) B_i", FIT),
}
SOLVER = {GRADIENT: "p_i + p_j", VISCOUS: "v_i - v_j", DIVERGENCE: "(v_j - v_i) B_i", MOMENTS: ""}

Sums = dict[tuple[str, str], Array]  # by sum and form


@dataclass(frozen=True)
class Cloud:
    """Fluid particles (n, 2) and those of walls (m, 2) in m at a time in s; `period` (2,) in m, 0: none."""

    position: Array
    wall: Array
    time: float
    period: Array
    spacing: float

    def wrapped(self, places: Array) -> Array:
        """Places (n, 2) in m, those beyond a periodic side brought back."""
        periodic = self.period > 0
        return np.where(periodic, places % np.where(periodic, self.period, 1.0), places)

    def nearest(self, apart: Array) -> Array:
        """Differences (n, 2) of places in m, to the nearest of the periodic images."""
        return apart - self.period * np.round(apart / np.where(self.period > 0, self.period, np.inf))


@dataclass(frozen=True)
class Pairs:
    """Every pair of neighbours both ways: r_i - r_j (pairs, 2) in m, V F (pairs,) in 1/m2."""

    i: Array
    j: Array
    apart: Array
    weight: Array
    particles: int

    def total(self, terms: Array) -> Array:
        """Sums (particles, k) over j of the pairs' terms (pairs, k)."""
        return np.column_stack([np.bincount(self.i, term, self.particles) for term in terms.T])


def _coefficients() -> Array:
    """The solver's own coefficients of the default kernel."""
    found = re.search(r"coefficients\{(.*?)\}", KERNEL.read_text(), re.DOTALL)
    if not found:
        raise DataError(f"{KERNEL.name} names no coefficients")
    return np.array([float(c) for c in found[1].split(",")])


def kernel_slope(squared: Array) -> Array:
    """h^4 (dW/dr) / r of the default kernel from (r / h)^2."""
    left = np.maximum(0.0, 1.0 - squared / SUPPORT**2)
    return -(left**5) * np.polynomial.polynomial.polyval(left, _coefficients())


def kernel_value(squared: Array) -> Array:
    """h^2 W of the default kernel from (r / h)^2: the integral of its slope."""
    left = np.maximum(0.0, 1.0 - squared / SUPPORT**2)
    coefficients = 0.5 * SUPPORT**2 * _coefficients() / np.arange(6, 6 + len(_coefficients()))
    return left**6 * np.polynomial.polynomial.polyval(left, coefficients)


def pairs_of(cloud: Cloud) -> Pairs:
    """Of a cloud's fluid particles."""
    h, inside = cloud.spacing, cloud.wrapped(cloud.position)  # the default smoothing_ratio is 1
    i, j = cKDTree(inside, boxsize=cloud.period).query_pairs(SUPPORT * h, output_type="ndarray").T
    i, j = np.concatenate([i, j]), np.concatenate([j, i])
    apart = cloud.nearest(inside[i] - inside[j])
    weight = kernel_slope((apart**2).sum(axis=1) / h**2) / h**2  # V = h^2
    return Pairs(i, j, apart, weight, len(inside))


def quadratic(x: Array, y: Array) -> Array:
    """The functions (n, 5) whose factors are a field's first and second derivatives."""
    return np.column_stack([x, y, x**2 / 2, x * y, y**2 / 2])


def fitted_derivatives(pairs: Pairs, fields: Array, scale: float) -> Array:
    """Derivatives (particles, 5, k), in the order of `quadratic`, of fields (particles, k) by least squares;
    lengths are taken over `scale` in m.
    """
    functions = quadratic(*(-pairs.apart.T / scale))
    weighted = -pairs.weight[:, None] * functions
    change, count = fields[pairs.j] - fields[pairs.i], functions.shape[1]
    matrix = np.stack([pairs.total(weighted * column[:, None]) for column in functions.T], axis=2)
    right = np.stack([pairs.total(weighted * column[:, None]) for column in change.T], axis=2)
    powers = np.where(np.arange(count) < 2, 1, 2)
    return np.linalg.solve(matrix, right) / (scale**powers)[:, None]


def _matrices(pairs: Pairs) -> Array:
    """M_i (particles, 2, 2)."""
    x, y = pairs.apart.T
    xx, yy, xy = -pairs.total(pairs.weight[:, None] * np.column_stack([x * x, y * y, x * y])).T
    return np.stack([np.stack([xx, xy], axis=1), np.stack([xy, yy], axis=1)], axis=1)


def _pressure_gradients(pairs: Pairs, pressure: Array, correction: Array) -> Sums:
    """Those of FORMS but the fit, (particles, 2) each."""
    own, other = pressure[pairs.i, None], pressure[pairs.j, None]
    slope = pairs.weight[:, None] * pairs.apart
    difference = pairs.total((other - own) * slope)
    mean = own[:, :, None] * correction[pairs.i] + other[:, :, None] * correction[pairs.j]
    found = (
        pairs.total((own + other) * slope),
        difference,
        np.einsum("nab,nb->na", correction, difference),
        pairs.total(np.einsum("nab,nb->na", mean, slope)),
    )
    return {(GRADIENT, form): value for form, value in zip(FORMS[GRADIENT], found, strict=False)}


def _of_velocity(pairs: Pairs, velocity: Array, moments: Array, correction: Array) -> Sums:
    """The viscous forces (particles, 2) and the divergences (particles, 1) of FORMS but the fits."""
    change, weight = velocity[pairs.j] - velocity[pairs.i], pairs.weight[:, None]
    # [n, a, b]: of velocity a along axis b
    plain = np.stack([pairs.total(weight * pairs.apart * of[:, None]) for of in change.T], axis=1)
    gradient = np.einsum("nac,ncb->nab", plain, correction)
    remainder = change + np.einsum("nab,nb->na", gradient[pairs.i], pairs.apart)
    half_trace = 0.5 * np.trace(moments, axis1=1, axis2=2)[:, None]
    viscous = pairs.total(-2 * weight * change)
    return {
        (VISCOUS, "v_i - v_j"): viscous,
        (VISCOUS, "over moments"): viscous / half_trace,
        (VISCOUS, "of the remainder, over moments"): pairs.total(-2 * weight * remainder) / half_trace,
        (DIVERGENCE, "v_j - v_i"): np.trace(plain, axis1=1, axis2=2)[:, None],
        (DIVERGENCE, "(v_j - v_i) B_i"): np.trace(gradient, axis1=1, axis2=2)[:, None],
    }


def sums(cloud: Cloud, velocity: Array, pressure: Array) -> Sums:
    """All FORMS at the particles of a cloud, in units of the derivatives that they stand for: (n, 2), (n, 2),
    (n, 1); and of MOMENTS, without a form, (n, 3) M_xx, M_yy, M_xy, which are 1, 1, 0 in a continuum.
    """
    pairs = pairs_of(cloud)
    moments = _matrices(pairs)
    correction = np.linalg.inv(moments)
    found = _pressure_gradients(pairs, pressure, correction)
    found |= _of_velocity(pairs, velocity, moments, correction)
    fit = fitted_derivatives(pairs, np.column_stack([velocity, pressure]), cloud.spacing)
    found[GRADIENT, FIT] = fit[:, :2, 2]
    found[VISCOUS, FIT] = fit[:, 2, :2] + fit[:, 4, :2]
    found[DIVERGENCE, FIT] = (fit[:, 0, 0] + fit[:, 1, 1])[:, None]
    found[MOMENTS, ""] = np.column_stack([moments[:, 0, 0], moments[:, 1, 1], moments[:, 0, 1]])
    return found
