"""Intervals and models on ensembles drawn from a known law: the law must be found again."""

import json
import math

import numpy as np
import pytest

from verification import abrasive_report
from verification.abrasive_page import page
from verification.abrasive_report import report, tables
from verification.abrasive_statistics import (
    MODELS,
    exponent,
    fit,
    interval,
    log_likelihood,
    memory,
    ranked,
    slope,
    weight_percent,
)
from verification.active_shear import CASE, Peaks, Rule, write
from verification.case import load_case

WEIGHT = np.repeat([1.07, 1.87, 2.94, 3.75, 5.08, 5.89, 6.69, 7.49], 40)
LOOKS = 10


def drawn(mean, correlation=0.1, seed=5):
    """F_tau of members whose probability of being active differs about `mean` (n,)."""
    generator = np.random.default_rng(seed)
    size = 1 / correlation - 1
    return generator.binomial(LOOKS, generator.beta(mean * size, (1 - mean) * size)) / LOOKS


def test_concentrations_are_those_of_table_1():
    scene = load_case(CASE).scene()
    published = {4: 1.07, 7: 1.87, 11: 2.94, 14: 3.75, 19: 5.08, 22: 5.89, 25: 6.69, 28: 7.49}
    for count, percent in published.items():
        assert weight_percent(count, scene) == pytest.approx(percent, abs=0.006)


def test_interval_covers_the_mean_as_often_as_it_says():
    generator = np.random.default_rng(1)
    inside = [
        low <= 0.3 <= high for low, high in (interval(generator.normal(0.3, 0.1, 30)) for _ in range(200))
    ]
    assert 0.88 < np.mean(inside) < 0.99


def test_two_members_have_no_interval():
    assert interval(np.array([0.1, 0.2])) is None


def test_a_slope_of_single_members_has_no_interval():
    weight = np.array([1.0, 2.0, 3.0])
    assert slope(weight, 0.1 * weight) == pytest.approx((0.1,))
    best, low, high = slope(np.repeat(weight, 3), 0.1 * np.repeat(weight, 3) + np.tile([-0.01, 0, 0.01], 3))
    assert low < best < high


def test_likelihood_is_a_distribution():
    active = np.arange(LOOKS + 1.0)
    total = sum(math.exp(log_likelihood(np.array([0.3]), 0.2, np.array([k]), LOOKS)) for k in active)
    assert total == pytest.approx(1, rel=1e-9)


@pytest.mark.parametrize("name", ["cube root", "linear", "1 - exp(-lambda n)"])
def test_the_law_that_made_the_data_is_preferred(name):
    parameter = {"cube root": 0.35, "linear": 0.12, "1 - exp(-lambda n)": 0.3}[name]
    frequency = drawn(MODELS[name][0](WEIGHT, [parameter]))
    one = [
        f
        for f in ranked(WEIGHT, frequency, LOOKS)
        if f["model"] in ("cube root", "linear", "1 - exp(-lambda n)")
    ]
    assert one[0]["model"] == name
    assert one[0]["parameters"][0] == pytest.approx(parameter, rel=0.1)


def test_exponent_of_a_cube_root():
    b, low, high = exponent(WEIGHT, drawn(0.35 * np.cbrt(WEIGHT)), LOOKS)
    assert low < 1 / 3 < high
    assert low < b < high
    assert high < 1


def test_exponent_of_a_line_is_no_cube_root():
    _, low, _ = exponent(WEIGHT, drawn(0.12 * WEIGHT), LOOKS)
    assert low > 1 / 3


def test_more_parameters_cost():
    frequency = drawn(0.12 * WEIGHT)
    line, power = (fit(name, WEIGHT, frequency, LOOKS) for name in ("linear", "power"))
    assert power["log_likelihood"] >= line["log_likelihood"] - 1e-3
    assert power["bic"] > line["bic"]


def test_memory_of_a_square_wave():
    times = np.arange(1, 2001) * 1e-6
    states = np.repeat(np.random.default_rng(2).random(200) < 0.5, 10)  # uncorrelated after 10 samples
    run = Peaks(4, 1, times, np.where(states, 2.0, 1.0), np.zeros(len(times)))
    assert memory([run], Rule(1.0, 0.5, 0.0, 0.0)) == pytest.approx(1e-5, rel=0.35)


def ensemble(frequency_of, members=4):
    """Runs of passages at random times; the share of active time scatters about frequency_of(count)."""
    generator = np.random.default_rng(9)
    times = 8e-7 * np.arange(1, 151)
    place = np.full(150, 2.75e-5)  # 1.5 sigma beside the asperity
    yield Peaks(0, 0, times, 287 + 0.3 * generator.standard_normal(150), place)
    for count in (4, 7, 11, 14, 19, 22, 25, 28):
        for seed in range(1, members + 1):
            on = np.repeat(generator.random(15) < frequency_of(count), 10)
            peak = np.where(on, 330, 287) + 0.3 * generator.standard_normal(150)
            yield Peaks(count, seed, times, peak, place)


def test_report_of_a_saturating_ensemble(tmp_path, monkeypatch):
    monkeypatch.setattr(abrasive_report, "BANDS", (0.0, 0.01, 0.2))
    path = tmp_path / "ensemble.csv"
    write(path, ensemble(lambda count: -math.expm1(-0.08 * count)), 2.5e-7, "a command")
    found = report(path, [path])
    assert found["result"]["rise"]["p"] < 0.01
    assert [row["count"] for row in found["result"]["rows"]] == [0, 4, 7, 11, 14, 19, 22, 25, 28]
    assert found["result"]["rows"][0]["mean"] == 0
    assert list(found["places"].values()) == [0, 1, 0]
    assert found["spacings"]["ensemble"]["largest_difference"] == 0
    assert "1 - exp(-lambda n)" in tables(found)
    by_band = {row["band"]: row for row in found["bands"]}
    assert [row["within_noise"] for row in by_band.values()] == [True, False, False]
    assert by_band[0.01]["result"]["rise"] == found["result"]["rise"]
    assert "result" not in by_band[0.2]  # the passages' 330 Pa are not above it
    assert page(json.loads(json.dumps(found))) == page(found)
    rows = [line.split(" | ") for line in page(found).splitlines()]
    assert [row[0] for row in rows if row[0].endswith(("%", "noise"))] == [
        "| 0 %, within the noise",
        "| 1 %",
        "| 20 %",
    ]
    assert ["finer less coarser", "0.00 (0.00 to 0.00) |"] in [row[-2:] for row in rows]
    assert sum(row[0] in ("| 4", "| 28") and row[-2] == row[-1].rstrip(" |") for row in rows) == 2


def test_report_of_an_ensemble_that_does_not_rise(tmp_path, monkeypatch):
    monkeypatch.setattr(abrasive_report, "BANDS", (0.01,))
    path = tmp_path / "ensemble.csv"
    write(path, ensemble(lambda count: 0.5), 2.5e-7, "a command")
    assert report(path, [])["result"]["rise"]["p"] > 0.01
