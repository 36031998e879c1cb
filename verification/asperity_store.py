"""Finite elements at every point of the sweeps of Fig. 13, kept in finite_elements.csv of the case.

Making one of them takes longer than the gate's runs, so that the gate makes those of its own points only; the
figures draw all. `python -m verification.asperity_store` makes the file, from build/reference where it can.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from reference import Reference, ReferenceError
from reference import load as load_reference
from verification.asperity import CASE, REFERENCE, Point, exact
from verification.bench.files import write_whole
from verification.case import ROOT, CaseError, load_case
from verification.compare import DataError

STORED = ROOT / CASE / "finite_elements.csv"
HEAD = ["width_m", "gap_m", "pressure_Pa"]
COMMENT = (
    f"# Largest wafer pressure over its mean by steady finite elements (reference/{REFERENCE}.py), at every\n"
    "# point of the sweeps; made by: python -m verification.asperity_store\n"
)
AGREEMENT = 1e-3  # relative: what the reference's own error may be


def all_points(load: Callable[..., Reference] = load_reference) -> list[Point]:
    """Finite elements at every variant of the case; raises ReferenceError for one that cannot be made."""
    case, cache = load_case(CASE), ROOT.parent / "build" / "reference"
    made = []
    for variant in case.variants:
        print(f"finite elements: {variant.name}", file=sys.stderr, flush=True)
        made.append(exact(case, variant, load(REFERENCE, case.scene_path, dict(variant.set), cache)))
    return made


def write(path: Path, points: Sequence[Point]) -> None:
    """Whole or not at all."""
    rows = [",".join(HEAD), *(f"{p.width:.6g},{p.gap:.6g},{p.pressure:.6g}" for p in points)]
    write_whole(path, COMMENT + "\n".join(rows) + "\n")


def read(path: Path = STORED) -> list[Point]:
    """What `write` wrote; raises DataError for anything else."""
    try:
        lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
        head, *rows = csv.reader(lines)
        if head != HEAD or not rows:
            raise DataError(f"{path}: needs the columns {', '.join(HEAD)}, and rows")
        return [Point(*map(float, row)) for row in rows]
    except (OSError, ValueError, TypeError) as error:
        raise DataError(f"{path}: {error}") from error


def confirm(stored: Sequence[Point], made: Sequence[Point]) -> None:
    """Raises DataError where a reference made now is not what is stored at its point."""
    pressures = {key(point): point.pressure for point in stored}
    for point in made:
        kept = pressures.get(key(point))
        if kept is None or abs(kept / point.pressure - 1) > AGREEMENT:
            raise DataError(
                f"{STORED.name} has {kept} Pa where finite elements give {point.pressure:.6g}: make it again "
                "by python -m verification.asperity_store"
            )


def key(point: Point) -> tuple[int, int]:
    """Width and gap in nm."""
    return round(point.width * 1e9), round(point.gap * 1e9)


def main(argv: Sequence[str] | None = None, load: Callable[..., Reference] = load_reference) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.asperity_store", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--to", type=Path, default=STORED, help="%(default)s")
    options = parser.parse_args(argv)
    try:
        write(options.to, all_points(load))
    except (CaseError, ReferenceError, OSError) as error:
        print(f"asperity_store: {error}", file=sys.stderr)
        return 2
    print(options.to)
    return 0


if __name__ == "__main__":
    sys.exit(main())
