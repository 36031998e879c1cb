"""Figures of any run: fields, walls, discs, points and totals. Each takes a Result and returns figures by
name, or raises DataError where the run does not hold what it needs.

Nothing is left out in silence: what is not finite is a gap in a line, and is counted in its legend.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from verification.compare import Array, DataError
from verification.measure import Columns, Result
from verification.picture import (
    FIELDS,
    MISSING,
    NOISE,
    SHOWN,
    bounds,
    draw,
    least_shown,
    less_mean,
    periodic,
    scenery,
)
from verification.units import label, text

Figures = dict[str, Figure]
MOST_NAMES = 10  # of discs in a legend
LEAST_TIMES = 3  # that make a map over time
FLAT = 1e-6  # a series that changes less, against its size, is drawn as a constant


def fields(result: Result) -> Figures:
    """Speed, pressure and vorticity of the last snapshot, with walls and discs."""
    time = result.snapshot_times()[-1]
    width, height = np.subtract(*bounds(result)[::-1])
    if width > height:
        shape, size = (len(FIELDS), 1), (9, 1 + len(FIELDS) * (0.8 + 7 * height / width))
    else:
        shape, size = (1, len(FIELDS)), (1 + len(FIELDS) * (1.3 + 4.5 * width / height), 6)
    figure = Figure(figsize=size, layout="compressed")
    for axes, (name, field) in zip(figure.subplots(*shape).flat, FIELDS.items(), strict=True):
        dots = draw(axes, result, time, name)
        bar = figure.colorbar(dots, ax=axes, extend=field.beyond)
        label(bar.ax.yaxis, "", field.unit)
        axes.set_title(field.name)
    figure.suptitle(f"t = {text(time, 's')}")
    return {"fields": figure}


def walls(result: Result) -> Figures:
    """Pressure and shear along every wall with a probe: at the last time, and over time."""
    found: Figures = {}
    for probe in _probes(result, "wall"):
        columns = result.columns(f"probes/{probe['name']}")
        found[f"wall_{probe['name']}"] = _last(result, probe, columns)
        if len(columns["time"]) >= LEAST_TIMES and len(columns["x"]) > 1:
            found[f"wall_{probe['name']}_over_time"] = _map(result, probe, columns)
    return found


def _probes(result: Result, kind: str) -> list[dict]:
    probes = [probe for probe in result.scene.get("probes", []) if probe["kind"] == kind]
    if not probes:
        raise DataError(f"the scene has no probe of kind {kind}")
    return probes


def _velocity(result: Result, probe: dict) -> Array:
    """How fast the probe's points travel (2,), m/s; those of a wall that slides between fixed ends stay."""
    wall = next(wall for wall in result.scene["walls"] if wall["name"] == probe["wall"])
    return np.where(periodic(result), wall["velocity"], 0.0)


def _along(columns: Columns) -> tuple[Array, str]:
    """What counts the probe's points: x where the wall is a graph over x, else the length along it."""
    if np.all(np.diff(columns["x"]) > 0):
        return columns["x"], "x"
    return columns["arc_length"], "length along the wall"


def _last(result: Result, probe: dict, columns: Columns) -> Figure:
    place, name = _along(columns)
    time = columns["time"][-1]
    if name == "x":  # where the wall stands now, in the order of space
        lower, upper = (end[0] for end in bounds(result))
        place = place + _velocity(result, probe)[0] * time
        place = lower + (place - lower) % (upper - lower) if periodic(result)[0] else place
    order = np.argsort(place)
    least = _least_of_wall(result, columns)
    figure = Figure(figsize=(8, 6), layout="constrained")
    panels = figure.subplots(2, 1, sharex=True)
    for axes, values, of in (
        (panels[0], less_mean(columns["pressure"][-1]), "pressure - mean"),
        (panels[1], columns["shear"][-1], "shear"),
    ):
        _line(axes, place[order], values[order], of, ".-")
        _make_room(axes, least[of])
        label(axes.yaxis, of, "Pa")
    label(panels[1].xaxis, name, "m")
    figure.suptitle(f"Wall {probe['wall']} at t = {text(time, 's')}")
    return figure


def _least_of_wall(result: Result, columns: Columns) -> dict[str, float]:
    """Half the range that the scales of pressure and shear have at least, Pa: see least_shown()."""
    least = least_shown(result)
    shear = np.abs(columns["shear"][-1])
    largest = np.max(shear, where=np.isfinite(shear), initial=0.0)
    return {"pressure - mean": least["pressure"], "shear": max(least["shear"], NOISE * largest)}


def _make_room(axes: Axes, least: float) -> None:
    """Gives an axis `least` on either side of what is drawn, if that takes less."""
    low, high = axes.dataLim.intervaly
    if np.isfinite(high) and high - low < 2 * least:
        axes.set_ylim((low + high) / 2 - least, (low + high) / 2 + least)


def _map(result: Result, probe: dict, columns: Columns) -> Figure:
    """Pressure and shear over the place on the wall and time: the wall's own frame, where its points stay.

    The colours suit the last half of the times; a start may be beyond them.
    """
    place, name = _along(columns)
    moves = np.any(_velocity(result, probe))
    figure = Figure(figsize=(11, 5), layout="constrained")
    panels = figure.subplots(1, 2, sharey=True)
    change, room = less_mean(columns["pressure"]), _least_of_wall(result, columns)
    for axes, values, of, colours in (
        (panels[0], change, "pressure - mean", "RdBu_r"),
        (panels[1], columns["shear"], "shear", "viridis"),
    ):
        later = values[len(values) // 2 :]
        later = later[np.isfinite(later)]
        least, most = np.quantile(later, (1 - SHOWN, SHOWN)) if later.size else (0.0, 1.0)
        middle = 0.0 if values is change else (least + most) / 2
        half = max(most - middle, middle - least, room[of])
        least, most = middle - half, middle + half
        style = {"cmap": colours, "vmin": least, "vmax": most, "shading": "nearest", "rasterized": True}
        image = axes.pcolormesh(place, columns["time"], np.ma.masked_invalid(values), **style)
        axes.set_facecolor(MISSING)
        axes.grid(False)
        if count := np.count_nonzero(~np.isfinite(values)):
            axes.plot([], [], "s", color=MISSING, label=f"not finite: {count} of {values.size}")
            axes.legend(loc="upper right")
        label(axes.xaxis, f"{name} at t = 0, in the frame of the wall" if moves else name, "m")
        label(figure.colorbar(image, ax=axes, extend="both").ax.yaxis, "", "Pa")
        axes.set_title(of)
    label(panels[0].yaxis, "time", "s")
    figure.suptitle(f"Wall {probe['wall']}")
    return figure


def _line(axes: Axes, x: Array, y: Array, name: str, style: str = "-", **more: object) -> None:
    """A curve with gaps where it is not finite, which its name then says."""
    gaps = np.count_nonzero(~np.isfinite(y))
    _curve(axes, x, y, style, label=_with_gaps(name, gaps, y.size), **more)
    if gaps:
        axes.legend(fontsize=8)


def _curve(axes: Axes, x: Array, y: Array, style: str = "-", **more: object) -> Line2D:
    (line,) = axes.plot(x, y, style, **more)
    if x[0] < x[-1]:
        axes.set_xlim(x[0], x[-1])
    return line


def _with_gaps(name: str, gaps: int, samples: int) -> str:
    return f"{name} (not finite: {gaps} of {samples})" if gaps else name


def discs(result: Result) -> Figures:
    """The ways of the discs through the domain, and their speed over time."""
    if not result.holds("discs"):
        raise DataError("the run has no discs")
    columns = result.columns("discs")
    width, height = np.subtract(*bounds(result)[::-1])
    tall = min(7.0, 7 * height / width)
    figure = Figure(figsize=(8, tall + 3.5), layout="constrained")
    way, pace = figure.subplots(2, 1, height_ratios=[tall, 2.5])
    scenery(way, result, _walls_now(result), columns["time"][-1])
    names = result.disc_names()
    for index, name in enumerate(names):
        colour = f"C{index % 10}"
        places = np.stack([columns[f"position_{axis}"][:, index] for axis in "xy"], axis=1)
        x, y = _unbroken(places, result).T
        way.plot(x, y, color=colour, linewidth=1, zorder=2)
        way.plot(x[:1], y[:1], "x", color=colour, zorder=2)
        speed = np.hypot(columns["velocity_x"][:, index], columns["velocity_y"][:, index])
        _line(pace, columns["time"], speed, name, color=colour, linewidth=1)
    way.set_title(f"crosses: start; discs: t = {text(columns['time'][-1], 's')}")
    if len(names) <= MOST_NAMES:
        pace.legend(fontsize=8)
    label(pace.xaxis, "time", "s")
    label(pace.yaxis, "speed of the discs", "m/s")
    return {"discs": figure}


def _walls_now(result: Result) -> Array:
    try:
        return result.snapshot(result.end_time)[1]
    except DataError:  # no snapshots: that the fields were skipped says so
        return np.empty((0, 2))


def _unbroken(places: Array, result: Result) -> Array:
    """A way (n, 2) within the domain, with a gap where it goes out and in by a periodic side."""
    lower, upper = bounds(result)
    size = upper - lower
    within = np.where(periodic(result), lower + (places - lower) % size, places)
    jumps = np.flatnonzero(np.any(np.abs(np.diff(within, axis=0)) > size / 2, axis=1)) + 1
    return np.insert(within, jumps, np.nan, axis=0)


def points(result: Result) -> Figures:
    """What the point probes saw over time."""
    probes, least = _probes(result, "point"), least_shown(result)
    figure = Figure(figsize=(8, 7), layout="constrained")
    panels = figure.subplots(3, 1, sharex=True)
    for probe in probes:
        columns = result.columns(f"probes/{probe['name']}")
        gaps = 0
        for axes, name in zip(panels, ("pressure", "velocity_x", "velocity_y"), strict=True):
            gaps = max(gaps, np.count_nonzero(~np.isfinite(columns[name])))
            line = _curve(axes, columns["time"], columns[name])
            _make_room(axes, least[name.split("_")[0]])
            label(axes.yaxis, name.replace("_", " along "), columns.units[name])
        line.set_label(_with_gaps(probe["name"], gaps, line.get_xdata().size))
    figure.legend(loc="outside upper center", ncols=3)
    label(panels[-1].xaxis, "time", "s")
    return {"points": figure}


def totals(result: Result) -> Figures:
    """Every series over time, each in a panel; the kinetic energy with that of the discs."""
    columns = result.columns("series")
    times = columns["time"]
    series = [name for name in columns if name != "time"]
    rows = -(-len(series) // 2)
    figure = Figure(figsize=(10, 2.9 * rows), layout="constrained")
    panels = figure.subplots(rows, 2, squeeze=False, sharex=True)
    for axes in panels.flat[len(series) :]:
        axes.set_axis_off()
    for axes, name in zip(panels.flat, series, strict=False):
        _line(axes, times, columns[name], "fluid")
        if name == "kinetic_energy" and result.holds("discs"):
            _line(axes, times, _disc_energy(result), "discs")
            axes.legend(fontsize=8)
        low, high = axes.dataLim.intervaly
        if np.isfinite(high) and high - low < FLAT * abs(high):  # else its rounding would fill the panel
            axes.set_ylim(*sorted((0.99 * low, 1.01 * high)))
        label(axes.yaxis, name.replace("_", " "), columns.units[name])
        label(axes.xaxis, "time", "s")
        axes.xaxis.set_tick_params(labelbottom=True)
    return {"totals": figure}


def _disc_energy(result: Result) -> Array:
    """Kinetic energy (n,) of all discs over time, J/m."""
    columns = result.columns("discs")
    square = columns["velocity_x"] ** 2 + columns["velocity_y"] ** 2
    turning = columns["moment_of_inertia"] * columns["spin"] ** 2
    return (columns["mass"] * square + turning).sum(axis=1) / 2


FIGURES: dict[str, Callable[[Result], Figures]] = {
    "fields": fields,
    "walls": walls,
    "discs": discs,
    "points": points,
    "totals": totals,
}
