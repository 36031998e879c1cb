"""Pictures of a run: what RUN/result.h5 holds, as PNG files in RUN/plots.

`python -m verification.plot RUN`, or `make plot RUN=FOLDER`: fields at the last snapshot; pressure and shear
along every wall with a probe, at the last time and over time; the ways of the discs; point probes; energies
and other totals. What the run does not hold is skipped, with the reason.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import matplotlib

from verification.compare import DataError
from verification.figures import STYLE
from verification.measure import Result, open_run, unended_since
from verification.run_figures import FIGURES

STEMS = {"walls": "wall_*"}  # of a kind's files where there may be many; else its own name


def save(result: Result, out: Path) -> tuple[list[Path], list[str]]:
    """Writes every figure that the run has data for; returns the files, and why others were skipped. Figures
    of an earlier run that this one does not have go: they would pass for its own.
    """
    written, skipped = [], []
    for kind, draw in FIGURES.items():
        try:
            with matplotlib.rc_context(STYLE):
                for name, figure in draw(result).items():
                    out.mkdir(parents=True, exist_ok=True)
                    path, part = out / f"{name}.png", out / f"part.{name}.png"
                    figure.savefig(part)
                    written.append(part.replace(path))
        except (DataError, ValueError) as error:  # ValueError: columns that do not fit each other
            skipped.append(f"{kind}: skipped: {error}")
    for kind in FIGURES:
        for old in set(out.glob(f"{STEMS.get(kind, kind)}.png")).difference(written):
            old.unlink()
    return written, skipped


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m verification.plot", description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="the folder of a run, with its result.h5")
    parser.add_argument("--out", type=Path, help="folder of the pictures (default: RUN/plots)")
    options = parser.parse_args(argv)
    folder = options.run if options.run.is_dir() else options.run.parent
    try:
        result = open_run(options.run)
        for reason in unended_since(result.path):
            print(f"plot: warning: {reason}", file=sys.stderr)
        written, skipped = save(result, options.out or folder / "plots")
    except (DataError, OSError, RuntimeError) as error:
        print(f"plot: {error}", file=sys.stderr)
        return 2
    print(*skipped, *written, sep="\n")
    if not written:
        print(f"plot: {options.run} holds nothing that can be drawn", file=sys.stderr)
    return 0 if written else 2


if __name__ == "__main__":
    sys.exit(main())
