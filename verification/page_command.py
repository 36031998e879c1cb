"""A command that runs flows and writes generated tables into a page of the repository."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from verification.case import CaseError
from verification.compare import DataError
from verification.execute import Run, execute
from verification.markers import replace_between
from verification.measure import Result
from verification.page import Table
from verification.run import REPOSITORY


def finished(run: Run, options: argparse.Namespace) -> Result:
    """What a run leaves, started anew with the command's options. Raises CaseError when it fails."""
    chosen = argparse.Namespace(**vars(options), solver_set=[], reuse=False, timeout=3600.0)
    outcome = execute(run, chosen)
    if outcome.failure:
        raise CaseError(f"{run.label}: {outcome.failure}")
    return outcome.result


def write_tables(
    name: str,
    what: str,
    page: Path,
    measure: Callable[[argparse.Namespace], Mapping[str, Table]],
    argv: Sequence[str] | None,
) -> int:
    """`python -m verification.NAME`: prints the tables that `measure` makes, by their markers in the page,
    and writes them there. Exit status: 0; 1 when a run failed; 2 when it cannot start.
    """
    parser = argparse.ArgumentParser(prog=f"python -m verification.{name}", description=what)
    parser.add_argument("--solver", type=Path, default=REPOSITORY / "build" / "slurry")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / name)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--page", type=Path, default=page, help="with the markers of the tables")
    options = parser.parse_args(argv)
    try:
        for marker, table in measure(options).items():
            text = table.markdown().strip()
            print(text, end="\n\n")
            replace_between(options.page, marker, text)
    except CaseError as error:
        print(f"FAILED: {error}")
        return 1
    except (DataError, OSError, ValueError) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2
    return 0
