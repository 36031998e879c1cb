"""When abrasives shear the wafer: F_tau = t_active / t_total (Eq. 4.6) of an ensemble of random placements.

The rule. At every sample of the wafer probe, peak(t) is the largest |shear| along the wafer. The threshold is
the mean of peak(t) in the abrasive-free run, at the same spacing and by the same probe, so that what spacing
and probe are off by drops out. A sample is active when peak(t) > threshold (1 + BAND), and counts when the
active stretch that it is in lasts for LEAST_DURATION or longer. BAND lies above all that particle noise does
in the abrasive-free run (`Rule.of` refuses it otherwise); within LEAST_DURATION a disc moves on by 1.5
diameters at most. Samples before SETTLING are left out: the abrasive-free run is steady from then on.

`python -m verification.active_shear --spacing M` collects the peaks of all runs of `abrasives` below
build/figures into one CSV, a line for each run, which is all that verification/abrasive_statistics.py needs.
"""

from __future__ import annotations

import argparse
import csv
import io
import math
import re
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from verification.case import LEVELS, ROOT, Case, load_case
from verification.compare import Array, DataError, require_series
from verification.execute import Run
from verification.run_one import member

CASE, FREE_CASE, FREE_VARIANT, PROBE = "abrasives", "abrasive_free", "wafer_moves", "wafer"
BAND = 0.01  # of the threshold
LEAST_DURATION = 1.5e-6  # s
SETTLING = 4e-5  # s, one wall period
NOISE_DEVIATIONS = 5  # of the abrasive-free peak, that fit into the band at least


@dataclass(frozen=True)
class Peaks:
    """The largest |shear| along the wafer of one run; count 0 and seed 0 without abrasives."""

    count: int
    seed: int
    times: Array  # (n,) s, evenly spaced
    peak: Array  # (n,) Pa
    place: Array  # (n,) m, where on the wafer that is, in the pad's frame

    def from_time(self, start: float) -> Peaks:
        kept = self.times > start * (1 + 1e-6)
        if np.count_nonzero(kept) < 2:
            raise DataError(f"{self.count} discs, seed {self.seed}: nothing is left after {start:g} s")
        return Peaks(self.count, self.seed, self.times[kept], self.peak[kept], self.place[kept])


@dataclass(frozen=True)
class Rule:
    """What makes a sample active; see the module."""

    threshold: float  # Pa
    band: float = BAND
    least_duration: float = LEAST_DURATION  # s
    settling: float = SETTLING  # s

    @classmethod
    def of(cls, free: Peaks, band: float = BAND, **others: float) -> Rule:
        """The rule by an abrasive-free run; raises DataError if its noise does not fit into the band."""
        steady = free.from_time(others.get("settling", SETTLING)).peak
        threshold = float(steady.mean())
        noise = NOISE_DEVIATIONS * float(steady.std()) / threshold
        if not max(noise, float(steady.max()) / threshold - 1) < band:
            raise DataError(f"a band of {band:g} is within the noise of the abrasive-free run, {noise:.3g}")
        return cls(threshold, band, **others)

    def active(self, run: Peaks) -> Array:
        """Which samples after the settling are active (n,), bool."""
        settled = run.from_time(self.settling)
        above = settled.peak > self.threshold * (1 + self.band)
        spacing = float(settled.times[1] - settled.times[0])
        least = math.ceil(self.least_duration / spacing * (1 - 1e-6))
        edges = np.flatnonzero(np.diff(np.concatenate([[False], above, [False]]).astype(int)))
        for start, end in zip(edges[::2], edges[1::2], strict=True):
            cut_off = start == 0 or end == len(above)  # it may have begun before, or go on
            if end - start < least and not cut_off:
                above[start:end] = False
        return above

    def frequency(self, run: Peaks) -> float:
        """F_tau of one run."""
        return float(np.mean(self.active(run)))


def read_wafer(path: Path) -> tuple[Array, Array, Array, Array]:
    """Times (t,) in s, x (n,) in m where the wafer stood at time 0, pressure and shear (t, n) in Pa.

    Raises DataError for a run without the probe, or one value that is not a number.
    """
    try:
        with h5py.File(path, "r") as file:
            group = file[f"probes/{PROBE}"]
            times, x, pressure, shear = (group[key][()] for key in ("time", "x", "pressure", "shear"))
    except (OSError, KeyError) as error:
        raise DataError(f"{path}: no probe {PROBE}: {error}") from error
    pressure, shear = (require_series(f"probe {PROBE} of {path}", v, times) for v in (pressure, shear))
    return times, x, pressure, shear


def read_run(path: Path, count: int, seed: int, scene: dict[str, Any]) -> Peaks:
    """The peaks of one result.h5 of a scene in which the pad rests; raises DataError as read_wafer does."""
    times, x, _, shear = read_wafer(path)
    largest = np.abs(shear).argmax(axis=1)
    wafer = next(wall for wall in scene["walls"] if wall["name"] == PROBE)
    place = (x[largest] + wafer["velocity"][0] * times) % scene["domain"]["upper"][0]
    return Peaks(count, seed, times, np.abs(shear).max(axis=1), place)


def count_of(case: Case, variant: str) -> int:
    """How many discs a variant has."""
    return int(case.scene(member(case, variant, None))["discs"][0]["count"])


def collect(out: Path, spacing: float, level: str) -> list[Peaks]:
    """The abrasive-free run and the level's members of the ensemble at that spacing (m) that are below
    out/runs; raises DataError without the abrasive-free run.
    """
    free = load_case(FREE_CASE)
    runs = [read_run(result_path(free, FREE_VARIANT, None, spacing, out), 0, 0, free.scene())]
    case = load_case(CASE)
    for variant in case.data["ensemble"]["variants"]:
        for seed in case.data["ensemble"]["seeds"][level]:  # out may hold another level's, of another solver
            path = result_path(case, variant, seed, spacing, out)
            if path.exists():
                runs.append(read_run(path, count_of(case, variant), seed, case.scene()))
    return runs


def result_path(case: Case, variant: str, seed: int | None, spacing: float, out: Path) -> Path:
    """Where a run of the workflow is, of a variant or of its member with that seed."""
    run = Run(case, "default", member(case, variant, seed), spacing, finest=True)
    return run.folder(out) / "result.h5"


def write(path: Path, runs: Iterable[Peaks], spacing: float, command: str) -> None:
    """Comments, the times, then two lines for each run, peak and place; whole or not at all."""
    text = io.StringIO()
    runs = list(runs)
    text.write("# Largest |wafer shear| (peak, Pa), and where it is in the pad's frame (place, um),\n")
    text.write("# at the times (s) of the first row. Our own results, nobody's data:\n")
    text.write(f"# {command}\n# particle spacing {spacing:g} m\n")
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["count", "seed", "quantity", *(f"{time:.6g}" for time in runs[0].times)])
    # A run records at the step nearest to a sample's time, and steps are as long as its discs allow.
    rounding = 0.05 * float(np.min(np.diff(runs[0].times), initial=np.inf))
    for run in runs:
        if run.times.shape != runs[0].times.shape or np.abs(run.times - runs[0].times).max() > rounding:
            raise DataError(f"{run.count} discs, seed {run.seed}: sampled at other times than the first run")
        table.writerow([run.count, run.seed, "peak", *(f"{value:.2f}" for value in run.peak)])
        table.writerow([run.count, run.seed, "place", *(f"{1e6 * value:.1f}" for value in run.place)])
    partial = path.with_suffix(".partial")
    partial.write_text(text.getvalue())
    partial.replace(path)


def read(path: Path) -> list[Peaks]:
    """What `write` wrote; raises DataError for anything else."""
    try:
        rows = list(csv.reader(line for line in path.read_text().splitlines() if not line.startswith("#")))
        times = require_series(f"the times of {path.name}", [float(text) for text in rows[0][3:]])
        runs = [_run_of(path.name, times, *pair) for pair in zip(rows[1::2], rows[2::2], strict=True)]
    except (OSError, ValueError, IndexError) as error:
        raise DataError(f"{path}: {error}") from error
    if not runs or runs[0].count != 0:
        raise DataError(f"{path}: the first run must be the abrasive-free one")
    return runs


def spacing_of(path: Path) -> float:
    """The particle spacing of what `write` wrote, m; raises DataError where the file does not say."""
    found = re.search(r"^# particle spacing (\S+) m$", path.read_text(), re.MULTILINE)
    if found is None:
        raise DataError(f"{path}: no line says the particle spacing")
    return float(found[1])


def _run_of(name: str, times: Array, peak: list[str], place: list[str]) -> Peaks:
    if peak[:2] != place[:2] or (peak[2], place[2]) != ("peak", "place"):
        raise DataError(f"{name}: {peak[:3]} and {place[:3]} are not peak and place of one run")
    values, places = (require_series(name, [float(v) for v in row[3:]], times) for row in (peak, place))
    return Peaks(int(peak[0]), int(peak[1]), times, values, 1e-6 * places)


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.active_shear", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--spacing", type=float, required=True, metavar="M")
    parser.add_argument("--level", choices=LEVELS, default="gate", help="whose members")
    parser.add_argument("--out", type=Path, default=ROOT.parent / "build" / "figures", help="where runs/ is")
    parser.add_argument("--csv", type=Path, required=True)
    options = parser.parse_args(argv)
    try:
        runs = collect(options.out, options.spacing, options.level)
        command = (
            f"python -m verification.active_shear --level {options.level} --spacing {options.spacing:g}"
            f" --csv {options.csv.name}"
        )
        write(options.csv, runs, options.spacing, command)
    except (DataError, OSError) as error:
        print(f"active_shear: {error}", file=sys.stderr)
        return 2
    print(f"{options.csv}: {len(runs)} runs")
    return 0


if __name__ == "__main__":
    sys.exit(main())
