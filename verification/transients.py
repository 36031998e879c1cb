"""How soon a steady answer may be read, and what the start has to do with it: a table of accuracy.md.

`python -m verification.transients` runs the rough channel from different starts to twice its case's end,
holds every sample of the wafer against the steady finite elements, and tells from when on the errors stay
within bounds. The table goes between the markers of accuracy.md. Exit status: 0; 1 when the default failed;
2 when it cannot start.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence

import numpy as np

from reference import Reference
from verification.case import ROOT, CaseError, Variant, load_case
from verification.compare import Array, settled
from verification.execute import Run
from verification.measure import Result
from verification.page import Table
from verification.page_command import finished, write_tables
from verification.run import References

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
    "sound speed x 2, without the impulse": {"numerics.sound_speed": 20.0, "start.impulse": False},
}
BOUNDS = {"pressure": (0.2, 0.1, 0.05), "shear": (0.05, 0.01), "kinetic energy": (0.01, 0.005)}


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


def measure(options: argparse.Namespace) -> dict[str, Table]:
    """Runs every variant from every start; who stops is told. Raises CaseError if the default does."""
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
            run = Run(case, "default", started, SPACING, finest=False)
            try:
                found = errors_over_time(finished(run, options), reference)
            except CaseError:
                if name == "default":
                    raise
                rows.append(("", [variant.name.replace("_", " "), name, *["stops"] * len(heads)]))
                continue
            times = [settled(*found[quantity], bound) for quantity in BOUNDS for bound in BOUNDS[quantity]]
            cells = ["never" if np.isnan(time) else f"{1e6 * time:.1f}" for time in times]
            rows.append(("", [variant.name.replace("_", " "), name, *cells]))
    return {"transients": Table(("flow", "start", *heads), rows)}


def main(argv: Sequence[str] | None = None) -> int:
    return write_tables("transients", __doc__.splitlines()[0], PAGE, measure, argv)


if __name__ == "__main__":
    sys.exit(main())
