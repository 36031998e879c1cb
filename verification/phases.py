"""Drafting, kissing, tumbling and separation of two discs that settle one above the other (feng1994)."""

from __future__ import annotations

import numpy as np

from verification.compare import Array

PHASES = ("drafting", "kissing", "tumbling", "separation")
KISSING_GAP = 0.1  # diameters
SEPARATE_GAP = 0.2


def phases(times: Array, leading: Array, trailing: Array, diameter: float) -> dict[str, float]:
    """When each phase begins, s; a phase that does not come after the one before ends the list.

    `times` (n,), positions (n, 2) in m with y upwards. Definitions, from the trajectories alone:
    drafting:   the trailing disc, drawn into the wake, has made up half of the gap between the rims;
    kissing:    the gap is at most KISSING_GAP diameters;
    tumbling:   the line of centres has turned by more than 45 degrees from the vertical;
    separation: the gap is more than SEPARATE_GAP diameters again.
    """
    across, up = (trailing - leading).T
    gap = np.hypot(across, up) - diameter
    reached = {
        "drafting": gap <= gap[0] / 2,
        "kissing": gap <= KISSING_GAP * diameter,
        "tumbling": np.abs(across) > up,
        "separation": gap > SEPARATE_GAP * diameter,
    }
    found: dict[str, float] = {}
    start = 0
    for phase in PHASES:
        when = np.flatnonzero(reached[phase][start:])
        if len(when) == 0:
            break
        start += int(when[0])
        found[phase] = float(times[start])
    return found
