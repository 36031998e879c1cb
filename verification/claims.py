"""The ledger of the paper's claims: `python -m verification.claims` writes verification/claims.md.

Each claim is a function of the evidence: the checks of build/verify/results.json, asperity.json beside it
(`python -m verification.asperity`) and build/figures/abrasives.json (`make figures`). Where some of it is
missing, the command says what to run and writes nothing. It also writes the tables of F_tau's sensitivity
into the README of the abrasives.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verification import abrasive_page
from verification.abrasive_statistics import weight_percent
from verification.active_shear import CASE as ABRASIVES
from verification.case import ROOT, load_case
from verification.markers import replace_between
from verification.page import Table

BUILD = ROOT.parent / "build"
HOLDS, CORRECTED, FAILS, OPEN = "holds", "holds with a correction", "does not hold", "cannot be decided"
STRONG = 10.0  # Akaike: a model this far behind the best in AIC has essentially no support
WEAK = 2.0  # and one this near has as much of it


class Missing(LookupError):
    """Evidence that has not been made; what() is the command that makes it."""


@dataclass(frozen=True)
class Finding:
    ours: str
    truth: str  # what is independent of the particles
    verdict: str
    why: str
    range: str = ""  # of the rule's band, for which the verdict holds


@dataclass(frozen=True)
class Evidence:
    """The results (see the module's docstring); members raise Missing."""

    results: dict[str, Any] | None
    asperity: dict[str, Any] | None
    abrasives: dict[str, Any] | None

    @classmethod
    def read(cls, build: Path) -> Evidence:
        files = ("verify/results.json", "verify/asperity.json", "figures/abrasives.json")
        paths = [build / file for file in files]
        return cls(*(json.loads(path.read_text()) if path.exists() else None for path in paths))

    def check(self, case: str, quantity: str, variant: str = "") -> dict[str, Any]:
        """The check at the finest spacing of the default scheme, with the spacing as `spacing_m`."""
        for entry in (self.results or {}).get("cases", []):
            wanted = entry["case"] == case and entry["scheme"] == "default" and entry["finest"]
            if wanted and variant in ("", entry["variant"]):
                for check in entry["checks"]:
                    if check["quantity"] == quantity:
                        return check | {"spacing_m": entry["spacing_m"]}
        raise Missing(f"`make verify`, case {case}")

    def sweep(self, source: str, of: str) -> dict[str, Any]:
        found = (self.asperity or {}).get(source, {}).get(of, {})
        if "points" not in found and "exponential" not in found:
            raise Missing("`make verify LEVEL=paper`, then `python -m verification.asperity`")
        return found

    def ensemble(self) -> dict[str, Any]:
        if self.abrasives is None or "bands" not in self.abrasives:  # or of an older make figures
            raise Missing("`make figures`")
        return self.abrasives["result"]

    def bands(self) -> list[dict[str, Any]]:
        """The ensemble by every band outside of the abrasive-free run's noise."""
        self.ensemble()
        return [row for row in (self.abrasives or {})["bands"] if not row["within_noise"]]


def percent(check: dict[str, Any]) -> str:
    value = check["value"]
    return "no number" if value is None else f"{100 * value:.2g} %"


def by_check(check: dict[str, Any], ours: str, truth: str, why: str) -> Finding:
    """A claim that stands or falls with a check."""
    return Finding(ours, truth, HOLDS if check["passed"] else FAILS, why)


def within(value: float, interval: Sequence[float]) -> bool:
    return min(interval) <= value <= max(interval)


def agrees_with_fluent(evidence: Evidence) -> Finding:
    pressure = evidence.check("rough_channel", "wafer_pressure", "top_wall_moves")
    shear = evidence.check("rough_channel", "wafer_shear", "top_wall_moves")
    both = pressure if not pressure["passed"] else shear
    return by_check(
        both,
        f"pressure within {percent(pressure)}, shear within {percent(shear)} (L2, {shear['spacing_m']:g} m)",
        "steady Navier-Stokes by finite elements",
        "the paper shows curves and no number",
    )


def either_wall(evidence: Evidence) -> Finding:
    pressure = evidence.check("rough_channel", "wafer_pressure_of_variants")
    shear = evidence.check("rough_channel", "wafer_shear_of_variants")
    both = pressure if not pressure["passed"] else shear
    return by_check(
        both,
        f"they differ by {percent(pressure)} in pressure and {percent(shear)} in shear (L2)",
        "the two are one flow seen from two frames",
        "the difference is an error of the particles, not a property of the flow",
    )


def steady_times(evidence: Evidence) -> Finding:
    flat = evidence.check("rough_channel", "kinetic_energy_steady", "top_wall_moves")
    curved = evidence.check("rough_channel", "kinetic_energy_steady", "bottom_wall_moves")
    return by_check(
        flat if not flat["passed"] else curved,
        f"the kinetic energy stays within {percent(flat)} (flat) and {percent(curved)} (curved) of its last",
        "none needed: the run's own last value",
        "the paper does not say how near to steady it means",
    )


def drafting(evidence: Evidence) -> Finding:
    contact = evidence.check("disc_pair", "contact_time")
    leading = evidence.check("disc_pair", "leading_height")
    trailing = evidence.check("disc_pair", "trailing_height")
    worst = next((c for c in (contact, leading, trailing) if not c["passed"]), contact)
    return by_check(
        worst,
        f"out of the published band by {leading['value']:.2g} and {trailing['value']:.2g} m before contact; "
        f"contact out of its band by {contact['value']:.2g} s",
        "three published curves; our immersed-boundary solver",
        "what follows contact is an instability: from a symmetric start nothing tumbles, and the side "
        "depends on the perturbation (disc_pair_ensemble)",
    )


def slope_over_width(evidence: Evidence) -> Finding:
    truth = evidence.sweep("finite_elements", "width")
    found = f"{truth['slope']:.2f} Pa/um ({truth['interval_95'][0]:.2f} to {truth['interval_95'][1]:.2f})"
    try:
        own = evidence.sweep("sph", "width")
        ours = f"{own['slope']:.2f} Pa/um ({own['interval_95'][0]:.2f} to {own['interval_95'][1]:.2f})"
    except Missing as missing:
        ours = f"not run: {missing}"
    bent = truth["largest_residual"]
    straight = CORRECTED if bent < 0.1 else FAILS
    return Finding(
        ours,
        f"{found}; off the line by up to {100 * bent:.1f} % of its range",
        HOLDS if within(9.28, truth["interval_95"]) else straight,
        "in a channel of 40 um; the paper prints neither the unit nor the length, and the length decides the "
        "slope (verification/gaussian_asperity/README.md)",
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
    straight = max(local) < 1.5 * min(local)
    if straight:
        verdict = HOLDS if within(3.636, (low, high)) else CORRECTED
    else:
        verdict = CORRECTED if within(3.636, (low, high)) else FAILS
    return Finding(
        ours,
        f"{exponential['rate']:.2f} ({low:.2f} to {high:.2f}); the local rate falls from {max(local):.2f} to "
        f"{min(local):.2f}",
        verdict,
        "the rate is the average over these gaps; the law is that of lubrication, not an exponential"
        if not straight
        else "one rate describes all gaps",
    )


def threshold(evidence: Evidence) -> Finding:
    check = evidence.check("abrasive_free", "threshold")
    rule = (evidence.abrasives or {}).get("result", {}).get("rule", {})
    ours = f"within {percent(check)} of finite elements ({check['spacing_m']:g} m)"
    if "threshold" in rule:
        ours += f"; {rule['threshold']:.1f} Pa in the ensemble's own measure"
    return Finding(
        ours,
        "287.2 Pa (design.md section 5, and the check's reference)",
        HOLDS if check["passed"] else FAILS,
        "288.5 Pa is 0.5 % above the finite elements' value, within the paper's own error in shear",
    )


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


def peak_time(evidence: Evidence) -> Finding:
    check = evidence.check("wafer_feature", "sample_peak", "arc")
    return Finding(
        f"within {check['value']:.2g} of a period of finite elements",
        "reference/moving_channel.py",
        OPEN,
        "the paper's t0 is where it sets it: the time says where the asperity started, which is not printed",
    )


@dataclass(frozen=True)
class Claim:
    section: str
    text: str
    decide: Callable[[Evidence], Finding]


CLAIMS = (
    Claim("4.1.1", "SPH and FLUENT agree on wafer pressure and shear (Fig. 7)", agrees_with_fluent),
    Claim("4.1.1", "moving either wall gives almost identical results (Fig. 7)", either_wall),
    Claim("4.1.1", "steady after 3e-5 s (flat wall moves) and 6e-5 s (curved wall moves)", steady_times),
    Claim("4.1.2", "two discs draft, kiss and tumble as published (Figs. 9 to 11)", drafting),
    Claim(
        "4.2",
        "the pressure maximum is linear in sigma, slope 9.28 at a gap of 7 um (Fig. 13a)",
        slope_over_width,
    ),
    Claim("4.2", "it falls as exp(-3.636 H_gap), H_gap in 1e-5 m, at sigma = 6 um (Fig. 13b)", rate_over_gap),
    Claim("4.3", "the pressure at the sample point peaks at 0.7 T (Fig. 14)", peak_time),
    Claim("4.4", "Table 1: weights of 4 to 29 abrasives", table_1),
    Claim("4.4", "the threshold, the largest shear without abrasives, is 288.5 Pa", threshold),
    Claim("4.4", "F_tau rises with the concentration (Fig. 19a)", over_bands(rises)),
    Claim("4.4", "F_tau is proportional to the cube root of wt% up to 5 % (Fig. 19b)", over_bands(cube_root)),
    Claim("4.4", "F_tau saturates near 5 % (Fig. 19a)", over_bands(saturates)),
)


def findings(evidence: Evidence, claims: Sequence[Claim]) -> list[Finding | Missing]:
    """What the evidence says of each claim, or the evidence that it has not."""
    found: list[Finding | Missing] = []
    for claim in claims:
        try:
            found.append(claim.decide(evidence))
        except Missing as missing:
            found.append(missing)
    return found


def origin(evidence: Evidence) -> str:
    """Which run each part of the ledger is from, Markdown."""
    results, asperity = evidence.results or {}, evidence.asperity or {}
    parts = [
        f"`make verify` (level {results.get('level', 'none')}): Secs. 4.1 and 4.3, the threshold",
        f"`python -m verification.asperity` (level {asperity.get('level', 'none')}): Sec. 4.2",
    ]
    if "bands" not in (evidence.abrasives or {}):
        parts.append("`make figures` (none): F_tau of Sec. 4.4")
    else:
        members = sorted({row["members"] for row in evidence.ensemble()["rows"] if row["count"]})
        parts.append(
            f"`make figures` ({' or '.join(map(str, members))} members for each number of discs, spacing "
            f"{evidence.abrasives['spacing_m']:g} m): F_tau of Sec. 4.4"
        )
    return "; ".join(parts)


def ledger(evidence: Evidence, claims: Sequence[Claim] = CLAIMS) -> str:
    """The ledger as Markdown."""
    rows = []
    for claim, found in zip(claims, findings(evidence, claims), strict=True):
        if isinstance(found, Missing):
            found = Finding("", "", "not decided", f"not run: {found}")
        verdict = f"{found.verdict}, {found.range}" if found.range else found.verdict
        rows.append(("", (claim.section, claim.text, found.ours, found.truth, verdict, found.why)))
    head = ("section", "the paper says", "we find", "independent truth", "verdict", "because")
    return (
        f"# The paper's claims\n\nWritten by `make claims` from {origin(evidence)}. Intervals are 95 %; the "
        f"band is that of the rule of active steps ([{ABRASIVES}]({ABRASIVES}/README.md)).\n\n"
        + Table(head, rows).markdown()
    )


def require_all(evidence: Evidence, claims: Sequence[Claim]) -> None:
    """Raises Missing with every command whose evidence a claim lacks."""
    missing = [str(found) for found in findings(evidence, claims) if isinstance(found, Missing)]
    if missing:
        raise Missing(f"nothing written; run first: {'; '.join(dict.fromkeys(missing))}")


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.claims", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--build", type=Path, default=BUILD, help="%(default)s")
    parser.add_argument("--to", type=Path, default=ROOT / "claims.md", help="%(default)s")
    parser.add_argument(
        "--page", type=Path, default=ROOT / ABRASIVES / "README.md", help="with F_tau's tables (%(default)s)"
    )
    options = parser.parse_args(argv)
    try:
        evidence = Evidence.read(options.build)
        require_all(evidence, CLAIMS)
        replace_between(options.page, "sensitivity", abrasive_page.page(evidence.abrasives or {}))
        part = options.to.with_suffix(".part")
        part.write_text(ledger(evidence, CLAIMS))
        part.replace(options.to)
    except (OSError, ValueError, Missing) as error:
        print(f"claims: {error}", file=sys.stderr)
        return 2
    print(options.to, options.page, sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
