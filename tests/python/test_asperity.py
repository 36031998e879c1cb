"""The sweeps of Fig. 13: points, fits with their uncertainty, the table of lengths, and what they refuse."""

import json

import h5py
import numpy as np
import pytest
from disc_fakes import END, check
from numpy.testing import assert_allclose

from reference import ReferenceError, rough_profile
from reference.scene import read_scene
from reference.walls import graph, uniform_numbers
from verification import asperity, asperity_figures, asperity_store, report
from verification.asperity import CASE, Point, fit_gap, fit_width, fits, length_table, of_lengths, sweep
from verification.case import ROOT, CaseError, load_case
from verification.compare import DataError
from verification.figures import Data
from verification.measure import Result
from verification.truth import error_of

CROSS = [Point(width * 1e-6, 7e-6, 100 + 3 * width) for width in (10, 2, 4, 6, 8)] + [
    Point(6e-6, gap * 1e-6, 500 * np.exp(-2 * gap / 10)) for gap in (1, 2, 3, 5, 10)
]


class Bump:
    """A wafer whose pressure maximum grows with the length of the channel and the width of the asperity."""

    kind, source, error_estimate, seconds, digest = "finite-element", "fake", 0.0, 0.0, "0"

    def __init__(self, length, width):
        self.length, self.amplitude = length, 100 * length / 4e-5 + 1e6 * width

    def wall_pressure(self, wall, x, t):
        return 7 + self.amplitude * np.cos(2 * np.pi * x / self.length)


def load(name, scene_path, overrides, cache):
    return Bump(overrides["domain.upper"][0], overrides["walls.pad.width"])


def bump_of(name, scene_path, overrides, cache):
    return Bump(4e-5, overrides["walls.pad.width"])


def write_run(path, factor, end, x):
    """A run whose wafer has `factor` times the pressure of Bump(4e-5, 6e-6), and another mean."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with h5py.File(path, "w") as file:
        probe = file.create_group("probes/wafer")
        probe["time"], probe["x"] = [0.0, end], x
        pressure = 3 + factor * Bump(4e-5, 6e-6).wall_pressure("wafer", x, end)
        probe["pressure"] = probe["shear"] = np.tile(pressure, (2, 1))
    return Result(path, end)


X = np.linspace(0, 4e-5, 160, endpoint=False)


def test_the_maximum_over_the_mean_of_a_wall_is_compared(tmp_path):
    maximum = {"at": "wall:wafer", "field": "pressure", "metric": "relative_scalar", "unit": ""}
    over = check(statistic="max", subtract_mean=True, **maximum)
    truth = Bump(4e-5, 6e-6)
    assert error_of(over, write_run(tmp_path / "a.h5", 1.0, END, X), truth) == pytest.approx(0, abs=1e-12)
    assert error_of(over, write_run(tmp_path / "b.h5", 0.9, END, X), truth) == pytest.approx(0.1)
    with pytest.raises(DataError, match="not finite"):
        error_of(over, write_run(tmp_path / "c.h5", np.nan, END, X), truth)


def test_runs_are_fitted_beside_finite_elements(tmp_path):
    case = load_case(CASE)
    entries = []
    for variant in case.variants:
        end = case.scene(variant)["output"]["end_time"]
        factor = 1.5 + 1e5 * case.scene(variant)["walls"][1]["width"]  # a constant would be no line
        write_run(tmp_path / "runs" / CASE / "default" / variant.name / "2e-07" / "result.h5", factor, end, X)
        facts = {"case": CASE, "scheme": "default", "variant": variant.name, "spacing_m": 2e-7}
        entries.append(facts | {"finest": True})
    (tmp_path / "results.json").write_text(json.dumps({"level": "paper", "cases": entries}))
    of_bump = asperity.of_runs(tmp_path, bump_of)
    assert of_bump["finite_elements"]["width"]["slope"] == pytest.approx(1)
    assert of_bump["sph"]["gap"]["values"][0]["pressure_Pa"] == pytest.approx(2.1 * 106)
    assert of_bump["sph"]["width"]["slope"] == pytest.approx(10.6)  # 0.1 of 106 Pa per um
    assert of_bump["paper"]["width"]["slope"] == 9.28
    assert (of_bump["level"], of_bump["spacing_m"]) == ("paper", 2e-7)
    table = asperity.point_table(of_bump).splitlines()
    assert table[0] == "At a spacing of 2e-07 m the points are within 140.9 % of finite elements:"
    assert len(table) == 2 + 2 + len(case.variants)
    assert "| 6 | 1 | 222.6 | 106.0 | +110.00 % |" in table


def test_the_case_is_two_sweeps_that_share_a_point():
    case = load_case(CASE)
    points = [Point(*asperity.shape(case.scene(variant)), 1.0) for variant in case.variants]
    widths = [round(p.width * 1e6) for p in sweep(points, "width")]
    gaps = [round(p.gap * 1e6) for p in sweep(points, "gap")]
    assert (widths, gaps) == ([2, 4, 6, 8, 10], [1, 2, 3, 5, 7, 10])


def test_a_line_and_an_exponential_are_found_exactly():
    found = fits(CROSS)
    assert found["width"]["slope"] == pytest.approx(3)
    assert found["width"]["intercept"] == pytest.approx(100)
    assert found["width"]["interval_95"] == pytest.approx([3, 3], abs=1e-6)
    assert found["width"]["largest_residual"] < 1e-9
    exponential = fit_gap(CROSS[5:])["exponential"]
    assert exponential["rate"] == pytest.approx(2)
    assert exponential["factor"] == pytest.approx(500)
    assert exponential["largest_residual"] < 1e-9
    assert all(local["rate"] == pytest.approx(2) for local in fit_gap(CROSS[5:])["local_rates"])


def test_the_interval_holds_the_slope_about_as_often_as_it_says():
    random = np.random.default_rng(3)
    inside = 0
    for _ in range(300):
        noisy = [Point(w * 1e-6, 7e-6, 100 + 3 * w + random.normal()) for w in (2, 4, 6, 8, 10)]
        low, high = fit_width(noisy)["interval_95"]
        inside += low < 3 < high
    assert 0.91 < inside / 300 < 0.99


def test_a_power_is_told_from_an_exponential():
    found = fit_gap([Point(6e-6, gap * 1e-6, 30 * (gap / 10) ** -1.5) for gap in (1, 2, 3, 5, 7, 10)])
    assert found["power"]["exponent"] == pytest.approx(1.5)
    assert found["power"]["largest_residual"] < 1e-9 < 0.1 < found["exponential"]["largest_residual"]
    assert found["local_rates"][0]["rate"] > 3 * found["local_rates"][-1]["rate"]


def test_too_few_points_give_a_reason_and_no_number():
    assert "three points" in fits(CROSS[:1])["gap"]["reason"]
    with pytest.raises(DataError, match="three points"):
        fit_width(CROSS[:2])


def test_lengths_change_the_channel_and_fill_the_table(tmp_path, monkeypatch):
    found = of_lengths(load)
    assert found["40 um"]["width"]["slope"] == pytest.approx(1)
    assert found["8 sigma"]["width"]["slope"] == pytest.approx(21)
    table = length_table(found)
    assert "| 10 | 7 | 210.0 | 110.0 | 210.0 |" in table
    readme = tmp_path / "README.md"
    readme.write_text("before\n" + "\n".join(asperity.MARKERS) + "\nafter\n")
    asperity.write_table(readme, table)
    asperity.write_table(readme, table)  # again, to the same
    assert readme.read_text().count("| 10 | 7 |") == 1
    assert readme.read_text().startswith("before\n") and readme.read_text().endswith("\nafter\n")
    readme.write_text("no markers")
    with pytest.raises(CaseError, match="once each"):
        asperity.write_table(readme, table)


def test_a_length_that_the_reference_refuses_is_said_and_left_out():
    def refusing(name, scene_path, overrides, cache):
        if overrides["domain.upper"][0] < 2e-5:
            raise ReferenceError("own error above 0.001")
        return load(name, scene_path, overrides, cache)

    table = length_table(of_lengths(refusing))
    assert "| 2 | 7 | refused | 102.0 | 202.0 |" in table
    assert "| 4 | 7 | 84.0 | 104.0 | 204.0 |" in table


def test_the_command_says_what_is_missing(tmp_path, capsys):
    assert asperity.main(["--out", str(tmp_path)]) == 2
    (tmp_path / "results.json").write_text(json.dumps({"level": "gate", "cases": []}))
    assert asperity.main(["--out", str(tmp_path)]) == 2
    assert f"no run of {CASE}" in capsys.readouterr().err
    assert not (tmp_path / "asperity.json").exists()


def test_every_figure_that_the_cases_name_exists():
    for name in (CASE, "rough_pad", "rough_pad_profile"):
        assert set(load_case(name).figures) <= set(report.FIGURES) & set(report.CAPTIONS)


def test_random_numbers_are_the_published_ones():
    numbers = uniform_numbers(1234567)
    published = (6457827717110365317, 3203168211198807973, 9817491932198370423)
    assert [next(numbers) for _ in range(3)] == [(value >> 11) / 2**53 for value in published]


def test_random_pad_has_its_rms_height_and_correlation():
    scene = read_scene(ROOT / "rough_pad" / "scene.toml", {"domain.upper": [4e-4, 4e-6]})
    pad = graph(scene, scene.walls[1])
    x = np.linspace(0, 4e-4, 20000, endpoint=False)
    height = pad.height(x)
    assert height.std() == pytest.approx(6e-7, rel=1e-9)
    assert np.mean(height * np.roll(height, 200)) / 36e-14 == pytest.approx(np.exp(-1), abs=0.05)
    assert_allclose(np.gradient(height, x)[1:-1], pad.slope(x)[1:-1], atol=1e-4)
    other = read_scene(scene.path, {"domain.upper": [4e-4, 4e-6], "walls.pad.seed": 2})
    assert np.abs(graph(other, other.walls[1]).height(x) - height).max() > 6e-7


def test_random_pad_refuses_what_makes_no_sense():
    for key in ("rms_height", "correlation_length"):
        scene = read_scene(ROOT / "rough_pad" / "scene.toml", {f"walls.pad.{key}": 0.0})
        with pytest.raises(ReferenceError, match="must be positive"):
            graph(scene, scene.walls[1])


def test_the_table_of_the_rough_pad_is_what_its_command_makes(tmp_path):
    scene = str(ROOT / "rough_pad" / "scene.toml")
    out = tmp_path / "pad.csv"
    assert rough_profile.main([scene, "pad", "--set", "walls.pad.seed=2", "--out", str(out)]) == 0
    kept = np.loadtxt(ROOT / "rough_pad_profile" / "pad.csv", delimiter=",")
    assert_allclose(np.loadtxt(out, delimiter=","), kept, atol=1.1e-10)
    assert rough_profile.main([scene, "roof", "--out", str(tmp_path / "no.csv")]) == 2
    assert not (tmp_path / "no.csv").exists()


def test_the_stored_finite_elements_are_at_every_point_of_both_sweeps():
    case = load_case(CASE)
    stored = asperity_store.read()
    shapes = [asperity.shape(case.scene(variant)) for variant in case.variants]
    assert_allclose([(p.width, p.gap) for p in stored], shapes, rtol=1e-5)


def test_finite_elements_are_stored_and_confirmed(tmp_path, capsys):
    path = tmp_path / "finite_elements.csv"
    assert asperity_store.main(["--to", str(path)], bump_of) == 0
    stored = asperity_store.read(path)
    assert [p.pressure for p in stored] == pytest.approx([102, 104, 106, 108, 110, *5 * [106]])
    asperity_store.confirm(stored, [Point(6e-6, 3e-6, 106.05)])
    for other in (Point(6e-6, 3e-6, 107), Point(6e-6, 4e-6, 106)):
        with pytest.raises(DataError, match="make it again"):
            asperity_store.confirm(stored, [other])
    path.write_text("width_m,gap_m\n1,2\n")
    with pytest.raises(DataError, match="needs the columns"):
        asperity_store.read(path)


@pytest.mark.parametrize(("of", "ours"), [("width", [6]), ("gap", [3, 7])])
def test_figures_of_two_runs_have_the_whole_curve_of_finite_elements(tmp_path, monkeypatch, of, ours):
    case = load_case(CASE)
    entries = []
    for name in ("sigma_06_gap_07", "sigma_06_gap_03"):
        path = tmp_path / "runs" / CASE / "default" / name / "4e-07" / "result.h5"
        write_run(path, 1.0, case.scene(case.variants[0])["output"]["end_time"], X)
        entries.append({"scheme": "default", "variant": name, "spacing_m": 4e-7, "finest": True})
    stored = [Point(p.width, p.gap, 100 + 1e6 * p.width) for p in CROSS]
    monkeypatch.setattr(asperity_store, "read", lambda: stored)
    data = Data(case, entries, tmp_path, lambda variant: Bump(4e-5, 6e-6))
    axes = asperity_figures.FIGURES[f"pressure_over_{of}"](data).axes[0]
    drawn = {line.get_label(): [round(x) for x in line.get_xdata()] for line in axes.get_lines()}
    assert drawn["finite elements"] == {"width": [2, 4, 6, 8, 10], "gap": [1, 2, 3, 5, 7, 10]}[of]
    assert sorted(drawn["SPH, spacing 4e-07 m"]) == ours
