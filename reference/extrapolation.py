"""From values on three grids to those at spacing zero."""

import numpy as np
from scipy.optimize import brentq

from reference.base import Array


def extrapolated(values: Array, spacings: Array) -> tuple[Array, float, float]:
    """Values at spacing zero, order, largest change to them from the finest grid's.

    values (3, ...), the coarsest grid first; spacings (3,), the finest 1. One order for all, between 1 and 2,
    from the largest changes from grid to grid.
    """
    sizes = [float(np.abs(change).max()) for change in np.diff(values, axis=0)]

    def excess(order: float) -> float:
        coarse, fine = -np.diff(spacings**order)
        return sizes[0] * fine - sizes[1] * coarse

    order = 1.0 if excess(1) <= 0 else 2.0 if excess(2) >= 0 else brentq(excess, 1, 2)
    correction = (values[-1] - values[-2]) / (spacings[-2] ** order - 1)
    return values[-1] + correction, order, float(np.abs(correction).max())
