"""The report's figures. Each takes a case's Data and returns a matplotlib Figure, or raises DataError."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reference import Reference
from verification.case import Case, Variant
from verification.compare import DataError, observed_order
from verification.measure import Result

STYLE = {"font.size": 11, "axes.grid": True, "grid.alpha": 0.3, "figure.dpi": 130, "lines.markersize": 4}
COLOURS = ("tab:blue", "tab:orange", "tab:green", "tab:red", "tab:purple")
MARKERS = ("o", "s", "^", "D", "v")
MICRO = 1e6
MOST_TICKS = 4  # that do not overlap
TRUTHS = ("exact", "finite-element", "published")


@dataclass(frozen=True)
class Data:
    """What a figure of one case is drawn from."""

    case: Case
    entries: Sequence[dict[str, Any]]  # the case's part of results.json
    out: Path
    reference: Callable[..., Reference]  # of a variant: the case's, or the one named

    def entry(self, variant: str, scheme: str = "default") -> dict[str, Any]:
        """The run at the finest spacing; of the other scheme when this one was not run."""
        entries = [e for e in self.entries if e["variant"] == variant and e["finest"]]
        entries.sort(key=lambda e: e["scheme"] != scheme)
        if not entries:
            raise DataError(f"{variant} was not run")
        return entries[0]

    def result(self, variant: Variant, scheme: str = "default") -> Result:
        return self._result(variant, self.entry(variant.name, scheme))

    def results(self, variant: Variant) -> list[tuple[float, Result]]:
        """Every spacing in m that the variant was run at, and its run."""
        entries = [e for e in self.entries if e["variant"] == variant.name]
        return [(e["spacing_m"], self._result(variant, e)) for e in entries]

    def _result(self, variant: Variant, e: dict[str, Any]) -> Result:
        folder = self.out / "runs" / self.case.name / e["scheme"] / variant.name / f"{e['spacing_m']:g}"
        scene = self.case.scene(variant)
        return Result(folder / "result.h5", scene["output"]["end_time"], scene)

    def label(self, variant: str) -> str:
        e = self.entry(variant)
        return f"SPH {e['scheme']}, {variant.replace('_', ' ')}, spacing {e['spacing_m']:.3g} m"


def wafer(data: Data) -> Figure:
    """Fig. 7: pressure and shear on the wafer, both variants against the finite-element line."""
    figure = Figure(figsize=(8, 7), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    for index, variant in enumerate(data.case.variants):
        reference, sample = data.reference(variant), data.result(variant).wall("wafer")
        if index == 0:
            x = np.linspace(sample.x.min(), sample.x.max(), 400)
            pressure = reference.wall_pressure("wafer", x, sample.time)
            axes[0].plot(MICRO * x, pressure - pressure.mean(), "k-", label="finite elements")
            axes[1].plot(
                MICRO * x, reference.wall_shear("wafer", x, sample.time), "k-", label="finite elements"
            )
        style = {"marker": MARKERS[index], "linestyle": "", "color": COLOURS[index], "fillstyle": "none"}
        axes[0].plot(
            MICRO * sample.x,
            sample.pressure - sample.pressure.mean(),
            label=data.label(variant.name),
            **style,
        )
        axes[1].plot(MICRO * sample.x, sample.shear, label=data.label(variant.name), **style)
    axes[0].set(ylabel="wafer pressure - mean (Pa)")
    axes[1].set(ylabel="wafer shear (Pa)", xlabel="position along the wafer (µm)")
    axes[0].legend(fontsize=9)
    return figure


def field(data: Data) -> Figure:
    """Fig. 8: the pressure field of the particles and of the finite elements, and their difference."""
    figure = Figure(figsize=(13, 3.1 * len(data.case.variants)), layout="constrained")
    axes = figure.subplots(len(data.case.variants), 3, squeeze=False, sharex=True, sharey=True)
    for row, variant in zip(axes, data.case.variants, strict=True):
        particles = data.result(variant).particles()
        x, y = particles.position.T
        truth = data.reference(variant).pressure(x, y, particles.time)
        ours, truth = particles.pressure - particles.pressure.mean(), truth - truth.mean()
        limit, largest = np.abs(truth).max(), np.quantile(np.abs(ours - truth), 0.995)
        panels = (
            ("SPH particles", ours, limit),
            ("finite elements", truth, limit),
            ("difference", ours - truth, largest),
        )
        size = 300 / len(x) ** 0.5
        for axis, (title, values, bound) in zip(row, panels, strict=True):
            style = {"c": values, "s": size, "cmap": "RdBu_r", "vmin": -bound, "vmax": bound, "linewidths": 0}
            dots = axis.scatter(MICRO * x, MICRO * y, **style)
            axis.set(title=f"{title}, {variant.name.replace('_', ' ')}", aspect="equal", xlabel="x (µm)")
            axis.title.set_fontsize(10)
            figure.colorbar(dots, ax=axis, label="p - mean (Pa)", shrink=0.8)
        row[0].set_ylabel("y (µm)")
    return figure


def profiles(data: Data) -> Figure:
    """Velocity profiles over time: every fluid particle against the series."""
    variant = data.case.variants[0]
    scene, result, reference = data.case.scene(variant), data.result(variant), data.reference(variant)
    low, high = scene["domain"]["lower"][1], scene["domain"]["upper"][1]
    figure = Figure(figsize=(7, 5.5), layout="constrained")
    axis = figure.subplots()
    y = np.linspace(low, high, 300)
    for index, time in enumerate([*scene["output"].get("snapshot_times", []), scene["output"]["end_time"]]):
        particles = result.particles(time)
        exact = reference.velocity(np.full_like(y, scene["domain"]["lower"][0]), y, particles.time)[:, 0]
        colour = COLOURS[index % len(COLOURS)]
        axis.plot(exact, MICRO * y, "-", color=colour, label=f"series, {MICRO * particles.time:.3g} µs")
        style = {
            "marker": MARKERS[index % len(MARKERS)],
            "linestyle": "",
            "color": colour,
            "fillstyle": "none",
        }
        label = data.label(variant.name) if index == 0 else None
        axis.plot(particles.velocity[:, 0], MICRO * particles.position[:, 1], label=label, **style)
    axis.set(xlabel="velocity along x (m/s)", ylabel="y (µm)")
    axis.legend(fontsize=9)
    return figure


def decay(data: Data) -> Figure:
    """Kinetic energy over time against the exact decay, both schemes."""
    figure = Figure(figsize=(7, 5), layout="constrained")
    axis = figure.subplots()
    variant = data.case.variants[0]
    schemes = sorted({e["scheme"] for e in data.entries})
    for index, scheme in enumerate(schemes):
        times, energy = data.result(variant, scheme).series("kinetic_energy")
        if index == 0:
            exact = [data.reference(variant).kinetic_energy(time) for time in times]
            axis.semilogy(times, exact, "k-", label="exact")
        label = f"SPH {scheme}, spacing {data.entry(variant.name, scheme)['spacing_m']:g} m"
        axis.semilogy(
            times[::5], energy[::5], MARKERS[index], color=COLOURS[index], fillstyle="none", label=label
        )
    axis.set(xlabel="time (s)", ylabel="kinetic energy (J/m)")
    axis.legend()
    return figure


def convergence(data: Data) -> Figure:
    """Error against spacing with the fitted order, a panel for each quantity."""
    return _panels(data, "spacing_m", "particle spacing (m)", fitted=True)


def cost(data: Data) -> Figure:
    """Error against wall time, a panel for each quantity."""
    return _panels(data, "wall_s", "wall time (s)", fitted=False)


def _panels(data: Data, key: str, label: str, fitted: bool) -> Figure:
    # A check at a single spacing shows no convergence.
    spacings = {e["spacing_m"] for e in data.entries}
    truths = [c for e in data.entries for c in e["checks"] if c["kind"] in TRUTHS and len(spacings) > 1]
    quantities = list(dict.fromkeys(c["quantity"] for c in truths if c["value"]))
    if not quantities:
        raise DataError("no check has a value")
    columns = min(3, len(quantities))
    rows = -(-len(quantities) // columns)
    figure = Figure(figsize=(4.6 * columns, 3.9 * rows), layout="constrained")
    axes = list(figure.subplots(rows, columns, squeeze=False).flat)
    for axis, quantity in zip(axes, quantities, strict=False):
        _curves(axis, data, quantity, key, fitted)
        unit = next(c["unit"] for c in truths if c["quantity"] == quantity)
        error = f"error ({unit})" if unit else "relative error (-)"
        axis.set(title=quantity.replace("_", " "), xlabel=label, ylabel=error)
    for axis in axes[len(quantities) :]:
        axis.set_axis_off()
    return figure


def _curves(axis: Axes, data: Data, quantity: str, key: str, fitted: bool) -> None:
    names = dict.fromkeys((e["scheme"], e["variant"]) for e in data.entries)
    for index, (scheme, variant) in enumerate(names):
        points = [
            (e[key], c["value"])
            for e in data.entries
            for c in e["checks"]
            if (e["scheme"], e["variant"], c["quantity"]) == (scheme, variant, quantity)
            and c["value"]
            and e[key] > 0
        ]
        if not points:
            continue
        x, y = np.array(points).T
        order = observed_order(x, y) if fitted else None
        name = f"{scheme} {variant.replace('_', ' ')}" if len(data.case.variants) > 1 else scheme
        colour = COLOURS[index % len(COLOURS)]
        axis.loglog(x, y, MARKERS[index % 5] + ("" if order else "-"), color=colour, fillstyle="none",
                    label=name + (f": order {order:.2f}" if order else ""))  # fmt: skip
        if order:
            middle = np.exp(np.mean(np.log(y)) - order * np.mean(np.log(x)))
            axis.loglog(x, middle * x**order, "-", color=colour, linewidth=1)
    tolerance = [
        c["tolerance"]
        for e in data.entries
        for c in e["checks"]
        if c["quantity"] == quantity and c["tolerance"]
    ]
    if tolerance:
        axis.axhline(min(tolerance), color="grey", linestyle=":", label=f"tolerance {min(tolerance):g}")
    if fitted:
        spacings = sorted({e[key] for e in data.entries})
        if len(spacings) <= MOST_TICKS:
            axis.set_xticks(spacings, [f"{spacing:.3g}" for spacing in spacings], fontsize=9)
            axis.set_xticks([], minor=True)
    axis.grid(True, which="both", alpha=0.25)
    if axis.get_legend_handles_labels()[0]:
        axis.legend(fontsize=8)


CAPTIONS = {
    "wafer": "Pressure and shear on the wafer against the finite-element line (Fig. 7).",
    "field": "Pressure at the particles, one colour scale: SPH, finite elements, their difference (Fig. 8).",
    "profiles": "Velocity profiles over time: every fluid particle against the series.",
    "decay": "Decay of the kinetic energy.",
    "convergence": "Error against spacing with the fitted order; dotted: the tolerance at the finest.",
    "cost": "Error against wall time.",
}
FIGURES: dict[str, Callable[[Data], Figure]] = {
    "wafer": wafer,
    "field": field,
    "profiles": profiles,
    "decay": decay,
    "convergence": convergence,
    "cost": cost,
}
