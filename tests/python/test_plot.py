"""The pictures of a run, from small synthetic runs: what is held is drawn, what is missing is said."""

import os

import h5py
import matplotlib
import numpy as np
import pytest
from disc_fakes import TIMES, fields, write
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from verification import plot
from verification.measure import open_run
from verification.picture import FIELDS, MISSING, NOTHING, WALL, draw
from verification.run_figures import FIGURES

SCENE = """
[domain]
lower = [0.0, 0.0]
upper = [4e-5, 2e-5]
periodic = "x"
[fluid]
density = 1000.0
dynamic_viscosity = 1e-3
[[walls]]
name = "wafer"
velocity = [2e-5, 0.0]
[[discs]]
name = "disc"
[[probes]]
name = "wafer"
kind = "wall"
wall = "wafer"
[[probes]]
name = "middle"
kind = "point"
[output]
end_time = 1.0
"""
N = 20


def add(file, path, values, unit="1"):
    file[path] = values
    file[path].attrs["unit"] = unit


@pytest.fixture
def run(tmp_path):
    """The folder of a run with all that can be drawn; its disc goes out on the right, in on the left."""
    way = np.stack([3e-5 + 2e-5 * TIMES, np.full_like(TIMES, 1e-5)], axis=1)
    path = write(tmp_path / "run", {"disc": fields(way, velocity_x=2e-5)}, radius=1e-6).path
    x, y = (a.ravel() for a in np.meshgrid((np.arange(2 * N) + 0.5) * 1e-6, (np.arange(N) + 0.5) * 1e-6))
    wall = np.stack([np.linspace(0, 4e-5, 41), np.full(41, 2.05e-5)])
    along = np.linspace(0, 4e-5, 40, endpoint=False)
    with h5py.File(path, "a") as file:
        file.attrs["scene"] = SCENE
        file["run"].attrs["fluid_particles"] = len(x)
        add(file, "series/kinetic_energy", 1e-9 * TIMES, "J/m")
        snapshot = file.create_group("snapshots/0000")
        snapshot.attrs["time"] = 1.0
        snapshot["wall"] = np.repeat([-1, 0, 1], [len(x), 41, 1])  # the last is of the disc
        columns = [np.append(x, [*wall[0], 0]), np.append(y, [*wall[1], 0])]
        columns += [np.append(y, np.zeros(42)), np.zeros(len(x) + 42), np.append(x, np.full(42, np.nan))]
        for name, values in zip(
            ("position_x", "position_y", "velocity_x", "velocity_y", "pressure"), columns, strict=True
        ):
            snapshot[name] = values
        for name, values in (("time", TIMES), ("x", along), ("arc_length", along)):
            add(file, f"probes/wafer/{name}", values)
        for name in ("pressure", "shear"):
            add(file, f"probes/wafer/{name}", np.tile(np.cos(along / 4e-6), (len(TIMES), 1)), "Pa")
        for name in ("time", "pressure", "velocity_x", "velocity_y"):
            add(file, f"probes/middle/{name}", TIMES, "Pa")
    return path.parent


def change(run, path, index, value):
    with h5py.File(run / "result.h5", "a") as file:
        values = file[path][()]
        values[index] = value
        file[path][...] = values


def only(monkeypatch, kind):
    monkeypatch.setattr(plot, "FIGURES", {kind: FIGURES[kind]})


NAMES = ["fields", "wall_wafer", "wall_wafer_over_time", "discs", "points", "totals"]


def test_all_that_a_run_holds_is_drawn_and_listed(run, capsys):
    assert plot.main([str(run)]) == 0
    out = capsys.readouterr().out
    assert out == "".join(f"{run / 'plots' / name}.png\n" for name in NAMES)
    assert sorted(path.stem for path in (run / "plots").iterdir()) == sorted(NAMES)
    assert all(path.read_bytes()[:4] == b"\x89PNG" for path in (run / "plots").iterdir())


def test_what_a_run_does_not_hold_is_skipped_with_a_reason(run, capsys):
    with h5py.File(run / "result.h5", "a") as file:
        del file["snapshots/0000"], file["discs"]
    assert plot.main([str(run), "--out", str(run / "here")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == [
        "fields: skipped: the snapshots holds no data",
        "discs: skipped: the run has no discs",
    ]
    assert len(lines) == 6
    assert not (run / "here" / "fields.png").exists()


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("probes/wafer/shear", "walls: skipped: the result has no probes/wafer/shear"),
        ("series/time", "totals: skipped: the result has no series/time"),
    ],
)
def test_a_column_that_is_missing_is_named(run, monkeypatch, path, reason):
    with h5py.File(run / "result.h5", "a") as file:
        del file[path]
    only(monkeypatch, reason.split(":")[0])
    assert plot.save(open_run(run), run / "plots") == ([], [reason])


def test_columns_that_do_not_fit_are_skipped(run, monkeypatch):
    with h5py.File(run / "result.h5", "a") as file:
        del file["series/time"]
        file["series/time"] = TIMES[:-7]
    only(monkeypatch, "totals")
    written, skipped = plot.save(open_run(run), run / "plots")
    assert not written
    assert "totals: skipped: x and y must have same first dimension" in skipped[0]


def damage(run, kind):
    path = run / "result.h5"
    if kind == "truncated":
        path.write_bytes(path.read_bytes()[:-2000])
    elif kind == "no_scene":
        with h5py.File(path, "a") as file:
            del file.attrs["scene"]
    elif kind == "empty":
        with h5py.File(path, "a") as file:
            del file["snapshots"], file["series"], file["discs"], file["probes"]
    else:
        path.rename(run / "failed.h5")


@pytest.mark.parametrize(
    ("kind", "reason"),
    [
        ("truncated", "truncated file"),
        ("no_scene", "not the result of a run"),
        ("empty", "nothing that can be drawn"),
        ("failed", "a run that failed is in failed.h5"),
    ],
)
def test_what_is_not_a_run_is_refused_in_one_line(run, capsys, kind, reason):
    damage(run, kind)
    assert plot.main([str(run)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("plot: ")
    assert reason in error
    assert len(error.splitlines()) == 1
    assert not (run / "plots").exists()


def test_a_failed_run_can_be_drawn_by_its_file(run, monkeypatch):
    damage(run, "failed")
    only(monkeypatch, "totals")
    assert plot.main([str(run / "failed.h5")]) == 0
    assert (run / "plots" / "totals.png").exists()


@pytest.mark.parametrize(
    ("name", "reason"),
    [("failed.h5", "failed"), ("checkpoint.h5", "interrupted"), ("result.h5.partial", "killed")],
)
def test_a_later_run_that_did_not_end_is_told(run, monkeypatch, capsys, name, reason):
    only(monkeypatch, "totals")
    (run / name).touch()
    os.utime(run / name, (1, 1))
    assert plot.main([str(run)]) == 0
    assert capsys.readouterr().err == ""
    os.utime(run / "result.h5", (1, 1))
    (run / name).touch()
    assert plot.main([str(run)]) == 0
    error = capsys.readouterr().err
    assert error.startswith(f"plot: warning: {run / name} is newer than result.h5: the last run there")
    assert reason in error
    assert error.endswith("; result.h5 is of an earlier run\n")


def test_pictures_of_an_earlier_run_go_and_nothing_else(run):
    plots = run / "plots"
    plots.mkdir()
    for name in ("wall_gone.png", "wall_gone_over_time.png", "points.png", "mine.png", "wall_gone.pdf"):
        (plots / name).touch()
    with h5py.File(run / "result.h5", "a") as file:
        del file["probes/middle"]
    plot.save(open_run(run), plots)
    left = {path.name for path in plots.iterdir()}
    assert left == {f"{name}.png" for name in NAMES if name != "points"} | {"mine.png", "wall_gone.pdf"}


def test_a_run_that_failed_before_its_first_sample_has_its_fields_drawn(run, monkeypatch):
    with h5py.File(run / "result.h5", "a") as file:
        del file["series"]
        file.create_group("series")
    only(monkeypatch, "fields")
    assert plot.save(open_run(run), run / "plots") == ([run / "plots" / "fields.png"], [])


def legends(figure):
    found = [axes.get_legend() for axes in figure.axes] + figure.legends
    return [text.get_text() for legend in found if legend for text in legend.texts]


def test_particles_that_are_not_finite_are_shown_where_they_are(run):
    change(run, "snapshots/0000/pressure", 45, np.nan)
    change(run, "snapshots/0000/velocity_x", [45, 46], np.inf)
    figure = FIGURES["fields"](open_run(run))["fields"]
    assert legends(figure) == [f"not finite: {n} particles" for n in (2, 1, 2)]
    axes = figure.axes[1]
    marks = [
        dots for dots in axes.collections if dots.get_facecolor()[0, 0] == dots.get_facecolor()[0, 2] == 1
    ]
    np.testing.assert_allclose(marks[-1].get_offsets(), [[5.5e-6, 1.5e-6]])
    assert MISSING == "magenta"
    change(run, "snapshots/0000/position_y", 7, np.nan)
    assert legends(FIGURES["fields"](open_run(run))["fields"]) == [
        f"not finite: {n} particles" for n in (3, 2, 3)
    ]


def test_gaps_in_series_and_walls_are_counted(run):
    for path in ("series/kinetic_energy", "probes/middle/pressure", "probes/wafer/shear"):
        change(run, path, -1, np.nan)
    result = open_run(run)
    assert "fluid (not finite: 1 of 101)" in legends(FIGURES["totals"](result)["totals"])
    assert legends(FIGURES["points"](result)["points"]) == ["middle (not finite: 1 of 101)"]
    walls = FIGURES["walls"](result)
    assert legends(walls["wall_wafer"]) == ["shear (not finite: 40 of 40)"]
    assert legends(walls["wall_wafer_over_time"]) == ["not finite: 40 of 4040"]


def test_what_is_never_finite_is_said_to_be_so(run, monkeypatch):
    for path in ("snapshots/0000/velocity_x", "probes/wafer/pressure", "series/kinetic_energy"):
        change(run, path, slice(None), np.nan)
    only(monkeypatch, "fields")
    assert plot.save(open_run(run), run)[1] == ["fields: skipped: no particle has a speed"]
    FIGURES["totals"](open_run(run))
    figure = FIGURES["walls"](open_run(run))["wall_wafer"]
    assert legends(figure) == ["pressure - mean (not finite: 40 of 40)"]


def test_a_wall_is_drawn_where_it_stands(run):
    figure = FIGURES["walls"](open_run(run))["wall_wafer"]
    x, pressure = figure.axes[0].lines[0].get_data()
    assert np.all(np.diff(x) > 0)
    assert x[0] == pytest.approx(0, abs=1e-12)
    assert x[np.argmax(pressure)] == pytest.approx(2e-5)  # where the crest of x = 0 has come by time 1


def test_the_lid_of_a_closed_box_is_drawn_where_it_stays(run):
    with h5py.File(run / "result.h5", "a") as file:
        file.attrs["scene"] = SCENE.replace('periodic = "x"', "")
    walls = FIGURES["walls"](open_run(run))
    assert walls["wall_wafer"].axes[0].lines[0].get_xdata() == pytest.approx(np.linspace(0, 3.9e-5, 40))
    assert "frame" not in walls["wall_wafer_over_time"].axes[0].get_xlabel()


def test_noise_is_drawn_flat_and_structure_is_not(run):
    """Rounding against what a wall at 1 m/s makes natural: 1000 Pa in the pressure, 50 Pa in the shear."""
    with h5py.File(run / "result.h5", "a") as file:
        file.attrs["scene"] = SCENE.replace("[2e-5, 0.0]", "[1.0, 0.0]")
        ripple = np.cos(np.arange(4040)).reshape(-1, 40)
        file["probes/wafer/pressure"][...] = 1e-3 * ripple
        file["probes/wafer/shear"][...] = 200 + 1e-3 * ripple
        file["probes/middle/pressure"][...] = 5 + 1e-3 * ripple[:, 0]
        file["probes/middle/velocity_y"][...] = 1e-6 * ripple[:, 0]
        pressure = file["snapshots/0000/pressure"]
        pressure[...] = 1e-3 * np.cos(np.arange(len(pressure)))
    result = open_run(run)
    ranges = {
        name: [axes.get_ylim() for axes in FIGURES[kind](result)[name].axes]
        for kind, name in (("walls", "wall_wafer"), ("points", "points"))
    }
    assert ranges["wall_wafer"][0] == pytest.approx((-1, 1), abs=2e-3)
    assert ranges["wall_wafer"][1] == pytest.approx((199.8, 200.2), abs=2e-3)
    assert ranges["points"][0] == pytest.approx((4, 6), abs=2e-3)
    assert ranges["points"][1] == pytest.approx((-0.05, 1.05))
    assert ranges["points"][2] == pytest.approx((-1e-3, 1e-3), abs=2e-6)
    pressure, shear = colour_ranges(FIGURES["walls"](result)["wall_wafer_over_time"])
    assert pressure == pytest.approx((-1, 1))
    assert shear == pytest.approx((199.8, 200.2), abs=2e-3)
    fields = FIGURES["fields"](result)["fields"]
    assert colour_ranges(fields)[1] == pytest.approx((-1, 1))
    change(run, "snapshots/0000/pressure", slice(0, 400), 7.0)
    assert colour_ranges(FIGURES["fields"](result)["fields"])[1][1] > 3


def colour_ranges(figure):
    """Of the panels, not of the colour bars."""
    return [axes.collections[0].get_clim() for axes in figure.axes if axes.get_title()]


def test_a_way_across_the_periodic_side_is_broken_there(run):
    line = FIGURES["discs"](open_run(run))["discs"].axes[0].lines
    way = next(line for line in line if len(line.get_xdata()) > 50)
    x = way.get_xdata()
    assert np.count_nonzero(np.isnan(x)) == 1
    assert np.nanmax(np.abs(np.diff(x))) < 1e-6


def test_points_have_one_legend_outside_the_panels(run):
    figure = FIGURES["points"](open_run(run))["points"]
    assert legends(figure) == ["middle"]
    assert not any(axes.get_legend() for axes in figure.axes)
    assert figure.axes[0].get_xlim() == (TIMES[0], TIMES[-1])


def no_fluid(figure):
    """Which pixels (rows, columns) of a figure show that there is no fluid; the last row is the lowest."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    colours = np.asarray(canvas.buffer_rgba())[:, :, :3] / 255
    return np.all(np.abs(colours - float(NOTHING)) < 0.01, axis=2)


def test_the_fluid_is_drawn_to_periodic_sides_and_to_discs(run):
    """The particles left and right of x = 0 stand a spacing off it, and one is missing beside the disc."""
    with h5py.File(run / "result.h5", "a") as file:
        group = file["snapshots/0000"]
        x, y = group["position_x"][()], group["position_y"][()]
        fluid = group["wall"][()] < 0
        gone = fluid & ((x < 0.6e-6) | (np.hypot(x - 1.15e-5, y - 1.05e-5) < 0.1e-6))
        for name in list(group):
            values = group[name][()][~gone]
            del group[name]
            group[name] = values
        file["run"].attrs["fluid_particles"] = np.count_nonzero(fluid & ~gone)
    figure = Figure(figsize=(8, 4))
    axes = figure.add_axes((0, 0, 1, 1))
    draw(axes, open_run(run), 1.0, "speed")
    axes.set(ylim=(0, 1.9e-5))
    assert not np.any(no_fluid(figure))
    axes.set(ylim=(-4e-6, 1.9e-5))
    assert np.all(no_fluid(figure)[-50:-5, 300:500])  # where indeed there is none


@pytest.mark.parametrize("field", FIELDS)
def test_no_value_has_the_colour_of_no_fluid(field):
    colours = matplotlib.colormaps[FIELDS[field].colours](np.linspace(0, 1, 256))[:, :3]
    for other in (colours, [matplotlib.colors.to_rgb(WALL)], [matplotlib.colors.to_rgb("white")]):
        assert np.linalg.norm(np.array(other) - float(NOTHING), axis=1).min() > 0.1


def test_a_picture_has_the_walls_and_every_image_of_a_disc(run):
    axes = Figure().subplots()
    draw(axes, open_run(run), 1.0, "speed")
    assert axes.get_ylim()[1] > 2.05e-5
    assert len(open_run(run).snapshot(1.0)[1]) == 41  # the disc's particle is none of the wall's
    assert sorted(round(1e6 * patch.center[0]) for patch in axes.patches) == [-30, 10, 50]
