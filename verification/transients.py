"""How soon a steady answer may be read, and what the start has to do with it: a table of accuracy.md.

`python -m verification.transients` runs the rough channel from different starts to twice its case's end,
holds every sample of the wafer against the steady finite elements, and tells from when on the errors stay
within bounds. The table goes between the markers of accuracy.md. Exit status: 0; 1 when a run failed; 2 when
it cannot start.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from reference import Reference
from verification.case import ROOT, CaseError, Variant, load_case
from verification.compare import Array, DataError
from verification.execute import Run, execute
from verification.markers import replace_between
from verification.measure import Result
from verification.page import Table
from verification.run import REPOSITORY, References

PAGE = ROOT / "accuracy.md"
CASE = "rough_channel"
WAFER = "wafer"  # wall and probe
SPACING = 5e-7  # m
SAMPLES = 601
STARTS: Mapping[str, Mapping[str, object]] = {
    "default": {},
    "without the impulse": {"start.impulse": False},
    "relaxed": {"start.arrangement": "relaxed"},
    "sound speed x 0.5": {"numerics.sound_speed": 5.0},
    "sound speed x 2": {"numerics.sound_speed": 20.0},
}
BOUNDS = {"pressure": (0.2, 0.1, 0.05), "shear": (0.05, 0.01), "kinetic energy": (0.01, 0.005)}


def settled(times: Array, errors: Array, bound: float) -> float:
    """The time, s, of the first of the samples (n,) from which on no error (n,) exceeds the bound; NaN if the
    last one does, or is not finite.
    """
    beyond = np.nonzero(~(errors <= bound))[0]
    if len(beyond) == 0:
        return float(times[0])
    return float(times[beyond[-1] + 1]) if beyond[-1] + 1 < len(times) else float("nan")


def wafer_errors(result: Result, reference: Reference, field: str) -> tuple[Array, Array]:
    """Times (n,) and relative L2 errors (n,) of a field on the wafer, means subtracted from pressures."""
    times, along, samples = result.wall_samples(WAFER, field)
    exact_at = reference.wall_pressure if field == "pressure" else reference.wall_shear
    errors = []
    for time, found in zip(times, samples, strict=True):
        exact = exact_at(WAFER, along, time)
        shift = (found.mean(), exact.mean()) if field == "pressure" else (0.0, 0.0)
        off = found - shift[0] - (exact - shift[1])
        errors.append(np.linalg.norm(off) / np.linalg.norm(exact - shift[1]))
    return times, np.array(errors)


def errors_over_time(result: Result, reference: Reference) -> dict[str, tuple[Array, Array]]:
    """Times and errors by the quantities of BOUNDS."""
    times, energy = result.series("kinetic_energy")
    exact = np.array([reference.kinetic_energy(time) for time in times])
    of_the_wafer = {field: wafer_errors(result, reference, field) for field in ("pressure", "shear")}
    return {**of_the_wafer, "kinetic energy": (times, np.abs(energy / exact - 1))}


def measure(options: argparse.Namespace) -> Table:
    """Runs every variant from every start. Raises CaseError when a run fails."""
    case, references = load_case(CASE), References()
    heads = [f"{name} within {100 * bound:g} %" for name, bounds in BOUNDS.items() for bound in bounds]
    rows = []
    for variant in case.variants:
        reference = references.of(case, variant)
        longer = {
            "output.end_time": 2 * case.scene(variant)["output"]["end_time"],
            "output.snapshot_times": [],
            "output.probe_samples": SAMPLES,
        }
        for name, changes in STARTS.items():
            started = Variant(f"{variant.name}, {name}", {**variant.set, **changes, **longer})
            chosen = argparse.Namespace(**vars(options), solver_set=[], reuse=False, timeout=3600.0)
            outcome = execute(Run(case, "default", started, SPACING, finest=False), chosen)
            if outcome.failure:
                raise CaseError(f"{outcome.run.label}: {outcome.failure}")
            found = errors_over_time(outcome.result, reference)
            times = [settled(*found[quantity], bound) for quantity in BOUNDS for bound in BOUNDS[quantity]]
            cells = ["never" if np.isnan(time) else f"{1e6 * time:.1f}" for time in times]
            rows.append(("", [variant.name.replace("_", " "), name, *cells]))
    return Table(("flow", "start", *heads), rows)


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.transients", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--solver", type=Path, default=REPOSITORY / "build" / "slurry")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "transients")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--page", type=Path, default=PAGE, help="with the markers of the table")
    options = parser.parse_args(argv)
    try:
        text = measure(options).markdown().strip()
        print(text)
        replace_between(options.page, "transients", text)
    except CaseError as error:
        print(f"FAILED: {error}")
        return 1
    except (DataError, OSError, ValueError) as error:
        print(f"transients: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
