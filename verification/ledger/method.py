"""Sec. 2 of the paper: what is said of the method itself."""

from __future__ import annotations

import math
from typing import Any

from verification.ablation import mean_and_chance
from verification.ledger.evidence import CORRECTED, FAILS, HOLDS, OPEN, Claim, Evidence, Finding, by_checks

FACTORS = {1: 1 / 120, 2: 7 / (478 * math.pi), 3: 3 / (359 * math.pi)}  # Eq. 2.4
NORMAL = 1e-12
FLOW = "rough_channel"  # of the ablation, for what the pressure is worth
COMPETITIVE = 2.0  # times as long as the usual search by cells
BEYOND_CHANCE = 2.0  # standard errors


def kernel_integral(dimension: int) -> float:
    """Of the quintic spline without its factor, over all of that space: exact, by powers of q."""
    sphere = {1: 2.0, 2: 2 * math.pi, 3: 4 * math.pi}[dimension]
    total = 0.0
    for weight, edge in (
        (1, 3),
        (-6, 2),
        (15, 1),
    ):  # weight (edge - q)^5 for q < edge, times q^(dimension - 1)
        beta = math.gamma(dimension) * math.gamma(6) / math.gamma(dimension + 6)
        total += weight * beta * edge ** (dimension + 5)
    return sphere * total


def kernel_factors(evidence: Evidence, factors: dict[int, float] = FACTORS) -> Finding:
    integrals = {dimension: factor * kernel_integral(dimension) for dimension, factor in factors.items()}
    wrong = [dimension for dimension, value in integrals.items() if abs(value - 1) > NORMAL]
    texts = [f"{value:.4f} in {dimension}D" for dimension, value in integrals.items()]
    right = f"1/({kernel_integral(3) / math.pi:.0f} pi)"
    return Finding(
        f"the integrals are {', '.join(texts)}",
        "exact, by powers of q",
        HOLDS if not wrong else CORRECTED if wrong == [3] else FAILS,
        f"in 3D the factor is {right}; nothing here is in 3D" if wrong == [3] else "arithmetic",
    )


def conserves(evidence: Evidence) -> Finding:
    step = evidence.check("disc_conservation", "momentum_step")
    return Finding(
        f"linear momentum changes by {step['value']:.1g} of itself in a step",
        "exact",
        CORRECTED if step["passed"] else FAILS,
        "angular momentum is kept by the pressure's pair forces alone: those of viscosity in Eq. 2.15 are "
        "along the difference of velocity and not along the line of centres (README.md, not in the paper)",
    )


def _with_chance(row: dict[str, Any], quantity: str) -> tuple[float, float, str]:
    error, chance = mean_and_chance(row, quantity)
    return error, chance, f"{100 * error:.2g} +- {100 * chance:.1g} %"


def gradient_correction(evidence: Evidence) -> Finding:
    with_it, chance, text = _with_chance(evidence.change(FLOW, "default scheme"), "pressure")
    without, others, other = _with_chance(evidence.change(FLOW, "without gradient correction"), "pressure")
    noisy = _with_chance(evidence.change(FLOW, "without density diffusion"), "pressure")[2]
    beyond = abs(without - with_it) > BEYOND_CHANCE * math.hypot(chance, others)
    return Finding(
        f"the pressure at the particles is off by {text} with it and {other} without (rough channel, L2)",
        "steady Navier-Stokes by finite elements",
        OPEN if not beyond else HOLDS if with_it < without else FAILS,
        f"it is not enough by itself: with it and without density diffusion, as in the paper, {noisy}",
    )


def transport_velocity(evidence: Evidence) -> Finding:
    rows = {case: evidence.change(case, "without transport velocity") for case in (FLOW, "taylor_green")}
    stopped = {case: sum(bool(member["failure"]) for member in row["members"]) for case, row in rows.items()}
    members = sum(len(row["members"]) for row in rows.values())
    kept = [bool(m["failure"]) for case in rows for m in evidence.change(case, "default scheme")["members"]]
    total = sum(stopped.values())
    verdict = HOLDS if total == members and not any(kept) else OPEN if total > sum(kept) else FAILS
    return Finding(
        f"without it {total} of {members} runs stop ({', '.join(rows)}), with it {sum(kept)} of {len(kept)}",
        "none needed: a run goes through or does not",
        verdict,
        "the watchdog stops a run whose density is more than 10 % off or that loses a particle",
    )


def repulsion(evidence: Evidence) -> Finding:
    pair, crowd = (evidence.check(case, "overlap") for case in ("disc_pair", "abrasives"))
    return by_checks(
        (pair, crowd),
        f"greatest overlap {pair['value']:g} m of two discs that settle, {crowd['value']:g} m of abrasives",
        "rigid bodies do not overlap",
        "the paper's form of the force; its scale is chosen by the solver (docs/scene.md, contact)",
    )


def plane_sweep(evidence: Evidence) -> Finding:
    found = [row for row in evidence.searches() if row["set"] == "uniform" and row["threads"] == 1]
    points = max(row["points"] for row in found if row["search"] == "plane_sweep")
    seconds = {row["search"]: row["seconds"] for row in found if row["points"] == points}
    slower = seconds["plane_sweep"] / seconds["cells"]
    return Finding(
        f"{1e9 * seconds['plane_sweep'] / points:.0f} ns per point, cells "
        f"{1e9 * seconds['cells'] / points:.0f} ({points:g} points, one thread): {slower:.2g} times as long",
        "none: times of one machine",
        HOLDS if slower <= COMPETITIVE else OPEN,
        "the paper gives no time, and the sweep that we wrote need not be the one of its reference 33; both "
        "searches make the same lists",
    )


CLAIMS = (
    Claim(
        "2.1", "1/120, 7/(478 pi) and 3/(359 pi) normalise the kernel in 1D, 2D, 3D (Eq. 2.4)", kernel_factors
    ),
    Claim("2.1", "the sums over pairs keep linear and angular momentum exactly (Eq. 2.8)", conserves),
    Claim("2.4", "the transport velocity reduces clumping significantly", transport_velocity),
    Claim(
        "2.4",
        "the gradient correction reduces oscillations of the pressure significantly",
        gradient_correction,
    ),
    Claim("2.5.2", "the repulsion keeps solids from overlapping (Eqs. 2.27, 2.28)", repulsion),
    Claim("2.6", "the plane sweep is a competitive neighbour search, its speed-up satisfactory", plane_sweep),
)
