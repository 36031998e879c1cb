"""Sec. 4.4 of the paper: the frequency of active shear over the concentration, Fig. 19."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

from verification.ledger.evidence import (
    FAILS,
    HOLDS,
    OPEN,
    Claim,
    Evidence,
    Finding,
    undecided,
    within,
)

STRONG = 10.0  # Akaike: a model this far behind the best in AIC has essentially no support
WEAK = 2.0  # and one this near has as much of it


def over_bands(decide: Callable[[dict[str, Any]], Finding]) -> Callable[[Evidence], Finding]:
    """A claim on F_tau by the rule's own band, with what the verdict is by the others."""

    def decided(evidence: Evidence) -> Finding:
        found = decide(evidence.ensemble())
        by_verdict: dict[str, list[str]] = {found.verdict: []}
        for row in evidence.bands():
            verdict = decide(row["result"]).verdict if "result" in row else OPEN
            by_verdict.setdefault(verdict, []).append(f"{100 * row['band']:g}")
        alike, *others = by_verdict.items()
        texts = [f"by bands of {', '.join(alike[1])} %"]
        texts += [f"{verdict} by {', '.join(bands)} %" for verdict, bands in others]
        return dataclasses.replace(found, range="; ".join(texts))

    return decided


def rises(result: dict[str, Any]) -> Finding:
    rise = result["rise"]
    return Finding(
        f"Kendall's tau {rise['kendall_tau']:.2f}, one-sided p = {rise['p']:.2g}",
        "none",
        HOLDS if rise["p"] < 0.01 else OPEN,
        "a test over the ensemble's members",
    )


def cube_root(result: dict[str, Any]) -> Finding:
    exponent, low, high = result["exponent_before"]
    behind = {row["model"]: row["aic"] - result["models_before"][0]["aic"] for row in result["models_before"]}
    best = result["models_before"][0]["model"]
    root = behind.get("cube root", math.inf)
    if root > STRONG or not within(1 / 3, (low, high)):
        verdict = FAILS
    else:
        verdict = HOLDS if root == 0 and min(v for v in behind.values() if v > 0) > WEAK else OPEN
    return Finding(
        f"exponent {exponent:.2f} ({low:.2f} to {high:.2f}) up to 5 %; best by AIC: {best}, the cube root "
        f"{root:.1f} behind",
        "none",
        verdict,
        "by likelihood against a straight line and 1 - exp(-lambda n)",
    )


def saturates(result: dict[str, Any]) -> Finding:
    slopes = [
        [v for v in result[f"slope_{part}_per_percent"] if v is not None] for part in ("before", "after")
    ]
    texts = [f"{s[0]:.3f}" + (f" ({s[1]:.3f} to {s[2]:.3f})" if s[1:] else " (no interval)") for s in slopes]
    before, after = slopes
    verdict = OPEN  # also of single members, which have no interval
    if before[1:] and after[1:]:
        rose = HOLDS if not within(0.0, before[1:]) else OPEN
        verdict = rose if within(0.0, after[1:]) else FAILS
    return Finding(
        f"slope {texts[0]} per % up to 5 %, {texts[1]} from there on",
        "none",
        verdict,
        "F_tau cannot exceed 1, so that any rise ends; the question is whether it ends near 5 %",
    )


CLAIMS = (
    Claim("4.4", "F_tau rises with the concentration (Fig. 19a)", over_bands(rises)),
    Claim("4.4", "F_tau is proportional to the cube root of wt% up to 5 % (Fig. 19b)", over_bands(cube_root)),
    Claim("4.4", "F_tau saturates near 5 % (Fig. 19a)", over_bands(saturates)),
    Claim(
        "4.4, 5",
        "removal rate goes like F_tau (Eq. 4.5), so that the results agree with experiments",
        undecided(
            "not asked",
            "none",
            "no removal is computed, and no measured one is compared with: the rows on F_tau say what it "
            "does",
        ),
    ),
)
