"""Which runs the workflow (verification/Snakefile) makes of a case, and how long they will take.

Every variant of a case runs at the case's spacings for the level. Where its checks.toml has an [ensemble],
the ensemble's variants run at the ensemble's spacings, too, once for each of the level's seeds. Nothing else
of a case is known here: a case joins by its name in verification/workflow.yaml.

`python -m verification.workflow CASE... --level LEVEL --cores N` says how long what there is to do will take.
"""

from __future__ import annotations

import argparse
import json
import re
import statistics
import sys
from collections.abc import Sequence
from pathlib import Path

import yaml

from verification.case import LEVELS, ROOT, Case, CaseError, load_case, select
from verification.execute import Run
from verification.run_one import member

CASES = ROOT / "workflow.yaml"
SECONDS_PER_WORK = (
    6e-8  # of a core, for a unit of Run.expected_work, until this machine has made runs of its own
)
_MEMBER = re.compile(r"(?P<variant>.+?)(_seed_(?P<seed>\d+))?")


def split(name: str) -> tuple[str, int | None]:
    """`count_04_seed_3` as its variant and its seed."""
    found = _MEMBER.fullmatch(name)
    if found is None:
        raise CaseError(f"{name!r} is no name of a variant")
    return found["variant"], None if found["seed"] is None else int(found["seed"])


def runs_of(case: Case, level: str) -> list[Run]:
    """The runs of a case at a level; raises CaseError for an ensemble that says nothing of the level."""
    plain = [(s, v, d) for s in case.schemes for v in case.variants for d in case.spacings(s, level, v.name)]
    finest = {(s, v.name): d for s, v, d in plain}  # the last is the finest
    runs = [Run(case, s, v, d, d == finest[s, v.name]) for s, v, d in plain]
    ensemble = case.data.get("ensemble")
    if ensemble is None:
        return runs
    spacings, seeds = (select(ensemble.get(key), (level,)) for key in ("spacings", "seeds"))
    if not spacings or not seeds:
        raise CaseError(f"checks.toml of {case.name}: [ensemble] needs spacings and seeds for {level}")
    return runs + [
        Run(case, case.schemes[0], member(case, name, seed), float(spacing), spacing == min(spacings))
        for spacing in spacings
        for name in ensemble["variants"]
        for seed in seeds
    ]


def done_file(run: Run, out: Path) -> Path:
    """What says that a run is complete: Snakemake's output, written after result.h5."""
    return run.folder(out) / "run.json"


def expected_seconds(runs: Sequence[Run], out: Path) -> float:
    """Of one core, from the rate of the runs already there; a run that is there takes none."""
    rates, missing = [], 0.0
    for run in runs:
        try:
            made = json.loads(done_file(run, out).read_text())
            rates.append(made["wall_seconds"] * made["threads"] / run.expected_work())
        except (OSError, ValueError, KeyError):
            missing += run.expected_work()
    return missing * (statistics.median(rates) if rates else SECONDS_PER_WORK)


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.workflow", description=__doc__.splitlines()[0]
    )
    parser.add_argument("cases", nargs="*", metavar="CASE", help="default: those of workflow.yaml")
    parser.add_argument("--level", choices=LEVELS, default="gate")
    parser.add_argument("--cores", type=int, default=1)
    parser.add_argument("--out", type=Path, default=ROOT.parent / "build" / "figures")
    options = parser.parse_args(argv)
    try:
        cases = options.cases or yaml.safe_load(CASES.read_text())["cases"]
        runs = [run for name in cases for run in runs_of(load_case(name), options.level)]
    except CaseError as error:
        print(f"workflow: {error}", file=sys.stderr)
        return 2
    there = sum(done_file(run, options.out).exists() for run in runs)
    minutes = expected_seconds(runs, options.out) / options.cores / 60
    print(
        f"{len(runs)} runs at level {options.level}, {there} of them there; the others are expected to take "
        f"about {minutes:.0f} min on {options.cores} cores"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
