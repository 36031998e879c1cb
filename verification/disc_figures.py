"""The report's figures of discs; like those of figures.py, from a case's Data to a matplotlib Figure."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from verification import curves
from verification.case import curves as read_curves
from verification.compare import DataError
from verification.derived import DERIVED
from verification.figures import COLOURS, MARKERS, MICRO, Data
from verification.phases import PHASES, phases
from verification.picture import draw, limit_of
from verification.truth import of_disc

MOST_LINES = 2  # more variants are drawn as a band


def momentum(data: Data) -> Figure:
    """What fluid and discs give each other, and that the sum stays."""
    result = data.result(data.case.variants[0])
    times, total = DERIVED["momentum"](result)
    fluid = [result.series(f"momentum_{axis}")[1] for axis in "xy"]
    figure = Figure(figsize=(9, 4), layout="constrained")
    for index, (axes, name) in enumerate(zip(figure.subplots(1, 2), "xy", strict=True)):
        for label, values in (("fluid", fluid[index]), ("discs", total[:, index] - fluid[index])):
            axes.plot(times, values, label=label)
        axes.plot(times, total[:, index], "k-", label="both")
        axes.set(xlabel="time (s)", ylabel=f"momentum along {name} (kg/s)")
        axes.legend()
    return figure


def drag(data: Data) -> Figure:
    """F / (mu U) over the area fraction, and the relative difference from the published values."""
    rows = []
    for variant in data.case.variants:
        scene = data.case.scene(variant)
        size = np.subtract(scene["domain"]["upper"], scene["domain"]["lower"])
        check = next(c for c in data.case.checks("default", "gate", variant.name) if c.field == "array_drag")
        measured = DERIVED["array_drag"](data.result(variant))[1][-1]
        fraction = math.pi * scene["discs"][0].get("radius", math.nan) ** 2 / size.prod()
        rows.append((fraction, check.value[0], measured))
    fraction, published, measured = np.array(rows).T
    figure = Figure(figsize=(9, 4), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.semilogy(fraction, published, "k+-", markersize=10, label="sangani1982")
    left.semilogy(fraction, measured, "o", color=COLOURS[0], fillstyle="none", label="SPH")
    left.set(xlabel="area fraction (-)", ylabel="drag F / (mu U) (-)")
    left.legend()
    right.plot(fraction, 100 * (measured / published - 1), "o-", color=COLOURS[0])
    right.axhline(0, color="black", linewidth=1)
    right.set(xlabel="area fraction (-)", ylabel="SPH over sangani1982, less 1 (%)")
    return figure


def torque(data: Data) -> Figure:
    """Torque on the disc over time, every spacing, against the finite elements."""
    figure = Figure(figsize=(5 * len(data.case.variants), 4), layout="constrained")
    panels = figure.subplots(1, len(data.case.variants), squeeze=False, sharey=True)[0]
    for axes, variant in zip(panels, data.case.variants, strict=True):
        for spacing, result in data.results(variant):
            axes.plot(*result.disc("disc", "torque"), linewidth=1, label=f"SPH, spacing {spacing:.3g} m")
        exact = float(data.reference(variant).disc("disc", "torque", np.zeros(1))[0])
        axes.axhline(exact, color="black", label="finite elements")
        axes.set(title=variant.name, xlabel="time (s)", ylabel="torque on the disc (N)")
        axes.set_ylim(*sorted((0.8 * exact, 1.3 * exact)))
        axes.legend(fontsize=8)
    return figure


def film_forces(data: Data) -> Figure:
    """Mean force and torque on a disc over the thickness of its film to the wall, against finite elements."""
    figure = Figure(figsize=(9, 4), layout="constrained")
    labels = {"force_x": "force along the wall (N/m)", "torque": "torque (N)"}
    for axes, (field, label) in zip(figure.subplots(1, 2), labels.items(), strict=True):
        rows = []
        for variant in data.case.variants:
            scene = data.case.scene(variant)
            disc, top = scene["discs"][0], scene["domain"]["upper"][1]
            film = (top - disc["position"][1] - disc["radius"]) / scene["numerics"]["particle_spacing"]
            values = data.result(variant).disc("disc", field)[1]
            truth = of_disc(data.reference(variant), "disc", field, np.zeros(1))[0]
            rows.append((film, truth, values[len(values) // 2 :].mean()))
        films, truths, measured = np.array(sorted(rows)).T
        axes.plot(films, truths, "k+-", markersize=10, label="finite elements")
        axes.plot(films, measured, "o", color=COLOURS[0], fillstyle="none", label="SPH")
        axes.set(xlabel="thickness of the film (particle spacings)", ylabel=label)
        axes.legend()
    return figure


def panels(name: str) -> Callable[[Data], Figure]:
    """The figure of the case's [[panels]] of that name: a disc's field over time against published curves."""

    def figure_of(data: Data) -> Figure:
        wanted = [panel for panel in data.case.data.get("panels", []) if panel["figure"] == name]
        if not wanted:
            raise DataError(f"checks.toml has no panels of figure {name}")
        rows = -(-len(wanted) // 2)
        figure = Figure(figsize=(11, 3.8 * rows), layout="constrained")
        for axes, panel in zip(figure.subplots(rows, 2, squeeze=False).flat, wanted, strict=False):
            _panel(axes, data, panel)
        return figure

    return figure_of


def _panel(axes: Axes, data: Data, panel: Mapping[str, Any]) -> None:
    published = read_curves(panel["data"], panel["label"])
    times, values = curves.read(published)
    for column, curve, marker in zip(published.columns, values.T, MARKERS, strict=False):
        author = column.split("_")[0]
        axes.plot(times, curve, marker, color="black", fillstyle="none", markersize=3.5, label=author)
    variants = [
        variant for variant in data.case.variants if data.results(variant)
    ]  # others are for another level
    if not variants:
        raise DataError("no variant was run")
    runs = [data.result(variant).disc(panel["disc"], panel["field"]) for variant in variants]
    if len(runs) > MOST_LINES:
        stamps = runs[0][0]
        members = np.array([np.interp(stamps, *run) for run in runs])
        axes.fill_between(
            stamps, members.min(axis=0), members.max(axis=0), alpha=0.3, label=f"SPH, {len(runs)} members"
        )
        axes.plot(stamps, members.T, color=COLOURS[0], linewidth=0.5)
    else:
        for variant, run, colour in zip(variants, runs, COLOURS, strict=False):
            axes.plot(*run, color=colour, label=data.label(variant.name))
    variant = variants[0]
    for name in data.case.references(variant.name):
        truth = of_disc(data.reference(variant, name), panel["disc"], panel["field"], runs[0][0])
        axes.plot(runs[0][0], truth, "--", color=COLOURS[3], label=name.replace("_", " "))
    axes.set(xlabel="time (s)", ylabel=panel["label"], title=panel["disc"])
    axes.legend(fontsize=8)


def snapshots(data: Data) -> Figure:
    """Fig. 9: the discs in the vorticity of the fluid, at every snapshot of the run."""
    result = data.result(data.case.variants[0])
    scene, times = result.scene, result.snapshot_times()
    width, height = np.subtract(scene["domain"]["upper"], scene["domain"]["lower"])
    figure = Figure(figsize=(2.4 * len(times) * max(1, width / height * 2) + 1, 6.5), layout="constrained")
    axes = figure.subplots(1, len(times), squeeze=False, sharey=True)[0]
    limit = limit_of(result, times, "vorticity")
    for axis, time in zip(axes, times, strict=True):
        dots = draw(axis, result, time, "vorticity", limit)
        axis.set_title(f"t = {time:.3g} s")
        axis.label_outer()
    figure.colorbar(dots, ax=list(axes), label="vorticity (1/s)", shrink=0.7)
    return figure


def phase_times(data: Data) -> Figure:
    """When drafting, kissing, tumbling and separation begin, a row for each variant."""
    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axes = figure.subplots()
    found: list[dict[str, float]] = []
    for variant in data.case.variants:
        result = data.result(variant)
        names = result.disc_names()
        (times, leading), (_, trailing) = (result.disc(name, "position") for name in names[:2])
        diameter = sum(result.disc_constant(name, "radius") for name in names[:2])
        found.append(phases(times, leading, trailing, diameter))
    for index, phase in enumerate(PHASES):
        points = [(begun[phase], row) for row, begun in enumerate(found) if phase in begun]
        style = {"color": COLOURS[index], "markersize": 8, "label": phase, "fillstyle": "none"}
        axes.plot(*np.reshape(points, (-1, 2)).T, MARKERS[index], **style)
    labels = [variant.name.replace("_", " ") for variant in data.case.variants]
    axes.set_yticks(range(len(labels)), labels)
    axes.set(xlabel="time (s)")
    figure.legend(loc="outside upper center", ncols=len(PHASES))
    return figure


def passage(data: Data) -> Figure:
    """A disc carried through a gap: the greatest wafer shear over time and the path, and the reference's."""
    variant = data.case.variants[0]
    reference, disc = data.reference(variant), data.case.scene(variant)["discs"][0]["name"]
    figure = Figure(figsize=(11, 4), layout="constrained")
    left, right = figure.subplots(1, 2)
    for (spacing, result), colour in zip(data.results(variant), COLOURS, strict=False):
        label = f"SPH, spacing {MICRO * spacing:.3g} µm"
        times, shear = DERIVED["greatest_wafer_shear"](result)
        left.plot(MICRO * times, shear, color=colour, label=label)
        right.plot(*(MICRO * result.disc(disc, "position")[1].T), color=colour, label=label)
    label = "immersed boundaries"
    truth = np.array([reference.greatest_wafer_shear(time) for time in times])
    left.plot(MICRO * times, truth, "k--", label=label)
    right.plot(*(MICRO * reference.disc(disc, "position", times).T), "k--", label=label)
    spread = np.nanmax(truth) - np.nanmin(truth)
    left.set(xlabel="time (µs)", ylabel="greatest wafer shear (Pa)")
    left.set_ylim(np.nanmin(truth) - spread, np.nanmax(truth) + spread)  # the start goes to infinity
    right.set(xlabel="x of the disc (µm)", ylabel="y of the disc (µm)")
    for axes in (left, right):
        axes.legend(fontsize=8)
    return figure


FIGURES: dict[str, Callable[[Data], Figure]] = {
    "momentum": momentum,
    "drag": drag,
    "film_forces": film_forces,
    "torque": torque,
    "trajectory": panels("trajectory"),
    "positions": panels("positions"),
    "velocities": panels("velocities"),
    "snapshots": snapshots,
    "phases": phase_times,
    "passage": passage,
}
CAPTIONS = {
    "momentum": "Momentum of fluid, discs and both.",
    "drag": "Drag on a square array of cylinders against sangani1982.",
    "film_forces": "Force and torque on a disc held near a sliding wall, over the thickness of its film.",
    "torque": "Torque over time against the finite elements.",
    "trajectory": "Height and velocity against the published curves.",
    "snapshots": "Discs and vorticity (Fig. 9).",
    "positions": "Positions of both discs against the published curves (Fig. 10).",
    "velocities": "Velocities of both discs against the published curves (Fig. 11).",
    "phases": "When drafting, kissing, tumbling and separation begin.",
    "passage": "Greatest wafer shear while a disc is carried through the gap, and its path.",
}
