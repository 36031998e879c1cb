"""The report's figures of the asperity sweeps (Fig. 13) and of rough pads; see figures.py."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from verification import asperity_store
from verification.asperity import (
    MICRO,
    PAPER_RATE,
    PAPER_SLOPE,
    RATE_LENGTH,
    WAFER,
    Point,
    exact,
    fit_gap,
    fit_width,
    measured,
    sweep,
)
from verification.compare import DataError
from verification.figures import COLOURS, Data

PRESSURE = "wafer pressure, maximum - mean (Pa)"


def _points(data: Data, of: str) -> tuple[list[Point], list[Point]]:
    """SPH at the points of a sweep that were run, and finite elements at all of them."""
    run = {entry["variant"] for entry in data.entries}
    variants = [variant for variant in data.case.variants if variant.name in run]
    if not variants:
        raise DataError("no variant was run")
    ours = [measured(data.case, variant, data.result(variant)) for variant in variants]
    stored = asperity_store.read()
    asperity_store.confirm(stored, [exact(data.case, v, data.reference(v)) for v in variants])
    truth = sweep(stored, of)
    places = {asperity_store.key(point) for point in truth}
    return [point for point in ours if asperity_store.key(point) in places], truth


def _draw(axes: Axes, data: Data, of: str) -> tuple[list[Point], np.ndarray, np.ndarray]:
    """Both sets of points; returns the finite elements' with x in um and y in Pa."""
    ours, truth = _points(data, of)
    spacing = max(entry["spacing_m"] for entry in data.entries if entry["finest"])
    for points, marker, label in (
        (truth, "k+", "finite elements"),
        (ours, "o", f"SPH, spacing {spacing:.3g} m"),
    ):
        x = [MICRO * getattr(point, of) for point in points]
        colour = {} if marker == "k+" else {"color": COLOURS[0], "fillstyle": "none"}
        axes.plot(x, [point.pressure for point in points], marker, markersize=8, label=label, **colour)
    places = np.array([MICRO * getattr(point, of) for point in truth])
    return truth, places, np.array([point.pressure for point in truth])


def width(data: Data) -> Figure:
    """Fig. 13a: over the width, with the straight line through the finite elements and the paper's."""
    figure = Figure(figsize=(7, 5), layout="constrained")
    axes = figure.subplots()
    truth, x, y = _draw(axes, data, "width")
    line = np.linspace(x.min(), x.max(), 100)
    if len(truth) > 2:
        fit = fit_width(truth)
        slope = fit["slope"]
        axes.plot(
            line,
            fit["intercept"] + slope * line,
            "k-",
            label=f"line through finite elements, slope {slope:.2f} Pa/µm",
        )
        paper = y.mean() + PAPER_SLOPE * (line - x.mean())
        axes.plot(line, paper, "--", color=COLOURS[3], label=f"the paper's slope, {PAPER_SLOPE} Pa/µm")
    axes.set(xlabel="width of the asperity σ (µm)", ylabel=PRESSURE)
    axes.set_ylim(bottom=0)
    axes.legend()
    return figure


def gap(data: Data) -> Figure:
    """Fig. 13b: over the gap, with an exponential and a power through the finite elements; the paper's."""
    figure = Figure(figsize=(7, 5), layout="constrained")
    axes = figure.subplots()
    truth, x, y = _draw(axes, data, "gap")
    line = np.linspace(x.min(), x.max(), 100)
    if len(truth) > 2:
        fit, unit = fit_gap(truth), MICRO * RATE_LENGTH
        power, exponential = fit["power"], fit["exponential"]
        label = f"power through finite elements, gap^-{power['exponent']:.2f}"
        axes.plot(line, power["factor"] * (line / unit) ** -power["exponent"], "k-", label=label)
        label = f"exponential through finite elements, rate {exponential['rate']:.2f} / 10 µm"
        axes.plot(line, exponential["factor"] * np.exp(-exponential["rate"] * line / unit), "k:", label=label)
        paper = np.exp(np.log(y).mean() - PAPER_RATE * (line - x.mean()) / unit)
        axes.plot(line, paper, "--", color=COLOURS[3], label=f"the paper's rate, {PAPER_RATE} / 10 µm")
    axes.set_yscale("log")
    axes.set(xlabel="gap above the peak (µm)", ylabel=PRESSURE)
    axes.grid(True, which="both", alpha=0.25)
    axes.legend()
    return figure


def rough(data: Data) -> Figure:
    """The film over the pad, and the wafer's pressure and shear above it against the finite elements."""
    variant = data.case.variants[0]
    result, reference = data.result(variant), data.reference(variant)
    sample, particles = result.wall(WAFER), result.particles()
    figure = Figure(figsize=(9, 8), layout="constrained")
    film, pressure, shear = figure.subplots(3, 1, sharex=True)
    values, limit = particles.pressure - particles.pressure.mean(), np.ptp(particles.pressure) / 2
    style = {"c": values, "cmap": "RdBu_r", "vmin": -limit, "vmax": limit, "linewidths": 0}
    dots = film.scatter(*(MICRO * particles.position.T), s=300 / len(values) ** 0.5, **style)
    figure.colorbar(dots, ax=film, label="p - mean (Pa)")
    film.set(ylabel="y (µm)", aspect="equal")
    truth = reference.wall_pressure(WAFER, sample.x, sample.time)
    lines = (
        (pressure, sample.pressure - sample.pressure.mean(), truth - truth.mean()),
        (shear, sample.shear, reference.wall_shear(WAFER, sample.x, sample.time)),
    )
    for axes, mine, exact_values in lines:
        axes.plot(MICRO * sample.x, exact_values, "k-", label="finite elements")
        axes.plot(
            MICRO * sample.x,
            mine,
            "o",
            color=COLOURS[0],
            fillstyle="none",
            label=data.label(variant.name),
        )
        axes.legend(fontsize=9)
    pressure.set(ylabel="wafer pressure - mean (Pa)")
    shear.set(ylabel="wafer shear (Pa)", xlabel="position along the wafer (µm)")
    return figure


FIGURES: dict[str, Callable[[Data], Figure]] = {
    "pressure_over_width": width,
    "pressure_over_gap": gap,
    "rough_pad": rough,
}
CAPTIONS = {
    "pressure_over_width": "Pressure maximum over the asperity's width (Fig. 13a).",
    "pressure_over_gap": "Pressure maximum over the gap (Fig. 13b).",
    "rough_pad": "Pressure in the film, and pressure and shear on the wafer above a rough pad.",
}
