"""Sec. 4.3 of the paper: a wafer with a feature over a moving asperity, Figs. 14 and 15."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from reference.moving_channel import INSTANTS
from verification.compare import Array
from verification.ledger.evidence import (
    CORRECTED,
    FAILS,
    HOLDS,
    MICRO,
    OPEN,
    Claim,
    Evidence,
    Finding,
    by_checks,
    percent,
    undecided,
)

CASE, WAFER, VARIANTS = "wafer_feature", "wafer", ("arc", "cavity", "sine")
SAMPLE_CHECK = "sample_peak"
CORNER = 1e-6  # m, that count as the corner area: a fifth of the arc's radius
SHARE = 0.5  # of the greatest pressure, from which on a zone counts as one of high pressure
POINTS, PHASES, FINE = 800, 50, 401


@dataclass(frozen=True)
class Swept:
    """Pressure on the wafer less its mean at each time, over a period."""

    x: Array  # (n,) m
    tip: Array  # (t,) m, where the asperity is
    pressure: Array  # (t, n) Pa

    @property
    def envelope(self) -> Array:
        """The greatest at each place over the period (n,)."""
        return self.pressure.max(axis=0)

    def greatest(self) -> tuple[float, float]:
        """Pa, and where, m."""
        return float(self.envelope.max()), float(self.x[self.envelope.argmax()])

    def near(self, place: float) -> float:
        """The greatest within CORNER of a place, Pa."""
        return float(self.envelope[np.abs(self.x - place) <= CORNER].max())


def wafer_of(scene: dict[str, Any]) -> dict[str, Any]:
    return next(wall for wall in scene["walls"] if wall["name"] == WAFER)


def pad_of(scene: dict[str, Any]) -> dict[str, Any]:
    return next(wall for wall in scene["walls"] if wall["name"] != WAFER)


def tip_at(scene: dict[str, Any], times: Array) -> Array:
    pad = pad_of(scene)
    return (pad["centre"] + pad["velocity"][0] * times) % scene["domain"]["upper"][0]


def period_of(scene: dict[str, Any]) -> float:
    return scene["domain"]["upper"][0] / pad_of(scene)["velocity"][0]


def ends(scene: dict[str, Any]) -> tuple[float, float]:
    """Where the feature begins and ends, m; the asperity comes from the first one."""
    wafer = wafer_of(scene)
    arc = wafer["shape"] == "arc"
    half = wafer["radius"] * math.sin(wafer["angle"] / 2) if arc else wafer["length"] / 2
    return wafer["centre"] - half, wafer["centre"] + half


def swept(x: Array, times: Array, pressure: Array, scene: dict[str, Any]) -> Swept:
    return Swept(x, tip_at(scene, times), pressure - pressure.mean(axis=1, keepdims=True))


def both(evidence: Evidence, variant: str) -> tuple[Swept, Swept]:
    """Of the last period of the run, and of finite elements."""
    scene, run = evidence.scene(CASE, variant), evidence.run(CASE, variant)
    period = period_of(scene)
    times, x, pressure = run.wall_samples(WAFER, "pressure")
    last = times > times[-1] - period * (1 + 1e-6)
    truth = evidence.truth(CASE, variant)
    even = np.linspace(0, scene["domain"]["upper"][0], POINTS, endpoint=False)
    moments = np.arange(PHASES) * period / PHASES
    exact = np.array([truth.wall_pressure(WAFER, even, moment) for moment in moments])
    return swept(x, times[last], pressure[last], scene), swept(even, moments, exact, scene)


def flat_wafer(evidence: Evidence, width: float) -> float:
    """The greatest pressure over the mean on a flat wafer above an asperity of that width (m), Pa."""
    rows = evidence.sweep("finite_elements", "width")["values"]
    return float(np.interp(width, [row["width_m"] for row in rows], [row["pressure_Pa"] for row in rows]))


def high_in_the_feature(evidence: Evidence) -> Finding:
    texts: tuple[list[str], list[str]] = ([], [])
    inside = []
    flat = flat_wafer(evidence, pad_of(evidence.scene(CASE, VARIANTS[0]))["width"])
    for variant in VARIANTS:
        first, last = ends(evidence.scene(CASE, variant))
        for text, found in zip(texts, both(evidence, variant), strict=True):
            value, place = found.greatest()
            text.append(f"{variant} {value:.0f} Pa at x = {MICRO * place:.1f} um")
            inside.append(value > flat and first - CORNER <= place <= last + CORNER)
    return Finding(
        f"greatest pressure on the wafer over its mean: {', '.join(texts[0])}",
        f"{', '.join(texts[1])}; {flat:.0f} Pa on a flat wafer ({evidence.own_error(CASE)})",
        HOLDS if all(inside) else FAILS,
        "at the sharp corners of the cavity an exact pressure is unbounded, so that its number depends on "
        "the spacing",
    )


def around_the_tip(evidence: Evidence, variant: str = "arc") -> Finding:
    run, truth, scene = (
        evidence.run(CASE, variant),
        evidence.truth(CASE, variant),
        evidence.scene(CASE, variant),
    )
    period, length, width = period_of(scene), scene["domain"]["upper"][0], pad_of(scene)["width"]
    start = run.end_time - period
    ahead: dict[str, list[tuple[float, float]]] = {"sph": [], "exact": []}
    for phase in INSTANTS:
        particles = run.particles(start + phase * period)
        tip = tip_at(scene, np.array(particles.time))
        x = particles.position[:, 0]
        from_tip = (x - tip + length / 2) % length - length / 2
        exact = truth.pressure(*particles.position.T, particles.time)
        for name, field in (("sph", particles.pressure), ("exact", exact)):
            ahead[name].append((float(from_tip[field.argmax()]), float(from_tip[field.argmin()])))
    highs, lows = ([pair[end] for pairs in ahead.values() for pair in pairs] for end in (0, 1))
    texts = [
        f"highest {MICRO * min(h):.1f} to {MICRO * max(h):.1f} um ahead of the tip, lowest "
        f"{-MICRO * max(low):.1f} to {-MICRO * min(low):.1f} um behind it"
        for h, low in ((list(column) for column in zip(*pairs, strict=True)) for pairs in ahead.values())
    ]
    one_sided = min(highs) > 0 and max(lows) < 0
    return Finding(
        f"at {len(INSTANTS)} instants {texts[0]}",
        f"at the same places {texts[1]} ({evidence.own_error(CASE)})",
        FAILS if max(map(abs, highs)) > width else CORRECTED if one_sided else HOLDS,
        "where the gap narrows ahead of the asperity the pressure is high; behind, where it widens, it is "
        "low",
    )


def corner_of_the_arc(evidence: Evidence) -> Finding:
    found = both(evidence, "arc")
    first, last = ends(evidence.scene(CASE, "arc"))
    shares = [
        (swept.near(first) / swept.greatest()[0], swept.near(last) / swept.greatest()[0]) for swept in found
    ]
    texts = [
        f"{100 * a:.0f} % at the corner that it meets first, {100 * b:.0f} % at the other" for a, b in shares
    ]
    met = [share[0] >= SHARE for share in shares]
    return Finding(
        f"of the wafer's greatest pressure {texts[0]} (within {MICRO * CORNER:g} um)",
        f"{texts[1]} ({evidence.own_error(CASE)})",
        FAILS if not all(met) else HOLDS,
        "so for the corner that the asperity comes to first; the other one lies in the low pressure behind "
        "the arc",
    )


def corner_of_the_cavity(evidence: Evidence) -> Finding:
    corners = ends(evidence.scene(CASE, "cavity"))
    texts, at_corner = [], []
    for found in both(evidence, "cavity"):
        value, place = found.greatest()
        middle = np.abs(found.x - sum(corners) / 2) <= CORNER
        texts.append(
            f"greatest at x = {MICRO * place:.1f} um ({value:.0f} Pa; the corners are at "
            f"{MICRO * corners[0]:.1f} and {MICRO * corners[1]:.1f} um), {found.envelope[middle].max():.0f} "
            "Pa in the middle of the cavity"
        )
        at_corner.append(min(abs(place - corner) for corner in corners) <= CORNER)
    return Finding(
        texts[0],
        f"{texts[1]} ({evidence.own_error(CASE)})",
        HOLDS if all(at_corner) else FAILS,
        "an exact pressure is unbounded at a sharp corner that points into the fluid: where it is greatest "
        "is sure, how great is not",
    )


def pile_of_the_sine(evidence: Evidence) -> Finding:
    first, last = ends(evidence.scene(CASE, "sine"))
    middle = (first + last) / 2  # hollow before it, pile behind it
    texts, on_pile = [], []
    for found in both(evidence, "sine"):
        value, place = found.greatest()
        when = found.tip[found.pressure.max(axis=1).argmax()]
        texts.append(
            f"greatest at x = {MICRO * place:.1f} um ({value:.0f} Pa; the pile is from {MICRO * middle:.1f} "
            f"to {MICRO * last:.1f} um), the asperity at {MICRO * when:.1f} um"
        )
        on_pile.append(middle <= place <= last and when < place)
    return Finding(
        texts[0],
        f"{texts[1]} ({evidence.own_error(CASE)})",
        HOLDS if all(on_pile) else FAILS,
        "the length of the sine is open in the paper: hollow and pile are here as wide as the arc",
    )


def repeats(evidence: Evidence) -> Finding:
    checks = [evidence.check(CASE, "sample_repeats", variant) for variant in VARIANTS]
    texts = [f"{percent(check)} ({variant})" for check, variant in zip(checks, VARIANTS, strict=True)]
    period = period_of(evidence.scene(CASE, "arc"))
    return by_checks(
        checks,
        f"from one period of {period:g} s to the next the pressure at the sample point differs by "
        f"{', '.join(texts)} of its range",
        "exact: a periodic flow repeats",
        "what differs is noise of the particles",
    )


def peak_time(evidence: Evidence) -> Finding:
    check = evidence.check(CASE, SAMPLE_CHECK, "arc")
    scene, truth = evidence.scene(CASE, "arc"), evidence.truth(CASE, "arc")
    place = next(probe["position"][0] for probe in scene["probes"] if probe["name"] == "sample")
    moments = np.linspace(0, period_of(scene), FINE)
    pressure = [truth.wall_pressure(WAFER, np.array([place]), moment)[0] for moment in moments]
    top = moments[int(np.argmax(pressure))]
    before = place - tip_at(scene, np.array(top))
    return Finding(
        f"within {check['value']:.2g} of a period of finite elements",
        f"at {top / period_of(scene):.2f} T of ours, the asperity {MICRO * before:.1f} um before the sample "
        "point",
        OPEN,
        "the paper's t0 is where it sets it: the time says where the asperity started, which is not printed",
    )


CLAIMS = (
    Claim("4.3", "a high pressure zone occurs in the wafer's feature area", high_in_the_feature),
    Claim("4.3.1", "a high pressure zone is around the tip of the asperity (Fig. 15a)", around_the_tip),
    Claim(
        "4.3.1",
        "as the asperity comes near, the zone extends to the corner of the arc (Fig. 15a)",
        corner_of_the_arc,
    ),
    Claim("4.3.1", "the pressure at the sample point peaks at 0.7 T (Fig. 14)", peak_time),
    Claim("4.3.1", "the asperity makes the wafer's forces periodic (Figs. 14, 15)", repeats),
    Claim(
        "4.3.2", "in the cavity a high pressure zone forms around the corner (Fig. 15b)", corner_of_the_cavity
    ),
    Claim(
        "4.3.3",
        "a high pressure zone forms around the pile as the asperity comes (Fig. 15c)",
        pile_of_the_sine,
    ),
    Claim(
        "4.3",
        "removal happens where the stresses are high: near the corner, as in an experiment",
        undecided(
            "not asked",
            "none",
            "neither the paper nor we compute a removal; of the stresses the rows above say where they are "
            "high",
        ),
    ),
)
