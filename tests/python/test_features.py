"""What a check of a feature looks at: a place over time, its repetition, its peak; and the figures of it."""

import h5py
import numpy as np
import pytest
from matplotlib.axes import Axes

from verification import report
from verification.case import Variant, load_case
from verification.compare import Check, DataError
from verification.feature_figures import FIGURES
from verification.figures import Data
from verification.measure import Result
from verification.truth import error_of, peak

CASE = load_case("wafer_feature")
PERIOD, END, LENGTH = 4e-5, 1.6e-4, 4e-5
TIMES = np.linspace(PERIOD / 50, END, 200)
X = np.linspace(0.1e-6, LENGTH - 0.1e-6, 41)


class Wave:
    """A pressure that goes along x once a period, with its crest at x = 0 at time 0."""

    kind, source, error_estimate = "finite-element", "fake", 0.0

    def wall_pressure(self, wall, x, t):
        assert wall == "wafer"
        return 100 * np.cos(2 * np.pi * (x / LENGTH - t / PERIOD))

    def pressure(self, x, y, t):
        return self.wall_pressure("wafer", np.asarray(x), t)


def write(folder, pressure=None, times=TIMES):
    pressure = pressure or Wave().pressure
    folder.mkdir(parents=True, exist_ok=True)
    moments = [1.2e-4, 1.28e-4, 1.36e-4, 1.44e-4, 1.52e-4, END]
    with h5py.File(folder / "result.h5", "w") as file:
        file.create_group("run").attrs["fluid_particles"] = len(X)
        file["probes/wafer/time"], file["probes/wafer/x"] = times, X
        file["probes/wafer/pressure"] = np.array([pressure(X, X, time) for time in times])
        file["probes/sample/time"] = times
        file["probes/sample/pressure"] = [pressure(2.3e-5, 1.85e-5, time) for time in times]
        for index, time in enumerate(moments):
            group = file.create_group(f"snapshots/{index:04}")
            group.attrs["time"], group["wall"] = time, np.full(len(X), -1)
            columns = [X, 1e-5 + 0 * X, 0 * X, 0 * X, pressure(X, X, time)]
            for name, values in zip(
                ("position_x", "position_y", "velocity_x", "velocity_y", "pressure"), columns, strict=True
            ):
                group[name] = values
    return Result(folder / "result.h5", END, CASE.scene())


def checks(variant="cavity"):
    return {check.quantity: check for check in CASE.checks("default", "gate", variant)}


def test_a_right_pressure_passes_every_check(tmp_path):
    result = write(tmp_path)
    assert {c.split(" at ")[0] for c in checks()} == {
        "sample_pressure", "sample_peak", "sample_point_pressure", "sample_repeats", "pressure",
    }  # fmt: skip
    for check in checks().values():
        assert error_of(check, result, Wave()) < 0.1 * check.tolerance
    for name in ("sample_pressure", "sample_point_pressure"):
        check = checks()[name]
        swollen = write(tmp_path / "more", lambda x, y, t: 1.1 * Wave().pressure(x, y, t) + 7)
        assert error_of(check, swollen, Wave()) == pytest.approx(0.1 * 50 * np.sqrt(2) / 200, rel=0.02)


def test_late_growing_and_missing_pressures_fail(tmp_path):
    late = write(tmp_path / "late", lambda x, y, t: Wave().pressure(x, y, t - 0.05 * PERIOD))
    assert error_of(checks()["sample_peak"], late, Wave()) == pytest.approx(0.05, abs=2e-3)
    for name in ("sample_pressure", "sample_point_pressure", "pressure at 0.000136 s"):
        assert error_of(checks()[name], late, Wave()) > checks()[name].tolerance
    growing = write(tmp_path / "growing", lambda x, y, t: t / END * Wave().pressure(x, y, t))
    assert error_of(checks()["sample_repeats"], growing, Wave()) > checks()["sample_repeats"].tolerance
    short = write(tmp_path / "short", times=TIMES[:150])
    nothing = write(tmp_path / "nothing", lambda x, y, t: np.nan * x)
    for name, check in checks().items():
        with pytest.raises(DataError, match="not finite"):
            error_of(check, nothing, Wave())
        if name.startswith("sample"):
            with pytest.raises(DataError, match="last sample"):
                error_of(check, short, Wave())


def test_a_place_off_the_wall_or_a_probe_that_is_not_there_is_refused(tmp_path):
    result = write(tmp_path)
    sample = checks()["sample_pressure"]
    for at, reason in (("wall:wafer@4.1e-5", "does not reach"), ("wall:pad@1e-5", "no probes/pad")):
        with pytest.raises(DataError, match=reason):
            error_of(Check(**(vars(sample) | {"at": at})), result, Wave())
    stranger = Result(result.path, END, {"probes": []})
    with pytest.raises(DataError, match="no probe sample"):
        error_of(checks()["sample_point_pressure"], stranger, Wave())


def test_peak_is_between_samples_and_not_at_an_end():
    share = np.linspace(0, 1, 51)
    assert peak(-((share - 0.473) ** 2)) == pytest.approx(0.473, abs=1e-12)
    with pytest.raises(DataError, match="end of the window"):
        peak(share)


def test_a_variant_may_have_a_scene_of_its_own():
    arc, _, sine = CASE.variants
    assert (CASE.path(arc).name, CASE.path(sine).name) == ("scene.toml", "sine.toml")
    scenes = [CASE.scene(variant) for variant in CASE.variants]
    assert [scene["walls"][0]["shape"] for scene in scenes] == ["arc", "arc", "sine"]
    for scene in scenes:
        assert scene["walls"][1:] == scenes[0]["walls"][1:]
        assert {key: scene[key] for key in ("domain", "fluid", "numerics", "output")} == {
            key: scenes[0][key] for key in ("domain", "fluid", "numerics", "output")
        }
        assert scene["probes"][0] == scenes[0]["probes"][0]
    assert CASE.path(Variant("other", {})) == CASE.scene_path


def test_figures_can_be_drawn(tmp_path):
    entries = []
    for variant in CASE.variants:
        write(tmp_path / "runs" / "wafer_feature" / "default" / variant.name / "4e-07")
        entries.append({"variant": variant.name, "scheme": "default", "spacing_m": 4e-7, "finest": True})
    data = Data(CASE, entries, tmp_path, lambda variant, name="": Wave())
    for name in CASE.figures:
        figure = FIGURES[name](data)
        figure.canvas.draw()
        assert all(axes.has_data() for axes in figure.axes if isinstance(axes, Axes))
        assert name in report.CAPTIONS
    labels = FIGURES["feature_sample"](data).axes[0].get_legend_handles_labels()[1]
    assert [label.split(":")[0] for label in labels] == ["finite elements", "SPH, spacing 0.4 µm"]
    for label in labels:
        assert float(label.split()[-2]) == pytest.approx(2.3e-5 / LENGTH, abs=0.01)
