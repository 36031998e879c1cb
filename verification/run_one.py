"""One run of a case: `python -m verification.run_one CASE VARIANT --spacing M [--seed N]`.

A member of an ensemble is a variant under another seed; `[ensemble] seed` of the case's checks.toml names the
key of the scene that takes it. The run lands in OUT/runs/CASE/SCHEME/VARIANT_seed_N/SPACING/result.h5, or
without `_seed_N` when no seed is asked for; run.json beside it has what the solver says of the run. A result
of the same solver, scene and settings is kept.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from verification.case import SCHEMES, Case, CaseError, Variant, load_case
from verification.execute import Run, execute
from verification.run import REPOSITORY

SEEDS_APART = 1000  # between variants: members of different variants are independent


def member(case: Case, variant: str, seed: int | None) -> Variant:
    """The variant, under that seed if there is one; raises CaseError for what the case does not have."""
    found = next((v for v in case.variants if v.name == variant), None)
    if found is None:
        raise CaseError(
            f"{case.name} has no variant {variant}, only {', '.join(v.name for v in case.variants)}"
        )
    if seed is None:
        return found
    ensemble = case.data.get("ensemble", {})
    if "seed" not in ensemble or variant not in ensemble.get("variants", []):
        raise CaseError(f"{case.name} has no [ensemble] with a `seed` and {variant} among its `variants`")
    # Discs are placed one after another: under one seed a small group's are among those of a larger one.
    own = SEEDS_APART * (1 + ensemble["variants"].index(variant)) + seed
    return Variant(f"{variant}_seed_{seed}", {**found.set, ensemble["seed"]: own})


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.run_one", description=__doc__.splitlines()[0]
    )
    parser.add_argument("case")
    parser.add_argument("variant")
    parser.add_argument("--spacing", type=float, required=True, metavar="M")
    parser.add_argument("--seed", type=int)
    parser.add_argument("--scheme", choices=SCHEMES, default="default")
    parser.add_argument("--set", dest="solver_set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--solver", type=Path, default=REPOSITORY / "build" / "slurry")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "figures")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--timeout", type=float, default=36000, metavar="S", help="%(default)s s")
    options = parser.parse_args(argv)
    options.reuse = True
    try:
        case = load_case(options.case)
        variant = member(case, options.variant, options.seed)
    except CaseError as error:
        print(f"run_one: {error}", file=sys.stderr)
        return 2
    outcome = execute(Run(case, options.scheme, variant, options.spacing, finest=True), options)
    if outcome.failure:
        print(f"run_one: {outcome.run.label}: {outcome.failure}", file=sys.stderr)
        return 3
    # Written last: it says that result.h5 beside it is whole.
    (outcome.run.folder(options.out) / "run.json").write_text(json.dumps(outcome.attributes, indent=1) + "\n")
    print(f"{outcome.run.label}: {outcome.attributes['wall_seconds']:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
