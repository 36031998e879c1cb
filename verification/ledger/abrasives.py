"""Sec. 4.4 of the paper: what abrasives do to the stresses on the wafer, Figs. 17 and 18, and Table 1."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from verification.abrasive_statistics import interval, weight_percent
from verification.active_shear import (
    CASE,
    FREE_CASE,
    FREE_VARIANT,
    PROBE,
    SETTLING,
    count_of,
    read_wafer,
    result_path,
)
from verification.case import load_case
from verification.compare import Array
from verification.derived import greatest_wafer_shear
from verification.ledger.evidence import (
    CORRECTED,
    FAILS,
    HOLDS,
    OPEN,
    Claim,
    Evidence,
    Finding,
    Missing,
    percent,
)
from verification.measure import Result

SINGLE, SINGLE_VARIANT, DISC = "single_abrasive", "wafer_moves", "abrasive"
FROM_TIME = 1e-5  # s: the shear of a wafer that starts at once is infinite at that moment
# In widths of the asperity, from its top: right over it, in the gap, its flanks end, the bulk begins.
TOP, OVER, FLANK, BULK = 0.2, 0.5, 2.0, 2.0
PAPER_THRESHOLD = 288.5  # Pa
OWN_ERROR = 0.02  # of the paper in shear: what its scheme as written is off in the rough channel
POINTS, FINE = 200, 4000


def free_wafer(evidence: Evidence, points: int) -> tuple[Array, Array, Array]:
    """x in the pad's frame (m), pressure less its mean and shear (Pa) of the abrasive-free flow."""
    truth = evidence.truth(FREE_CASE, FREE_VARIANT)
    x = np.linspace(0, evidence.scene(FREE_CASE, FREE_VARIANT)["domain"]["upper"][0], points, endpoint=False)
    pressure = truth.wall_pressure(PROBE, x, 0.0)
    return x, pressure - pressure.mean(), truth.wall_shear(PROBE, x, 0.0)


@dataclass(frozen=True)
class Situations:
    """How far the wafer's stresses of one member are from those without abrasives, over its samples."""

    nearest: Array  # (t,) m, along x, from the top of the asperity to the nearest disc
    pressure: Array  # (t,) Pa, root mean square over the wafer
    shear: Array  # (t,) Pa
    in_gap_area: Array  # (t,) the share of the shear's squared change that is within a width of the top

    @classmethod
    def of(cls, path: Path, scene: dict[str, Any], free: tuple[Array, Array, Array]) -> Situations:
        x, pressure_free, shear_free = free
        times, along, pressure, shear = read_wafer(path)
        run = Result(path, scene["output"]["end_time"], scene)
        places = [run.disc(name, "position") for name in run.disc_names()]
        pad = next(wall for wall in scene["walls"] if wall["shape"] == "gaussian")
        speed = next(wall for wall in scene["walls"] if wall["name"] == PROBE)["velocity"][0]
        length = scene["domain"]["upper"][0]
        area = np.abs(x - pad["centre"]) < pad["width"]
        rows = []
        for index in np.flatnonzero(times > SETTLING * (1 + 1e-6)):
            order = np.argsort((along + speed * times[index]) % length)
            place = ((along + speed * times[index]) % length)[order]
            p, s = (np.interp(x, place, row[index][order], period=length) for row in (pressure, shear))
            apart = [at[np.argmin(np.abs(when - times[index])), 0] - pad["centre"] for when, at in places]
            changed = (s - shear_free) ** 2
            nearest = np.min(np.abs(np.array(apart) - length * np.round(np.array(apart) / length)))
            rms = float(np.sqrt(np.mean((p - p.mean() - pressure_free) ** 2)))
            rows.append((nearest, rms, math.sqrt(changed.mean()), changed[area].sum() / changed.sum()))
        return cls(*np.array(rows).T)


def situations(evidence: Evidence) -> list[Situations]:
    """Of all members of the ensemble at its spacing."""
    evidence.ensemble()
    found = evidence.abrasives or {}
    members = sorted({tuple(key) for pair in found["spacings"].values() for key in pair["members"]})
    case, free = load_case(CASE), free_wafer(evidence, POINTS)
    names = {count_of(case, variant): variant for variant in case.data["ensemble"]["variants"]}
    out = evidence.build / "figures"
    paths = [result_path(case, names[count], seed, found["spacing_m"], out) for count, seed in members]
    if not paths or not all(path.is_file() for path in paths):
        raise Missing("`make figures`")
    return [Situations.of(path, case.scene(), free) for path in paths]


def means(members: Sequence[Situations], field: str, low: float, high: float) -> Array:
    """Each member's mean of a field over samples whose nearest disc is that far (m), if it has any."""
    found = [getattr(m, field)[(m.nearest >= low) & (m.nearest < high)] for m in members]
    return np.array([values.mean() for values in found if values.size])


def _told(values: Array) -> tuple[str, tuple[float, float]]:
    """A mean with its interval; of a single member anything may be true."""
    ends = interval(values)
    if ends is None:
        return f"{values.mean():.2g} (no interval)", (-math.inf, math.inf)
    return f"{values.mean():.2g} ({ends[0]:.2g} to {ends[1]:.2g})", ends


def width_of(evidence: Evidence) -> float:
    scene = evidence.scene(FREE_CASE, FREE_VARIANT)
    return next(wall for wall in scene["walls"] if wall["shape"] == "gaussian")["width"]


def passing_and_bulk(evidence: Evidence) -> Finding:
    members, width = situations(evidence), width_of(evidence)
    _, pressure, shear = free_wafer(evidence, FINE)
    texts, apart, reverse = [], [], []
    for field, whole in (("shear", np.abs(shear).max()), ("pressure", np.abs(pressure).max())):
        over, bulk = means(members, field, 0, OVER * width), means(members, field, BULK * width, math.inf)
        if not over.size or not bulk.size:
            raise Missing(
                "`make figures`, with more members: no disc is ever in the gap, or none ever far from it"
            )
        (mine, ends), (other, far) = _told(over), _told(bulk)
        share = 100 * bulk.mean() / whole
        texts.append(
            f"of the {field} {mine} Pa in the gap and {other} Pa in the bulk, {share:.1g} % of its greatest "
            "without"
        )
        apart.append(ends[0] > far[1])
        reverse.append(over.mean() <= bulk.mean())
    count = means(members, "shear", BULK * width, math.inf).size
    return Finding(
        f"change along the wafer (root mean square) {'; '.join(texts)}",
        f"the abrasive-free flow by finite elements, {evidence.own_error(FREE_CASE)}",
        HOLDS if all(apart) else FAILS if any(reverse) else OPEN,
        "in the gap: a disc within sigma / 2 of the asperity's top; in the bulk: none within 2 sigma, which "
        f"{count} of {len(members)} members are at some time",
    )


def thinner_film(evidence: Evidence) -> Finding:
    members, width = situations(evidence), width_of(evidence)
    text, ends = _told(100 * means(members, "in_gap_area", 0, OVER * width))
    even = 100 * 2 * width / evidence.scene(FREE_CASE, FREE_VARIANT)["domain"]["upper"][0]
    scene = load_case(CASE).scene()
    pad = next(wall for wall in scene["walls"] if wall["shape"] == "gaussian")
    gap = scene["domain"]["upper"][1] - pad["base_height"] - pad["amplitude"]
    share = 2 * scene["discs"][0]["radius"] / gap
    return Finding(
        f"with a disc in the gap {text} % of the shear's squared change is within sigma of the asperity's "
        f"top, on {even:.0f} % of the wafer",
        f"a disc fills {100 * share:.0f} % of the gap",
        HOLDS if ends[0] > even else FAILS if ends[1] < even else OPEN,
        "over all numbers of discs; the rest is of discs elsewhere at the same time",
    )


def excess_by_place(evidence: Evidence) -> dict[str, tuple[float, float]]:
    """By where one abrasive is: the greatest shear over that without, of run and reference."""
    run, truth = evidence.run(SINGLE, SINGLE_VARIANT), evidence.truth(SINGLE, SINGLE_VARIANT)
    free = float(np.abs(free_wafer(evidence, FINE)[2]).max())
    times, shear = greatest_wafer_shear(run)
    pad = next(wall for wall in run.scene["walls"] if wall["shape"] == "gaussian")
    stamps, place = run.disc(DISC, "position")
    late = times > FROM_TIME
    apart = np.abs(np.interp(times, stamps, place[:, 0]) - pad["centre"]) / pad["width"]
    exact = np.array([truth.greatest_wafer_shear(time) for time in times[late]])
    found = {}
    for name, low, high in (("top", 0.0, TOP), ("flanks", OVER, FLANK)):
        there = (apart >= low) & (apart < high)
        found[name] = tuple(float(v.max()) / free for v in (shear[late & there], exact[there[late]]))
    return found


def shear_in_the_gap(evidence: Evidence) -> Finding:
    evidence.ensemble()
    places = (evidence.abrasives or {})["places"]
    found = excess_by_place(evidence)
    over, flanks = found["top"], found["flanks"]  # ours, and by immersed boundaries
    shares = ", ".join(f"{100 * share:.0f} % {name}" for name, share in places.items())
    large = min(flanks) > 1
    return Finding(
        f"one abrasive: {100 * (flanks[0] - 1):.0f} % above the threshold over the flanks, "
        f"{round(100 * (over[0] - 1)):+d} % over the top; active peaks of the ensemble from the top: "
        f"{shares}",
        f"one abrasive by immersed boundaries: {100 * (flanks[1] - 1):.0f} % and "
        f"{round(100 * (over[1] - 1)):+d} %, {evidence.own_error(SINGLE)}",
        FAILS if not large else CORRECTED if max(over) < min(flanks) else HOLDS,
        "without abrasives the shear is largest over the flanks, and there a disc adds to it; over the top "
        "it adds to less",
    )


def threshold(evidence: Evidence) -> Finding:
    check = evidence.check(FREE_CASE, "threshold")
    rule = (evidence.abrasives or {}).get("result", {}).get("rule", {})
    ours = f"within {percent(check)} of finite elements ({check['spacing_m']:g} m)"
    if "threshold" in rule:
        ours += f"; {rule['threshold']:.1f} Pa in the ensemble's own measure"
    exact = float(np.abs(free_wafer(evidence, FINE)[2]).max())
    off = PAPER_THRESHOLD / exact - 1
    return Finding(
        ours,
        f"{exact:.1f} Pa by finite elements, {evidence.own_error(FREE_CASE)}",
        HOLDS if check["passed"] and abs(off) < OWN_ERROR else FAILS,
        f"{PAPER_THRESHOLD} Pa is {100 * off:+.1g} % off the finite elements' value; the paper's own error "
        f"in shear may be {100 * OWN_ERROR:g} %",
    )


def table_1(evidence: Evidence) -> Finding:
    per_disc = weight_percent(1, load_case("abrasives").scene())
    counts, weights = (4, 8, 11, 15, 19, 22, 25, 29), (1.07, 1.87, 2.94, 3.75, 5.08, 5.89, 6.69, 7.49)
    fitting = [round(weight / per_disc) for weight in weights]
    wrong = [f"{c} for {f}" for c, f in zip(counts, fitting, strict=True) if c != f]
    return Finding(
        "not needed",
        f"one disc is {per_disc:.4f} % of the fluid by weight",
        CORRECTED if wrong else HOLDS,
        f"counts and weights fit each other but for {', '.join(wrong)}; the weights are plain ratios of "
        "mass, without the (1 - wt%) of Eq. 4.4",
    )


CLAIMS = (
    Claim("4.4", "Table 1: weights of 4 to 29 abrasives", table_1),
    Claim(
        "4.4",
        "abrasives in the bulk change wafer pressure and shear slightly, in the gap strongly (Fig. 18)",
        passing_and_bulk,
    ),
    Claim(
        "4.4",
        "abrasives in the gap change the film's thickness, and with it the stresses there (Fig. 17)",
        thinner_film,
    ),
    Claim("4.4", "large shear is found as abrasives pass the gap (Fig. 18b)", shear_in_the_gap),
    Claim("4.4", "the threshold, the largest shear without abrasives, is 288.5 Pa", threshold),
)
