"""Fig. 13 of wang2014: the pressure maximum on the wafer over the asperity's width and over the gap.

`python -m verification.asperity` fits the sweeps of the last `make verify LEVEL=paper` as the paper does, SPH
and finite elements alike, and writes asperity.json beside results.json; `--page` writes a table of the points
into the case's README.md, too. `--lengths` does the same for finite elements in channels of other lengths,
which the paper leaves open, and writes asperity_lengths.json and the table of lengths in that README.md.

The fits are least squares, weights equal, with the 95 % interval of Student's distribution. The points have
little noise, so an interval says mostly how far they are from the assumed form; `largest_residual` says it
outright: relative to the range of the pressures for a line, to the fitted pressure for the other two.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from reference import Reference, ReferenceError
from reference import load as load_reference
from verification.case import ROOT, Case, CaseError, Variant, load_case
from verification.compare import Array, DataError
from verification.markers import replace_between
from verification.measure import Result
from verification.page import Table

CASE, WAFER, REFERENCE = "gaussian_asperity", "wafer", "channel_navier_stokes"
MICRO = 1e6
PAPER_SLOPE = 9.28  # Sec. 4.2; in Pa/um, if the paper's axes are in Pa and um
PAPER_RATE = 3.636  # Sec. 4.2; per 1e-5 m (design.md section 5)
RATE_LENGTH = 1e-5  # m
SWEEPS = ("width", "gap")
LENGTHS: dict[str, Callable[[float], float]] = {  # m, of the channel, from the asperity's width
    "8 sigma": lambda width: 8 * width,
    "40 um": lambda width: 4e-5,
    "80 um": lambda width: 8e-5,
}
MARKERS = ("<!-- lengths:begin -->", "<!-- lengths:end -->")
SAMPLES = 4000  # of the wafer, for finite elements alone


@dataclass(frozen=True)
class Point:
    """One point of the sweeps; the pressure maximum is over the wafer's mean, in Pa."""

    width: float  # m
    gap: float  # m
    pressure: float


def shape(scene: Mapping[str, Any]) -> tuple[float, float]:
    """Width of the asperity and gap above its peak, m."""
    pad = next(wall for wall in scene["walls"] if wall["shape"] == "gaussian")
    return pad["width"], scene["domain"]["upper"][1] - pad["base_height"] - pad["amplitude"]


def excess(pressure: Array) -> float:
    return float(pressure.max() - pressure.mean())


def measured(case: Case, variant: Variant, result: Result) -> Point:
    return Point(*shape(case.scene(variant)), excess(result.wall(WAFER).pressure))


def exact(case: Case, variant: Variant, reference: Reference) -> Point:
    scene = case.scene(variant)
    x = np.linspace(0, scene["domain"]["upper"][0], SAMPLES, endpoint=False)
    return Point(*shape(scene), excess(reference.wall_pressure(WAFER, x, 0.0)))


def sweep(points: Sequence[Point], of: str) -> list[Point]:
    """The points of the largest set that share the other parameter, ascending; `of` is one of SWEEPS."""
    other = {"width": "gap", "gap": "width"}[of]
    held = [round(getattr(point, other) * 1e9) for point in points]
    common = max(held, key=held.count)
    return sorted((p for p, h in zip(points, held, strict=True) if h == common), key=lambda p: getattr(p, of))


def _line(x: Array, y: Array) -> tuple[dict[str, Any], Array]:
    """Slope with its uncertainty, and the residuals."""
    if len(x) < 3:
        raise DataError(f"a fit needs three points or more, not {len(x)}")
    fit = stats.linregress(x, y)
    half = float(stats.t.ppf(0.975, len(x) - 2) * fit.stderr)
    numbers = {
        "points": len(x),
        "slope": float(fit.slope),
        "interval_95": [float(fit.slope) - half, float(fit.slope) + half],
        "intercept": float(fit.intercept),
    }
    return numbers, y - (fit.intercept + fit.slope * x)


def fit_width(points: Sequence[Point]) -> dict[str, Any]:
    """Pressure = intercept + slope sigma: Pa and Pa/um. Raises DataError for fewer than three points."""
    x = np.array([MICRO * point.width for point in points])
    y = np.array([point.pressure for point in points])
    numbers, residuals = _line(x, y)
    return numbers | {"largest_residual": float(np.abs(residuals).max() / np.ptp(y))}


def fit_gap(points: Sequence[Point]) -> dict[str, Any]:
    """Exponential exp(-rate gap), rate per 1e-5 m, its rival gap^-exponent, and the local rates between
    neighbouring points. Raises DataError for fewer than three points.
    """
    gap = np.array([point.gap / RATE_LENGTH for point in points])
    logarithm = np.log([point.pressure for point in points])
    found: dict[str, Any] = {}
    for name, x in (("exponential", gap), ("power", np.log(gap))):
        numbers, residuals = _line(x, logarithm)
        low, high = numbers["interval_95"]
        found[name] = {
            "points": len(gap),
            "rate" if name == "exponential" else "exponent": -numbers["slope"],
            "interval_95": [-high, -low],
            "factor": float(np.exp(numbers["intercept"])),
            "largest_residual": float(np.expm1(np.abs(residuals).max())),
        }
    local = -np.diff(logarithm) / np.diff(gap)
    found["local_rates"] = [
        {"gaps_m": [a.gap, b.gap], "rate": float(rate)}
        for a, b, rate in zip(points, points[1:], local, strict=False)
    ]
    return found


def fits(points: Sequence[Point]) -> dict[str, Any]:
    """Both fits and the points, for JSON; a sweep of too few points says so instead of a fit."""
    found: dict[str, Any] = {}
    for of, fit in (("width", fit_width), ("gap", fit_gap)):
        chosen = sweep(points, of)
        try:
            numbers: dict[str, Any] = fit(chosen)
        except DataError as error:
            numbers = {"reason": str(error)}
        rows = [{"width_m": p.width, "gap_m": p.gap, "pressure_Pa": p.pressure} for p in chosen]
        found[of] = numbers | {"values": rows}
    return found


def of_runs(out: Path, load: Callable[..., Reference] = load_reference) -> dict[str, Any]:
    """Fits of the runs that out/results.json lists, and of finite elements at the same points."""
    case = load_case(CASE)
    results = json.loads((out / "results.json").read_text())
    finest = {e["variant"]: e for e in results["cases"] if e["case"] == CASE and e["finest"]}
    if not finest:
        raise DataError(f"{out / 'results.json'} has no run of {CASE}: make verify LEVEL=paper")
    ours, truth = [], []
    for variant in (v for v in case.variants if v.name in finest):
        entry = finest[variant.name]
        folder = out / "runs" / CASE / entry["scheme"] / variant.name / f"{entry['spacing_m']:g}"
        scene = case.scene(variant)
        ours.append(measured(case, variant, Result(folder / "result.h5", scene["output"]["end_time"], scene)))
        cache = ROOT.parent / "build" / "reference"
        truth.append(exact(case, variant, load(REFERENCE, case.scene_path, dict(variant.set), cache)))
    spacing = max(entry["spacing_m"] for entry in finest.values())
    found = {"level": results["level"], "spacing_m": spacing}
    return _with_paper(found | {"sph": fits(ours), "finite_elements": fits(truth)})


def _with_paper(found: dict[str, Any]) -> dict[str, Any]:
    paper = {"width": {"slope": PAPER_SLOPE}, "gap": {"exponential": {"rate": PAPER_RATE}}}
    units = {"slope": "Pa/um", "rate": f"1/({RATE_LENGTH:g} m)", "intercept": "Pa", "factor": "Pa"}
    return found | {"paper": paper, "units": units}


def of_lengths(load: Callable[..., Reference] = load_reference) -> dict[str, Any]:
    """The same fits for finite elements in channels of every rule of LENGTHS."""
    case = load_case(CASE)
    found = {}
    for name, rule in LENGTHS.items():
        points = []
        for variant in case.variants:
            scene = case.scene(variant)
            length, height = rule(shape(scene)[0]), scene["domain"]["upper"][1]
            longer = {
                "domain.upper": [length, height],
                "walls.wafer.to": [length, height],
                "walls.pad.centre": length / 2,
            }
            changed = Variant(variant.name, {**variant.set, **longer})
            print(f"{name}: {variant.name}", file=sys.stderr, flush=True)
            try:
                cache = ROOT.parent / "build" / "reference"
                reference = load(REFERENCE, case.scene_path, dict(changed.set), cache)
                points.append(exact(case, changed, reference))
            except ReferenceError as error:
                print(f"{name}: {variant.name}: {error}", file=sys.stderr)
        found[name] = fits(points)
    return _with_paper(found)


def point_table(found: Mapping[str, Any]) -> str:
    """Markdown: what `of_runs` found at every point, SPH against finite elements."""
    sph, truth = (
        {
            (row["width_m"], row["gap_m"]): row["pressure_Pa"]
            for of in SWEEPS
            for row in found[source][of]["values"]
        }
        for source in ("sph", "finite_elements")
    )
    rows, errors = [], []
    for (width, gap), pressure in sorted(truth.items()):
        errors.append(sph[width, gap] / pressure - 1)
        numbers = (f"{MICRO * width:.3g}", f"{MICRO * gap:.3g}", f"{sph[width, gap]:.1f}", f"{pressure:.1f}")
        rows.append(("", (*numbers, f"{100 * errors[-1]:+.2f} %")))
    head = ("sigma (um)", "gap (um)", "SPH (Pa)", "finite elements (Pa)", "error")
    largest = max(map(abs, errors))
    said = (
        f"At a spacing of {found['spacing_m']:g} m the points are within {100 * largest:.1f} % of finite "
        "elements:"
    )
    return f"{said}\n\n{Table(head, rows).markdown().strip()}"


def length_table(found: Mapping[str, Any]) -> str:
    """Markdown: the pressure maxima of every length rule, and their fits; "refused" by the reference."""
    names = list(LENGTHS)
    lines = [f"| sigma (um) | gap (um) | {' | '.join(f'L = {name} (Pa)' for name in names)} |"]
    lines.append("|---" * (2 + len(names)) + "|")
    values = {
        (name, round(MICRO * row["width_m"]), round(MICRO * row["gap_m"])): f"{row['pressure_Pa']:.1f}"
        for name in names
        for of in SWEEPS
        for row in found[name][of]["values"]
    }
    for width, gap in sorted({key[1:] for key in values}):
        cells = [values.get((name, width, gap), "refused") for name in names]
        lines.append(f"| {width} | {gap} | {' | '.join(cells)} |")
    slopes = [found[name]["width"]["slope"] for name in names]
    rates = [found[name]["gap"]["exponential"]["rate"] for name in names]
    lines.append(f"| slope (Pa/um) | 7 | {' | '.join(f'{slope:.2f}' for slope in slopes)} |")
    lines.append(f"| 6 | rate (per 1e-5 m) | {' | '.join(f'{rate:.2f}' for rate in rates)} |")
    return "\n".join(lines) + "\n"


def write_table(readme: Path, table: str) -> None:
    text = readme.read_text()
    if any(text.count(marker) != 1 for marker in MARKERS):
        raise CaseError(f"{readme}: needs the lines {MARKERS[0]} and {MARKERS[1]}, once each")
    before, after = text.split(MARKERS[0])[0], text.split(MARKERS[1])[1]
    readme.write_text(f"{before}{MARKERS[0]}\n{table}{MARKERS[1]}{after}")


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.asperity", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--out", type=Path, default=ROOT.parent / "build" / "verify")
    parser.add_argument("--lengths", action="store_true", help="finite elements in channels of other lengths")
    parser.add_argument("--page", action="store_true", help="the points into the case's README.md, too")
    options = parser.parse_args(argv)
    try:
        found = of_lengths() if options.lengths else of_runs(options.out)
        options.out.mkdir(parents=True, exist_ok=True)
        file = options.out / ("asperity_lengths.json" if options.lengths else "asperity.json")
        part = file.with_suffix(".part")
        part.write_text(json.dumps(found, indent=1, allow_nan=False) + "\n")
        part.replace(file)
        if options.lengths:
            write_table(ROOT / CASE / "README.md", length_table(found))
        elif options.page:
            replace_between(ROOT / CASE / "README.md", "points", point_table(found))
    except (CaseError, DataError, ReferenceError, OSError, ValueError) as error:
        print(f"asperity: {error}", file=sys.stderr)
        return 2
    print(file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
