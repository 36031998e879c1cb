"""The ledger of the paper's claims: `python -m verification.claims` writes verification/claims.md.

Each claim is a function of the evidence, in verification/ledger/, a file for each section of the paper: the
checks of build/verify/results.json and the runs and references beside it, asperity.json (`python -m
verification.asperity`), build/figures with its abrasives.json (`make figures`), build/ablation (`make
ablation`) and build/bench/machine_bench.json (`make bench`). Where some of it is missing, the command says
what to run and writes nothing. It also writes the tables of F_tau's sensitivity into the README of the
abrasives.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from reference import ReferenceError
from verification import abrasive_page
from verification.active_shear import CASE as ABRASIVES
from verification.case import ROOT
from verification.compare import DataError
from verification.ledger import abrasives, discs, features, flat_wafer, method, rough_channel, shear_frequency
from verification.ledger.evidence import BUILD, Claim, Evidence, Finding, Missing
from verification.markers import replace_between
from verification.page import Table

SECTIONS = (
    method,
    rough_channel,
    discs,
    flat_wafer,
    features,
    abrasives,
    shear_frequency,
)  # in the paper's order
CLAIMS = tuple(claim for section in SECTIONS for claim in section.CLAIMS)


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
        "`make ablation` and `make bench`: Secs. 2.4 and 2.6",
        f"`python -m verification.asperity` (level {asperity.get('level', 'none')}): Sec. 4.2",
    ]
    if "bands" not in (evidence.abrasives or {}):
        parts.append("`make figures` (none): abrasives of Sec. 4.4")
    else:
        members = sorted({row["members"] for row in evidence.ensemble()["rows"] if row["count"]})
        parts.append(
            f"`make figures` ({' or '.join(map(str, members))} members for each number of discs, spacing "
            f"{evidence.abrasives['spacing_m']:g} m): abrasives of Sec. 4.4"
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
    except (DataError, OSError, ReferenceError, ValueError, Missing) as error:
        print(f"claims: {error}", file=sys.stderr)
        return 2
    print(options.to, options.page, sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
