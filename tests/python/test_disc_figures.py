"""Vorticity, figures and the movie of discs, from small synthetic runs."""

import os

import h5py
import numpy as np
import pytest
from disc_fakes import END, TIMES, fields, write
from matplotlib.axes import Axes

from verification import movie, report
from verification.case import Variant, load_case
from verification.compare import DataError
from verification.disc_figures import FIGURES
from verification.figures import Data
from verification.measure import Particles, Result
from verification.picture import vorticity


def turning(rate=3.0, n=12):
    """Fluid that turns like a solid about (0.5, 0.5) in the unit square, vorticity 2 `rate`."""
    x, y = (a.ravel() for a in np.meshgrid(*2 * [(np.arange(n) + 0.5) / n]))
    position = np.stack([x, y], axis=1)
    return position, rate * np.stack([0.5 - y, x - 0.5], axis=1)


def add_snapshots(path, times, scene_text=""):
    position, velocity = turning()
    with h5py.File(path, "a") as file:
        file.attrs["scene"] = scene_text
        file["run"].attrs["fluid_particles"] = len(position)
        for index, time in enumerate(times):
            group = file.create_group(f"snapshots/{index:04}")
            group.attrs["time"] = time
            group["wall"] = np.full(len(position), -1)
            columns = [*position.T, *velocity.T, np.zeros(len(position))]
            names = ("position_x", "position_y", "velocity_x", "velocity_y", "pressure")
            for name, values in zip(names, columns, strict=True):
                group[name] = values


def discs(*names):
    place = np.stack([np.full_like(TIMES, 0.01), 0.04 - 0.01 * TIMES], axis=1)
    return {name: fields(place + [0, 0.005 * k], spin=1.0) for k, name in enumerate(names)}


def test_vorticity_of_a_linear_flow_is_exact():
    position, velocity = turning()
    particles = Particles(0.0, position, velocity + position @ np.diag([1.0, -1.0]), np.zeros(len(position)))
    np.testing.assert_allclose(vorticity(particles), 6.0, rtol=1e-9)
    with pytest.raises(DataError, match="too few"):
        vorticity(Particles(0.0, position[:5], velocity[:5], np.zeros(5)))


class Flat:
    def disc(self, name, field, t):
        vector = field in ("position", "velocity", "force")
        return np.full((*np.shape(t), 2) if vector else np.shape(t), -1e-7)


def data_of(case_name, tmp_path, names, monkeypatch, run=None, **series):
    """Data of a case whose runs are all the same small result, end times and all."""
    case = load_case(case_name)
    entries = []
    for variant in case.variants:
        folder = tmp_path / "runs" / case_name / "default" / variant.name / "0.1"
        result = write(folder, discs(*names), radius=1.25e-3, series=series)
        add_snapshots(result.path, [0.5 * END, END])
        entries.append({"variant": variant.name, "scheme": "default", "spacing_m": 0.1, "finest": True})
    monkeypatch.setattr(Result, "_near", lambda *_: None)
    return Data(case, entries, tmp_path, lambda variant, name="": Flat())


@pytest.mark.parametrize(
    ("case", "names"),
    [
        ("disc_conservation", ("heavy", "light")),
        ("disc_array_drag", ("cylinder",)),
        ("disc_near_wall", ("disc",)),
        ("disc_rotating", ("disc",)),
        ("disc_settling", ("disc",)),
        ("disc_pair", ("leading", "trailing")),
        ("disc_pair_ensemble", ("leading", "trailing")),
    ],
)
def test_every_figure_of_the_cases_can_be_drawn(tmp_path, monkeypatch, case, names):
    flow = {"momentum_x": 1e-3 * (1 + TIMES), "momentum_y": TIMES}
    data = data_of(case, tmp_path, names, monkeypatch, **flow)
    assert data.case.figures
    for name in data.case.figures:
        figure = FIGURES[name](data)
        figure.canvas.draw()
        assert all(axes.has_data() for axes in figure.axes if isinstance(axes, Axes))
        assert name in report.CAPTIONS


def test_the_ensemble_is_a_band(tmp_path, monkeypatch):
    data = data_of("disc_pair_ensemble", tmp_path, ("leading", "trailing"), monkeypatch)
    labels = FIGURES["positions"](data).axes[0].get_legend_handles_labels()[1]
    assert labels == ["uhlmann", "koblitz", "SPH, 9 members"]


def test_a_figure_without_its_run_or_panels_says_so(tmp_path, monkeypatch):
    data = data_of("disc_still", tmp_path, ("disc",), monkeypatch)
    with pytest.raises(DataError, match="no panels of figure positions"):
        FIGURES["positions"](data)
    with pytest.raises(DataError, match="was not run"):
        data.result(Variant("other", {}))


SCENE = "[domain]\nlower = [0.0, 0.0]\nupper = [1.0, 1.0]\n[output]\nend_time = 1.0\n"


@pytest.fixture
def run(tmp_path):
    result = write(tmp_path / "run", discs("disc"), radius=0.1)
    add_snapshots(result.path, [0.0, 0.5, 1.0], SCENE)
    return result.path.parent


@pytest.mark.parametrize(
    ("choice", "name"), [([], "vorticity.gif"), (["--field", "pressure"], "pressure.gif")]
)
def test_a_movie_has_a_frame_for_each_snapshot(run, capsys, monkeypatch, choice, name):
    monkeypatch.setattr(movie.animation.FFMpegWriter, "isAvailable", lambda: False)
    assert movie.main([str(run), *choice]) == 0
    assert capsys.readouterr().out == f"{run / name}: 3 frames\n"
    assert (run / name).read_bytes()[:4] == b"GIF8"
    assert sorted(path.name for path in run.iterdir()) == sorted([name, "result.h5"])
    assert movie.main([str(run), "--out", str(run / "movie.mp4")]) == 2
    assert "where ffmpeg is installed" in capsys.readouterr().err


def test_a_movie_says_when_a_later_run_did_not_end(run, capsys, monkeypatch):
    monkeypatch.setattr(movie, "write", lambda *_: 3)
    os.utime(run / "result.h5", (1, 1))
    (run / "failed.h5").touch()
    assert movie.main([str(run)]) == 0
    assert capsys.readouterr().err.startswith(f"movie: warning: {run / 'failed.h5'} is newer than result.h5")


@pytest.mark.parametrize("damage", ["missing", "no_scene", "one_snapshot"])
def test_a_movie_of_nothing_is_refused_in_one_line(run, capsys, damage):
    path = run / "result.h5"
    if damage == "missing":
        path.unlink()
    else:
        with h5py.File(path, "a") as file:
            if damage == "no_scene":
                del file.attrs["scene"]
            else:
                del file["snapshots/0000"], file["snapshots/0001"]
    assert movie.main([str(run), "--out", str(run / "movie.gif")]) == 2
    error = capsys.readouterr().err
    assert len(error.splitlines()) == 1
    assert error.startswith("movie: ")
    assert not (run / "movie.gif").exists()
