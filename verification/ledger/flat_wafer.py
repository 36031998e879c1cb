"""Sec. 4.2 of the paper: a Gaussian asperity under a flat wafer."""

from __future__ import annotations

import math
from typing import Any

from verification.asperity import PAPER_RATE, PAPER_SLOPE
from verification.ledger.evidence import CORRECTED, FAILS, HOLDS, Claim, Evidence, Finding, Missing, within

BENT = 0.1  # of the range of the pressures, off a straight line
STRAIGHT = 1.5  # between the largest and the smallest local rate of an exponential


def slope_over_width(evidence: Evidence) -> Finding:
    truth = evidence.sweep("finite_elements", "width")
    found = f"{truth['slope']:.2f} Pa/um ({truth['interval_95'][0]:.2f} to {truth['interval_95'][1]:.2f})"
    try:
        own = evidence.sweep("sph", "width")
        ours = f"{own['slope']:.2f} Pa/um ({own['interval_95'][0]:.2f} to {own['interval_95'][1]:.2f})"
    except Missing as missing:
        ours = f"not run: {missing}"
    bent = truth["largest_residual"]
    straight = CORRECTED if bent < BENT else FAILS
    return Finding(
        ours,
        f"{found}; off the line by up to {100 * bent:.1f} % of its range",
        HOLDS if within(PAPER_SLOPE, truth["interval_95"]) else straight,
        "in a channel of 40 um; the paper prints neither the unit nor the length, and the length decides "
        "the slope (verification/gaussian_asperity/README.md)",
    )


def rate_over_gap(evidence: Evidence) -> Finding:
    truth = evidence.sweep("finite_elements", "gap")
    exponential, local = truth["exponential"], [row["rate"] for row in truth["local_rates"]]
    low, high = exponential["interval_95"]
    try:
        own = evidence.sweep("sph", "gap")["exponential"]
        ours = f"{own['rate']:.2f} per 1e-5 m ({own['interval_95'][0]:.2f} to {own['interval_95'][1]:.2f})"
    except Missing as missing:
        ours = f"not run: {missing}"
    straight = max(local) < STRAIGHT * min(local)
    if straight:
        verdict = HOLDS if within(PAPER_RATE, (low, high)) else CORRECTED
    else:
        verdict = CORRECTED if within(PAPER_RATE, (low, high)) else FAILS
    return Finding(
        ours,
        f"{exponential['rate']:.2f} ({low:.2f} to {high:.2f}); the local rate falls from {max(local):.2f} to "
        f"{min(local):.2f}",
        verdict,
        "the rate is the average over these gaps; the law is that of lubrication, not an exponential"
        if not straight
        else "one rate describes all gaps",
    )


def growth(sweep: dict[str, Any], parameter: str) -> tuple[float, float]:
    """By how much the pressure changes from end to end of a sweep, as a factor, and the mean exponent."""
    first, last = sweep["values"][0], sweep["values"][-1]
    ratio = last["pressure_Pa"] / first["pressure_Pa"]
    return max(ratio, 1 / ratio), abs(math.log(ratio) / math.log(last[parameter] / first[parameter]))


def height_matters_more(evidence: Evidence) -> Finding:
    texts, wider = [], []
    for source in ("sph", "finite_elements"):
        gap = growth(evidence.sweep(source, "gap"), "gap_m")
        width = growth(evidence.sweep(source, "width"), "width_m")
        texts.append(
            f"by a factor of {gap[0]:.3g} over the gap and {width[0]:.3g} over the width; exponents "
            f"{gap[1]:.2f} and {width[1]:.2f}"
        )
        wider.append(gap[0] > width[0] and gap[1] > width[1])
    return Finding(
        f"over the paper's ranges the pressure changes {texts[0]}",
        texts[1],
        HOLDS if all(wider) else FAILS,
        "in a channel of 40 um; verification/gaussian_asperity/README.md has other lengths",
    )


CLAIMS = (
    Claim(
        "4.2",
        "the pressure maximum is linear in sigma, slope 9.28 at a gap of 7 um (Fig. 13a)",
        slope_over_width,
    ),
    Claim("4.2", "it falls as exp(-3.636 H_gap), H_gap in 1e-5 m, at sigma = 6 um (Fig. 13b)", rate_over_gap),
    Claim("4.2", "the asperity's height matters more for the pressure than its width", height_matters_more),
)
