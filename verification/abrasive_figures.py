"""The report's figures of the abrasives (Figs. 17 to 19); like those of figures.py, from Data to a Figure.

Figs. 17 and 18 are of the first variant, which has snapshots: at one of them a disc is in the gap, at another
none is near it. Fig. 19 is of the ensemble that the workflow made beside the runs, else of the stored one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reference import load
from verification.abrasive_report import ENSEMBLE
from verification.abrasive_statistics import MODELS, analyse
from verification.active_shear import FREE_CASE, PROBE, SETTLING, Rule, read, read_wafer
from verification.case import ROOT, load_case
from verification.compare import Array, DataError
from verification.figures import COLOURS, MARKERS, MICRO, Data
from verification.measure import Result
from verification.picture import draw

WALL_SPEED = 1.0  # m/s, between wafer and pad
DRAWN_BANDS = (0.01, 0.02, 0.05)
DRAWN_MODELS = ("cube root", "linear", "1 - exp(-lambda n)")


def distances(result: Result, times: Array) -> Array:
    """How far the disc nearest to the middle of the gap is from it at `times` (n,), m."""
    scene = result.scene
    pad = next(w for w in scene["walls"] if w["shape"] == "gaussian")
    top, length = scene["domain"]["upper"][1], scene["domain"]["upper"][0]
    middle = np.array([pad["centre"], (pad["base_height"] + pad["amplitude"] + top) / 2])
    apart = []
    for name in result.disc_names():
        stamps, position = result.disc(name, "position")
        nearest = np.array([position[np.argmin(np.abs(stamps - time))] for time in times]) - middle
        nearest[:, 0] -= length * np.round(nearest[:, 0] / length)
        apart.append(np.linalg.norm(nearest, axis=1))
    return np.min(apart, axis=0)


def moments(result: Result) -> tuple[float, float]:
    """The snapshots with a disc in the gap, and with the discs as far from it as they get."""
    times = result.snapshot_times()
    times = times[times > SETTLING]
    if len(times) < 2:
        raise DataError("the run has no two snapshots after the settling")
    apart = distances(result, times)
    return float(times[np.argmin(apart)]), float(times[np.argmax(apart)])


def passing(data: Data) -> Figure:
    """Fig. 17: speed of the fluid in the pad's frame, with a disc in the gap and with none near it."""
    result = data.result(data.case.variants[0])
    figure = Figure(figsize=(9, 8), layout="constrained")
    panels = figure.subplots(2, 1, sharex=True)
    for axes, time, what in zip(panels, moments(result), ("in the gap", "beyond the gap"), strict=True):
        dots = draw(axes, result, time, "speed", WALL_SPEED)
        axes.set(title=f"{what}, t = {MICRO * time:.1f} µs", xlabel="x in the pad's frame (µm)")
        axes.label_outer()
    figure.colorbar(dots, ax=list(panels), label="speed (m/s)", shrink=0.7)
    return figure


def passing_wafer(data: Data) -> Figure:
    """Fig. 18: wafer pressure and shear, abrasive-free by finite elements, and at the moments of Fig. 17."""
    result = data.result(data.case.variants[0])
    times, along, pressure, shear = read_wafer(result.path)
    scene = result.scene
    length = scene["domain"]["upper"][0]
    wafer = next(w for w in scene["walls"] if w["name"] == PROBE)
    figure = Figure(figsize=(8, 7), layout="constrained")
    panels = figure.subplots(2, 1, sharex=True)
    free = load(
        "channel_navier_stokes", load_case(FREE_CASE).scene_path, {}, ROOT.parent / "build" / "reference"
    )
    x = np.linspace(0, length, 400)
    truth = free.wall_pressure(PROBE, x, 0.0)
    panels[0].plot(MICRO * x, truth - truth.mean(), "k-", label="abrasive-free, finite elements")
    panels[1].plot(MICRO * x, free.wall_shear(PROBE, x, 0.0), "k-")
    for index, (time, what) in enumerate(zip(moments(result), ("in the gap", "beyond the gap"), strict=True)):
        sample = int(np.argmin(np.abs(times - time)))
        place = (along + wafer["velocity"][0] * times[sample]) % length
        style = {"color": COLOURS[index], "marker": MARKERS[index], "linestyle": "", "fillstyle": "none"}
        label = f"abrasive {what}, {data.label(data.case.variants[0].name)}"
        panels[0].plot(MICRO * place, pressure[sample] - pressure[sample].mean(), label=label, **style)
        panels[1].plot(MICRO * place, shear[sample], **style)
    panels[0].set(ylabel="wafer pressure - mean (Pa)")
    panels[0].legend(fontsize=8, loc="upper left")
    panels[1].set(ylabel="wafer shear (Pa)", xlabel="x in the pad's frame (µm)")
    return figure


def active_shear(data: Data) -> Figure:
    """Fig. 19: F_tau over the concentration, over its cube root, and with the models."""
    made = data.out / "abrasives.csv"
    runs = read(made if made.exists() else ENSEMBLE)
    figure = Figure(figsize=(11, 4.8), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    rule = Rule.of(runs[0])
    for index, band in enumerate(DRAWN_BANDS):
        found = analyse(runs, data.case.scene(), Rule(rule.threshold, band))
        rows = found["rows"][1:]
        weight, mean = (np.array([row[key] for row in rows]) for key in ("weight_percent", "mean"))
        ends = np.abs(np.array([row["interval"] or (row["mean"],) * 2 for row in rows]).T - mean)
        style = {"marker": MARKERS[index], "color": COLOURS[index], "linestyle": "", "capsize": 3}
        left.errorbar(weight / weight.max(), mean, ends, label=f"band {100 * band:g} %", **style)
        before = weight <= 5.1
        right.errorbar(np.cbrt(weight / weight.max())[before], mean[before], ends[:, before], **style)
        if band == rule.band:
            _draw_models(left, right, found, weight.max())
    left.axvline(5 / weight.max(), color="grey", linestyle="--", label="5 % by weight")
    left.set(xlabel="concentration over 7.49 % (-)", ylabel="active shear frequency (-)", ylim=(0, 1.05))
    right.set(xlabel="cube root of concentration over 7.49 % (-)", title="up to 5 % by weight")
    members = sorted({row["members"] for row in rows})
    left.set_title(f"{members[0]} to {members[-1]} members each; models of band {100 * rule.band:g} %")
    left.legend(fontsize=8, loc="lower right")
    return figure


def _draw_models(left: Axes, right: Axes, found: dict, largest: float) -> None:
    w = np.linspace(0, largest, 200)
    for name, line in zip(DRAWN_MODELS, ("-", "--", ":"), strict=True):
        fitted = next(f for f in found["models"] if f["model"] == name)
        values = np.clip(MODELS[name][0](w, np.array(fitted["parameters"])), 0, 1)
        left.plot(w / largest, values, line, color="black", linewidth=1, label=name)
        right.plot(np.cbrt(w[w <= 5.1] / largest), values[w <= 5.1], line, color="black", linewidth=1)


FIGURES: dict[str, Callable[[Data], Figure]] = {
    "passing": passing,
    "passing_wafer": passing_wafer,
    "active_shear": active_shear,
}
CAPTIONS = {
    "passing": "Speed of the fluid with an abrasive in the gap, and beyond it (Fig. 17).",
    "passing_wafer": "Pressure and shear on the wafer: abrasive-free, in the gap, beyond it (Fig. 18).",
    "active_shear": "Active shear frequency over the concentration, 95 % intervals, models (Fig. 19).",
}
