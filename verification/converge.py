"""How often the bands of `slurry converge` hold the truth, on flows whose truth is known.

`python -m verification.converge` runs the studies of verification/converge.toml, each a case of ours with the
probes that the file adds, and writes convergence_bands.json into the output folder. A band covers when the
value at the finest spacing differs from the reference, averaged over the same time, by at most the band. A
quantity that the study refused ("not converging") has no band and is counted apart. Exit status: 0 when at
least the file's share of the bands covers and at most its share is refused, otherwise 1; 2 when it cannot
start.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tomllib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from reference import Reference, ReferenceError
from reference.scene import override
from verification.case import CaseError, Variant, load_case, toml_value
from verification.compare import Array, DataError
from verification.markers import replace_between
from verification.results import commit
from verification.run import REPOSITORY, References

PLAN = Path(__file__).with_suffix(".toml")
RESULTS = "convergence_bands.json"
TIMES = 25  # at which the reference is taken for a mean over time

Scene = Mapping[str, Any]
# The value of one quantity at one time.
Truth = Callable[[float], float]


def _of_wall(reference: Reference, wall: str, points: Array, name: str) -> Truth:
    field, statistic = name.split("_")
    of_field = reference.wall_pressure if field == "pressure" else reference.wall_shear

    def at(time: float) -> float:
        values = of_field(wall, points, time)
        if statistic == "mean":
            return float(values.mean())
        extreme = values.max() if statistic == "max" else values.min()
        return float(extreme - (values.mean() if field == "pressure" else 0.0))

    return at


def _of_point(reference: Reference, position: Sequence[float], name: str) -> Truth:
    x, y = (np.array([coordinate], dtype=float) for coordinate in position)
    if name == "pressure":
        return lambda time: float(reference.pressure(x, y, time)[0])
    component = "xy".index(name.rpartition("_")[2])
    return lambda time: float(reference.velocity(x, y, time)[0, component])


def truth_of(reference: Reference, scene: Scene, folder: Path, place: str, name: str) -> Truth | None:
    """What a quantity of the study in a folder ought to be; None when the reference does not know it."""
    if place == "flow":
        return reference.kinetic_energy if name == "kinetic_energy" else None
    probe = next(p for p in scene["probes"] if p["name"] == place)
    if probe["kind"] == "point":
        return _of_point(reference, probe["position"], name)
    with h5py.File(next(folder.glob("*/result.h5"))) as run:  # the points are the same in all of them
        points = run[f"probes/{place}/x"][()]
    return _of_wall(reference, probe["wall"], points, name)


def judge(quantity: Mapping[str, Any], truth: Truth, end_time: float) -> dict[str, Any]:
    """One row: the true error of the value at the finest spacing beside its band."""
    if quantity["taken"] == "mean":
        exact = float(np.mean([truth(t) for t in np.linspace(quantity["from_s"], end_time, TIMES)]))
    else:
        exact = truth(end_time)
    error, band = abs(quantity["value"] - exact), quantity["band"]
    if not math.isfinite(error):
        raise DataError(f"{quantity['place']} {quantity['quantity']}: the reference gives {exact}")
    return {
        "place": quantity["place"], "quantity": quantity["quantity"], "verdict": quantity["verdict"],
        "taken": quantity["taken"], "order": quantity["order"], "truth": exact, "value": quantity["value"],
        "error": error, "band": band, "band_of_spacing": quantity["band_of_spacing"],
        "scale": quantity["scale"], "covered": band is not None and error <= band,
    }  # fmt: skip


def study_scene(study: Mapping[str, Any], probes: Mapping[str, Any]) -> str:
    """The text of the case's scene with the probes of the plan added."""
    case = load_case(study["case"])
    tables = "".join(
        "\n[[probes]]\n" + "".join(f"{key} = {toml_value(value)}\n" for key, value in probe.items())
        for probe in probes.get(study["case"], ())
    )
    return case.scene_path.read_text() + tables


def call(study: Mapping[str, Any], variant: Variant, folder: Path, options: argparse.Namespace) -> None:
    """Lets the solver make convergence.json in the folder; raises DataError with what it says if it fails."""
    command = [str(options.solver), "converge", str(folder / "scene.toml"), "--quiet", "--out", str(folder)]
    command += ["--spacing", repr(study["spacing"]), "--spacings", str(study.get("spacings", 3))]
    command += ["--threads", str(options.threads), *(["--reuse"] if options.reuse else [])]
    for address, value in variant.set.items():
        command += ["--set", f"{address}={toml_value(value)}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise DataError(f"{folder.name}: exit status {done.returncode}: {done.stderr.strip()}")


def run_study(
    study: Mapping[str, Any], probes: Mapping[str, Any], options: argparse.Namespace, references: References
) -> list[dict[str, Any]]:
    case = load_case(study["case"])
    variant = next(v for v in case.variants if v.name == study["variant"])
    label = f"{case.name} {variant.name} {study['spacing']:g}"
    folder = options.out / label.replace(" ", "_")
    folder.mkdir(parents=True, exist_ok=True)
    text = study_scene(study, probes)
    (folder / "scene.toml").write_text(text)
    scene = tomllib.loads(text)
    for address, value in variant.set.items():
        override(scene, address, value, folder / "scene.toml")
    call(study, variant, folder, options)
    reference = references.of(case, variant)
    rows = []
    for quantity in json.loads((folder / "convergence.json").read_text())["quantities"]:
        truth = truth_of(reference, scene, folder, quantity["place"], quantity["quantity"])
        if truth is not None:
            row = judge(quantity, truth, scene["output"]["end_time"])
            rows.append({"study": label, "spacings": study.get("spacings", 3), **row})
    return rows


def summary(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Shares of covered bands and of refusals; shares of nothing are NaN and pass no test."""
    banded = [row for row in rows if row["band"] is not None]
    ratios = [row["band"] / row["error"] for row in banded if row["error"] > 0]
    covered = sum(row["covered"] for row in banded)
    return {
        "quantities": len(rows),
        "bands": len(banded),
        "covered": covered,
        "coverage": covered / len(banded) if banded else math.nan,
        "refused": (len(rows) - len(banded)) / len(rows) if rows else math.nan,
        "band_over_error": statistics.median(ratios) if ratios else None,
    }


def print_rows(rows: Sequence[Mapping[str, Any]]) -> None:
    for study in dict.fromkeys(row["study"] for row in rows):
        mine = [row for row in rows if row["study"] == study]
        found = summary(mine)
        print(
            f"{study}: {found['covered']} of {found['bands']} bands cover, "
            f"{found['quantities'] - found['bands']} refused"
        )
        for row in mine:
            if row["band"] is not None and not row["covered"]:
                error, band = (100 * row[key] / row["scale"] for key in ("error", "band"))
                what = f"{row['place']} {row['quantity']}, {row['verdict']}"
                print(f"  {what}: {error:.3g} % off, band {band:.3g} %")


def table(rows: Sequence[Mapping[str, Any]]) -> str:
    """A line for each study and one for all, as Markdown."""
    studies = dict.fromkeys(row["study"] for row in rows)
    groups = [(study, [row for row in rows if row["study"] == study]) for study in studies]
    lines = [
        "| study (case, variant, finest spacing in m) | bands | covering | refused | band / error, median |",
        "|---|---|---|---|---|",
    ]
    for name, mine in [*groups, ("all", rows)]:
        found = summary(mine)
        refused = found["quantities"] - found["bands"]
        ratio = f"{found['band_over_error'] or math.nan:.1f}"
        lines.append(f"| {name} | {found['bands']} | {found['covered']} | {refused} | {ratio} |")
    return "\n".join(lines)


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m verification.converge", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--solver", type=Path, default=REPOSITORY / "build" / "slurry")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "converge")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--case", action="append", help="only this case (repeatable)")
    parser.add_argument("--page", type=Path, help="write the table between this page's markers, too")
    parser.add_argument("--reuse", action="store_true", help="keep runs of the same scenes")
    return parser.parse_args(argv)


def main(argv: Sequence[str] | None = None) -> int:
    options = parse(argv)
    plan = tomllib.loads(PLAN.read_text())
    references, rows = References(), []
    try:
        if not os.access(options.solver, os.X_OK):
            raise CaseError(f"{options.solver} is not there or not executable: run `make build` first")
        for study in plan["studies"]:
            if not options.case or study["case"] in options.case:
                rows += run_study(study, plan["probes"], options, references)
    except (CaseError, DataError, ReferenceError, OSError) as error:
        print(f"converge: {error}", file=sys.stderr)
        return 2
    print_rows(rows)
    found = summary(rows)
    stored = {"commit": commit(), "summary": found, "rows": rows}
    (options.out / RESULTS).write_text(json.dumps(stored, indent=1) + "\n")
    if options.page:
        replace_between(options.page, "bands", table(rows))
    print(
        f"{found['covered']} of {found['bands']} bands cover the true error: {100 * found['coverage']:.1f} %"
    )
    print(f"median of band over error: {found['band_over_error'] or math.nan:.1f}")
    print(f"{100 * found['refused']:.1f} % of {found['quantities']} quantities refused")
    good = found["coverage"] >= plan["least_coverage"] and found["refused"] <= plan["most_refused"]
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
