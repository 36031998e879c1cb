"""Figures of wafers with a feature; like those of figures.py, from a case's Data to a matplotlib Figure."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.figure import Figure

from verification.case import Variant
from verification.compare import Check, DataError
from verification.figures import COLOURS, MICRO, Data
from verification.truth import at_probe, peak, samples, trusted

SAMPLE, FIELD = "sample_pressure", "pressure"  # the checks of wafer_feature that are drawn


def _checks(data: Data, variant: Variant, quantity: str) -> list[Check]:
    level = "gate"  # where and when are the same at every level
    checks = data.case.checks("default", level, variant.name)
    return [check for check in checks if check.quantity.split(" at ")[0] == quantity]


def feature_sample(data: Data) -> Figure:
    """Fig. 14: pressure at the sample point over the last period, less its mean, and when it is largest."""
    figure = Figure(figsize=(5 * len(data.case.variants), 4.2), layout="constrained")
    panels = figure.subplots(1, len(data.case.variants), squeeze=False)[0]
    for axes, variant in zip(panels, data.case.variants, strict=True):
        check, result = _checks(data, variant, SAMPLE)[0], data.result(variant)
        start, end = check.window or (0.0, result.end_time)
        fine = np.linspace(start, end, 401)
        truth = at_probe(trusted(data.reference(variant), check), result, check.at, check.field, fine)
        times, values = samples(result, check.at, check.field)
        inside = times >= start - 1e-3 * (end - start)
        spacing = data.entry(variant.name)["spacing_m"]
        curves = (
            (fine, truth, "-", "black", "finite elements"),
            (times[inside], values[inside], "o", COLOURS[0], f"SPH, spacing {MICRO * spacing:.3g} µm"),
        )
        for moments, pressure, style, colour, label in curves:
            phase = (moments - start) / (end - start)
            top = phase[0] + peak(pressure) * (phase[-1] - phase[0])
            label = f"{label}: largest at {top:.2f} T"
            axes.plot(phase, pressure - pressure.mean(), style, color=colour, fillstyle="none", label=label)
            axes.axvline(top, color=colour, linestyle=":", linewidth=1)
        axes.set(title=variant.name, xlabel="time in the last period, (t - t0) / T (-)")
        axes.legend(fontsize=8)
    panels[0].set_ylabel("pressure at the sample point - mean (Pa)")
    return figure


def feature_fields(data: Data) -> Figure:
    """Fig. 15: the pressure fields of the particles, and of the finite elements at the particles."""
    variants = data.case.variants
    columns = len(_checks(data, variants[0], FIELD))
    figure = Figure(figsize=(2.9 * columns + 1, 3.6 * len(variants)), layout="constrained")
    panels = figure.subplots(2 * len(variants), columns, squeeze=False, sharex=True, sharey=True)
    for number, variant in enumerate(variants):
        checks, result = _checks(data, variant, FIELD), data.result(variant)
        moments = [result.particles(check.time) for check in checks]
        reference = trusted(data.reference(variant), checks[0])
        truths = [reference.pressure(*moment.position.T, moment.time) for moment in moments]
        truths = [truth - truth.mean() for truth in truths]
        limit = float(np.quantile(np.abs(np.concatenate(truths)), 0.995))
        rows = panels[2 * number : 2 * number + 2]
        for row, name in zip(rows, ("SPH", "finite elements"), strict=True):
            for axes, check, moment, truth in zip(row, checks, moments, truths, strict=True):
                values = truth if name != "SPH" else moment.pressure - moment.pressure.mean()
                style = {"cmap": "RdBu_r", "vmin": -limit, "vmax": limit, "linewidths": 0}
                x, y = MICRO * moment.position.T
                dots = axes.scatter(x, y, c=values, s=260 / len(x) ** 0.5, **style)
                axes.set(aspect="equal", title=f"{variant.name}, {name}, t0 + {_share(check, checks):.1f} T")
                axes.title.set_fontsize(9)
                axes.grid(visible=False)
            row[0].set_ylabel("y (µm)")
        figure.colorbar(dots, ax=rows.ravel().tolist(), label="p - mean (Pa)", shrink=0.7)
    for axes in panels[-1]:
        axes.set_xlabel("x (µm)")
    return figure


def _share(check: Check, checks: list[Check]) -> float:
    """Since the first instant, in periods: the instants are even parts of one."""
    if check.time is None or checks[0].time is None or len(checks) < 2 or checks[1].time is None:
        raise DataError(f"{check.quantity} has no times")
    return (check.time - checks[0].time) / (checks[1].time - checks[0].time) / len(checks)


FIGURES: dict[str, Callable[[Data], Figure]] = {
    "feature_sample": feature_sample,
    "feature_fields": feature_fields,
}
CAPTIONS = {
    "feature_sample": "Pressure at the sample point over a period (Fig. 14). The paper's peak is at 0.7 T; "
    "it does not say where its asperity is at t0 (ours: at the periodic side).",
    "feature_fields": "Pressure at the paper's instants, the last period from t0 on (Fig. 15).",
}
