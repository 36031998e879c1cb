"""The bench's figures, each from a part of speed_error.json; DataError where there is nothing to draw."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FormatStrFormatter, LogFormatterMathtext, LogLocator, NullFormatter

from verification.compare import DataError
from verification.figures import COLOURS, MARKERS

LINES = ("-", "--", ":")


def error_against_time(results: Mapping[str, Any], case: str, variant: str) -> Figure:
    """A panel for each quantity: colour is the scheme, line the arithmetic, marker the threads."""
    points = [
        p
        for p in results.get("speed_error", [])
        if (p["case"], p["variant"]) == (case, variant) and not p["failure"]
    ]
    quantities = list(dict.fromkeys(q for p in points for q, value in p["errors"].items() if value))
    if not quantities:
        raise DataError("no run has an error")
    columns = min(3, len(quantities)) if len(quantities) != 4 else 2
    rows = -(-len(quantities) // columns)
    figure = Figure(figsize=(max(9.0, 4.5 * columns), 3.9 * rows + 1.3), layout="constrained")
    axes = list(figure.subplots(rows, columns, squeeze=False).flat)
    entries: dict[str, Line2D] = {}
    for axis, quantity in zip(axes, quantities, strict=False):
        _curves(axis, points, quantity)
        _finite_elements(axis, results, case, variant)
        _peers(axis, results, case, quantity)
        axis.set(title=quantity.replace("_", " "), xlabel="wall time (s)", ylabel="relative error (-)")
        logarithmic(axis)
        handles, labels = axis.get_legend_handles_labels()
        entries |= dict(zip(labels, handles, strict=True))
    for axis in axes[len(quantities) :]:
        axis.set_axis_off()
    figure.legend(
        entries.values(),
        entries,
        loc="outside upper center",
        ncols=int(figure.get_figwidth() // 2.9),
        fontsize=9,
    )
    return figure


def logarithmic(axis: Axes) -> None:
    """Both axes logarithmic with labels that do not overlap, however small the range."""
    ranges = (axis.dataLim.intervalx, axis.dataLim.intervaly)
    pads = [max(1.3, (4 * low / high) ** 0.5) for low, high in ranges]  # a factor of four at least
    limits = [(low / pad, high * pad) for (low, high), pad in zip(ranges, pads, strict=True)]
    axis.set(xlim=limits[0], ylim=limits[1])
    axis.set(xscale="log", yscale="log")
    for one, (low, high) in zip((axis.xaxis, axis.yaxis), limits, strict=True):
        few = high / low < 50
        one.set_major_locator(LogLocator(subs=(1, 2, 5) if few else (1,)))
        one.set_major_formatter(FormatStrFormatter("%g") if few else LogFormatterMathtext())
        one.set_minor_formatter(NullFormatter())
    axis.grid(True, which="both", alpha=0.25)


def _curves(axis: Axes, points: Sequence[Mapping[str, Any]], quantity: str) -> None:
    schemes = list(dict.fromkeys(p["scheme"] for p in points))
    arithmetics = list(dict.fromkeys(p["arithmetic"] for p in points))
    threads = sorted({p["threads"] for p in points})
    for scheme, arithmetic, count in dict.fromkeys(
        (p["scheme"], p["arithmetic"], p["threads"]) for p in points
    ):
        curve = [
            (p["wall_s"], p["errors"][quantity])
            for p in sorted(points, key=lambda p: -p["spacing_m"])
            if (p["scheme"], p["arithmetic"], p["threads"]) == (scheme, arithmetic, count)
            and p["errors"].get(quantity)
        ]
        if curve:
            axis.plot(
                *zip(*curve, strict=True),
                MARKERS[threads.index(count) % len(MARKERS)],
                linestyle=LINES[arithmetics.index(arithmetic) % len(LINES)],
                color=COLOURS[schemes.index(scheme) % len(COLOURS)],
                fillstyle="none",
                markersize=6,
                label=f"{scheme}, {arithmetic}, {count} thread{'s' if count > 1 else ''}",
            )


def _finite_elements(axis: Axes, results: Mapping[str, Any], case: str, variant: str) -> None:
    for made in results["references"]:
        if (made["case"], made["variant"], made["kind"]) == (case, variant, "finite-element"):
            label = f"finite elements, error {made['error_estimate']:.1g}"
            axis.axvline(made["seconds"], color="black", linestyle="-.", linewidth=1, label=label)


def _peers(axis: Axes, results: Mapping[str, Any], case: str, quantity: str) -> None:
    """Another code's runs, where it measured the same flow with our comparer."""
    peers = results.get("peers") or {"runs": []}
    runs = [r for r in peers["runs"] if r["case"] == case and not r["set"] and r["errors"].get(quantity)]
    for index, run in enumerate(runs):
        label = f"{run['code']} {run['scheme']}, 1 thread"
        point = (run["wall_s"], run["errors"][quantity])
        axis.plot(*point, ("*", "P", "X")[index % 3], color="black", markersize=10, label=label)


def scaling(results: Mapping[str, Any]) -> Figure:
    """Cost of a particle-step and memory of a particle against the number of particles."""
    rows = [row for row in (results.get("scaling") or {"rows": []})["rows"] if not row["failure"]]
    if not rows:
        raise DataError("the scaling was not measured")
    figure = Figure(figsize=(10, 4.2), layout="constrained")
    cost, memory = figure.subplots(1, 2)
    for index, threads in enumerate(sorted({row["threads"] for row in rows})):
        own = sorted((r for r in rows if r["threads"] == threads), key=lambda r: r["particles"])
        style = {"marker": MARKERS[index], "color": COLOURS[index], "fillstyle": "none"}
        style |= {"label": f"{threads} thread{'s' if threads > 1 else ''}", "linestyle": LINES[index]}
        particles = [r["particles"] for r in own]
        cost.plot(particles, [r["ns_per_particle_step"] for r in own], **style)
        memory.plot(particles, [r["bytes_per_particle"] or float("nan") for r in own], **style)
    cost.set(ylabel="wall time of a particle-step (ns)")
    memory.set(ylabel="memory of a particle (bytes)")
    for axis in (cost, memory):
        axis.set(xscale="log", xlabel="particles (-)")
        axis.set_ylim(bottom=0)
        axis.legend()
    return figure


def search(results: Mapping[str, Any]) -> Figure:
    """Time of the neighbour searches per point, a panel for each set of points."""
    entries = (results.get("machine_bench") or {}).get("search", [])
    if not entries:
        raise DataError("`slurry bench` has no times of neighbour searches")
    sets = list(dict.fromkeys(e["set"] for e in entries))
    names = list(dict.fromkeys(e["search"] for e in entries))
    threads = sorted({e["threads"] for e in entries})
    figure = Figure(figsize=(max(8.0, 5 * len(sets)), 4.8), layout="constrained")
    axes = figure.subplots(1, len(sets), squeeze=False, sharey=True)[0]
    for axis, points in zip(axes, sets, strict=True):
        for name, count in dict.fromkeys((e["search"], e["threads"]) for e in entries):
            own = [e for e in entries if (e["search"], e["threads"], e["set"]) == (name, count, points)]
            own.sort(key=lambda e: e["points"])
            axis.plot(
                [e["points"] for e in own],
                [1e9 * e["seconds"] / e["points"] for e in own],
                MARKERS[threads.index(count) % len(MARKERS)],
                linestyle=LINES[threads.index(count) % len(LINES)],
                color=COLOURS[names.index(name) % len(COLOURS)],
                fillstyle="none",
                label=f"{name.replace('_', ' ')}, {count} thread{'s' if count > 1 else ''}",
            )
        axis.set(title=f"{points} points", xlabel="points (-)")
        logarithmic(axis)
    axes[0].set(ylabel="time per point (ns)")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, fontsize=9)
    return figure
