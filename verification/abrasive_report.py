"""F_tau of the abrasives by one command: `python -m verification.abrasive_report --csv FILE`.

Prints the tables and writes abrasives.json: F_tau with intervals, how it depends on the rule, on the run's
length and on the particle spacing, and which model of it the data prefer. The statistics are those of
verification/abrasive_statistics.py.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from verification.abrasive_statistics import BANDS, LEAST_DURATIONS, analyse, interval, ranked, weight_percent
from verification.active_shear import CASE, Peaks, Rule, read, spacing_of
from verification.case import ROOT, load_case
from verification.compare import DataError, settled
from verification.page import Table

ENSEMBLE = ROOT / CASE / "ensemble.csv"
DECISIVE = ("rise", "exponent_before", "slope_before_per_percent", "slope_after_per_percent", "models_before")


def mean_by_count(runs: Sequence[Peaks], rule: Rule) -> dict[int, float]:
    counts = sorted({run.count for run in runs})
    return {c: float(np.mean([rule.frequency(run) for run in runs if run.count == c])) for c in counts}


def sensitivity(
    runs: Sequence[Peaks], rule: Rule, scene: dict[str, Any], looks: float
) -> list[dict[str, Any]]:
    """F_tau by other rules, and the model preferred then; at a band of 0 noise decides."""
    rules = [dataclasses.replace(rule, band=band) for band in BANDS]
    rules += [dataclasses.replace(rule, least_duration=least) for least in LEAST_DURATIONS]
    rows = []
    members = [run for run in runs if run.count > 0]
    weight = np.array([weight_percent(run.count, scene) for run in members])
    for other in rules:
        fits = ranked(weight, np.array([other.frequency(run) for run in members]), looks)
        rows.append({"band": other.band, "least_duration_s": other.least_duration,
                     "means": mean_by_count(runs, other),
                     "best": fits[0]["model"] if fits else "none: all alike",
                     "aic_behind_best": {f["model"]: f["aic"] - fits[0]["aic"] for f in fits}})  # fmt: skip
    return rows


def within_noise(free: Peaks, rule: Rule, band: float) -> bool:
    """Whether the abrasive-free run alone would decide what is active by that band."""
    try:
        Rule.of(free, band, least_duration=rule.least_duration, settling=rule.settling)
    except DataError:
        return True
    return False


def by_band(runs: Sequence[Peaks], rule: Rule, scene: dict[str, Any]) -> list[dict[str, Any]]:
    """What decides the claims on F_tau by every one of BANDS, or the reason why a band decides nothing."""
    rows = []
    for band in BANDS:
        other = dataclasses.replace(rule, band=band)
        row: dict[str, Any] = {"band": band, "within_noise": within_noise(runs[0], rule, band)}
        row["means"] = mean_by_count([run for run in runs if run.count > 0], other)
        try:
            found = analyse(runs, scene, other)
            row["result"] = {key: found[key] for key in DECISIVE}
        except DataError as error:
            row["reason"] = str(error)
        rows.append(row)
    return rows


def halves(runs: Sequence[Peaks], rule: Rule) -> dict[str, Any]:
    """F_tau of the second half of the time less that of the first, run by run: zero if settled."""
    members = [run for run in runs if run.count > 0]
    pairs = [np.array_split(rule.active(run).astype(float), 2) for run in members]
    means = np.array([[half.mean() for half in pair] for pair in pairs])
    difference = means[:, 1] - means[:, 0]
    counts = np.array([run.count for run in members])
    return {
        "later_less_earlier": float(difference.mean()),
        "interval": interval(difference),
        "rows": {int(c): means[counts == c].mean(axis=0).tolist() for c in np.unique(counts)},
    }


def places(runs: Sequence[Peaks], rule: Rule, scene: dict[str, Any]) -> dict[str, float]:
    """Shares of the active peaks by their distance from the top of the asperity."""
    pad = next(wall for wall in scene["walls"] if wall["shape"] == "gaussian")
    length = scene["domain"]["upper"][0]
    active = [run.from_time(rule.settling).place[rule.active(run)] for run in runs if run.count > 0]
    apart = np.concatenate(active) - pad["centre"]
    apart = np.abs(apart - length * np.round(apart / length)) / pad["width"]
    ends = {"within sigma / 2": (0, 0.5), "from there to 2 sigma": (0.5, 2), "beyond": (2, np.inf)}
    return {name: float(np.mean((apart >= low) & (apart < high))) for name, (low, high) in ends.items()}


def paired(coarse: Sequence[Peaks], fine: Sequence[Peaks]) -> dict[str, Any]:
    """F_tau at `fine` less that at `coarse`, for members in common, each by its own threshold."""
    rules = Rule.of(coarse[0]), Rule.of(fine[0])
    mine = {(run.count, run.seed): rules[0].frequency(run) for run in coarse if run.count > 0}
    other = {(run.count, run.seed): rules[1].frequency(run) for run in fine if run.count > 0}
    common = sorted(mine.keys() & other.keys())
    if not common:
        raise DataError("the two spacings have no member in common")
    difference = np.array([other[key] - mine[key] for key in common])
    return {"members": [list(key) for key in common], "thresholds": [rule.threshold for rule in rules],
            "coarse": [mine[key] for key in common], "fine": [other[key] for key in common],
            "mean_difference": float(difference.mean()),
            "largest_difference": float(np.abs(difference).max()),
            "interval": interval(difference)}  # fmt: skip


def _with_interval(found: Sequence[float]) -> str:
    return "{:.4f} ({:.4f} to {:.4f})".format(*found) if len(found) > 1 else f"{found[0]:.4f} (no interval)"


def tables(found: dict[str, Any]) -> str:
    result = found["result"]
    rows = [("", (f"{r['count']}", f"{r['weight_percent']:.2f}", f"{r['members']}", f"{r['mean']:.3f}",
             "{:.3f} to {:.3f}".format(*r["interval"]) if r.get("interval") else "none"))
            for r in result["rows"]]  # fmt: skip
    parts = [Table(("discs", "% by weight", "members", "F_tau", "95 % interval"), rows).markdown()]
    counts = [r["count"] for r in result["rows"]]
    rows = [("", (f"{r['band']:g}", f"{r['least_duration_s']:g}", *(f"{r['means'][c]:.2f}" for c in counts),
             r["best"])) for r in found["sensitivity"]]  # fmt: skip
    head = ("band", "least duration (s)", *(f"F_tau({c})" for c in counts), "best by AIC")
    parts.append(Table(head, rows).markdown())
    for key, title in (("models", "all"), ("models_before", "up to 5 %")):
        rows = [("", (f["model"], ", ".join(f"{p:.3g}" for p in f["parameters"]),
                 *(f"{f[k]:.2f}" for k in ("log_likelihood", "aic", "bic")), f"{f['akaike_weight']:.3f}"))
                for f in result[key]]  # fmt: skip
        head = (f"model, {title}", "parameters", "ln L", "AIC", "BIC", "Akaike weight")
        parts.append(Table(head, rows).markdown())
    lines = [
        "threshold {:.2f} Pa, memory {:.3g} s".format(result["rule"]["threshold"], result["memory_s"]),
        "abrasive-free run within the band from {:.3g} s on".format(found["settled_from_s"]),
        "rise: Kendall's tau {kendall_tau:.3f}, one-sided p {p:.2g}".format(**result["rise"]),
        "exponent up to 5 %: {:.3f} ({:.3f} to {:.3f})".format(*result["exponent_before"]),
        f"slope up to 5 %: {_with_interval(result['slope_before_per_percent'])} per %",
        f"slope from 5 % on: {_with_interval(result['slope_after_per_percent'])} per %",
        "second half less first half: {:.3f} ({:.3f} to {:.3f})".format(
            found["halves"]["later_less_earlier"], *found["halves"]["interval"]
        ),
    ]
    shares = ", ".join(f"{share:.3f} {name}" for name, share in found["places"].items())
    lines.append(f"active peaks by distance from the top of the asperity: {shares}")
    for name, pair in found["spacings"].items():
        lines.append(f"against {name}: thresholds {pair['thresholds']} Pa, {len(pair['members'])} members in "
                     f"common, F_tau higher by {pair['mean_difference']:.3f}, interval {pair['interval']}, "
                     f"largest difference {pair['largest_difference']:.3f}")  # fmt: skip
    return "\n".join([*parts, *lines])


def report(csv: Path, others: Sequence[Path]) -> dict[str, Any]:
    """All results of the ensemble in `csv`; `others` have members of it at other spacings."""
    runs, case = read(csv), load_case(CASE)
    scene = case.scene()
    rule = Rule.of(runs[0])
    result = analyse(runs, scene, rule)
    looks = (runs[0].times[-1] - rule.settling) / result["memory_s"]
    return {
        "result": result,
        "settled_from_s": settled(runs[0].times, np.abs(runs[0].peak / rule.threshold - 1), rule.band),
        "spacing_m": spacing_of(csv),
        "sensitivity": sensitivity(runs, rule, scene, looks),
        "bands": by_band(runs, rule, scene),
        "halves": halves(runs, rule),
        "places": places(runs, rule, scene),
        "spacings": {
            path.stem: paired(read(path), runs) | {"spacings_m": [spacing_of(path), spacing_of(csv)]}
            for path in others
        },
    }


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.abrasive_report", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--csv", type=Path, default=ENSEMBLE, help="%(default)s")
    parser.add_argument("--other", type=Path, action="append", default=[], help="the same at another spacing")
    parser.add_argument("--json", type=Path, default=ROOT.parent / "build" / "figures" / "abrasives.json")
    options = parser.parse_args(argv)
    try:
        found = report(options.csv, options.other)
        options.json.parent.mkdir(parents=True, exist_ok=True)
        options.json.write_text(json.dumps(found, indent=1) + "\n")
    except (DataError, OSError) as error:
        print(f"abrasive_report: {error}", file=sys.stderr)
        return 2
    print(tables(found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
