"""What counts as active, on peaks whose active share is known by construction."""

import dataclasses

import h5py
import numpy as np
import pytest

from verification import active_shear
from verification.active_shear import (
    SETTLING,
    Peaks,
    Rule,
    collect,
    read,
    read_run,
    spacing_of,
    write,
)
from verification.compare import DataError

STEP = 8e-7
TIMES = STEP * np.arange(1, 151)
WINDOW = TIMES > SETTLING * 1.000001
RULE = Rule(threshold=287.0)


def peaks(values, count=4, seed=1):
    peak = np.broadcast_to(np.asarray(values, dtype=float), TIMES.shape)
    return Peaks(count, seed, TIMES, peak, np.full(len(TIMES), 2e-5))


def free(noise=0.4, seed=7):
    return peaks(287 + noise * np.random.default_rng(seed).standard_normal(len(TIMES)), 0, 0)


def test_threshold_is_the_mean_after_settling():
    values = np.where(WINDOW, 287.0, 3000.0)
    assert Rule.of(peaks(values, 0, 0)).threshold == 287.0


def test_an_abrasive_free_run_is_never_active():
    assert Rule.of(free()).frequency(free(seed=8)) == 0


def test_noise_that_does_not_fit_into_the_band_is_refused():
    with pytest.raises(DataError, match="within the noise"):
        Rule.of(free(noise=2.0))
    with pytest.raises(DataError, match="within the noise"):
        Rule.of(free(), band=1e-3)


def test_a_value_that_is_not_a_number_is_no_noise():
    values = free().peak.copy()
    values[100] = np.nan
    with pytest.raises(DataError):
        Rule.of(peaks(values, 0, 0))


def test_frequency_is_the_share_of_active_time():
    passage = (TIMES > 6e-5) & (TIMES < 8e-5)
    share = np.count_nonzero(passage) / np.count_nonzero(WINDOW)
    assert RULE.frequency(peaks(np.where(passage, 340, 287))) == pytest.approx(share, rel=1e-12)


def test_noise_does_not_change_the_frequency():
    passage = (TIMES > 6e-5) & (TIMES < 8e-5)
    noise = 0.4 * np.random.default_rng(3).standard_normal(len(TIMES))
    clean = RULE.frequency(peaks(np.where(passage, 340, 287)))
    assert RULE.frequency(peaks(np.where(passage, 340, 287) + noise)) == clean


def test_a_single_sample_is_too_short():
    values = np.full(len(TIMES), 287.0)
    values[100] = 340
    assert RULE.frequency(peaks(values)) == 0
    assert dataclasses.replace(RULE, least_duration=0).frequency(peaks(values)) > 0


def test_a_stretch_cut_off_by_the_end_counts():
    values = np.full(len(TIMES), 287.0)
    values[-1] = 340
    assert RULE.frequency(peaks(values)) == pytest.approx(1 / np.count_nonzero(WINDOW))


def test_settling_does_not_count():
    assert RULE.frequency(peaks(np.where(WINDOW, 287, 3000))) == 0


def test_peaks_survive_the_file(tmp_path):
    path = tmp_path / "ensemble.csv"
    write(path, [free(), peaks(340)], 2.5e-7, "a command")
    runs = read(path)
    assert [(run.count, run.seed) for run in runs] == [(0, 0), (4, 1)]
    np.testing.assert_allclose(runs[1].peak, 340)
    np.testing.assert_allclose(runs[1].place, 2e-5)
    np.testing.assert_allclose(runs[0].times, TIMES, rtol=1e-5)
    assert "a command" in path.read_text()
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("line", ["4,1,peak,340", "4,1,peak" + ",nan" * 150, "4,x,peak" + ",1" * 150])
def test_a_damaged_file_is_refused(tmp_path, line):
    path = tmp_path / "ensemble.csv"
    write(path, [free()], 2.5e-7, "a command")
    path.write_text(path.read_text() + line + "\n" + "4,1,place" + ",20" * 150 + "\n")
    with pytest.raises(DataError):
        read(path)


def test_a_file_without_the_abrasive_free_run_is_refused(tmp_path):
    path = tmp_path / "ensemble.csv"
    write(path, [peaks(340)], 2.5e-7, "a command")
    with pytest.raises(DataError, match="abrasive-free"):
        read(path)


def test_the_peak_is_the_largest_magnitude_along_the_wafer(tmp_path):
    path = tmp_path / "result.h5"
    shear = np.zeros((2, 5))
    shear[:, 2] = -300
    with h5py.File(path, "w") as file:
        file["probes/wafer/time"], file["probes/wafer/x"] = [1.0, 2.0], np.arange(5.0)
        file["probes/wafer/pressure"], file["probes/wafer/shear"] = np.zeros((2, 5)), shear
    scene = {"walls": [{"name": "wafer", "velocity": [-1.0, 0.0]}], "domain": {"upper": [4.0, 1.0]}}
    run = read_run(path, 4, 1, scene)
    assert run.peak.tolist() == [300, 300]
    assert run.place.tolist() == [1, 0]  # x = 2 of the wafer, after 1 s and 2 s at -1 m/s
    with h5py.File(path, "a") as file:
        file["probes/wafer/shear"][1, 4] = np.nan
    with pytest.raises(DataError, match="not finite"):
        read_run(path, 4, 1, scene)


def test_no_abrasive_free_run_no_threshold(tmp_path):
    with pytest.raises(DataError, match="no probe"):
        collect(tmp_path, 2.5e-7, "gate")


def test_members_of_another_level_that_lie_about_are_left_out(tmp_path, monkeypatch):
    def made(path, count, seed, scene):
        return Peaks(count, seed, TIMES, np.full(150, 287.0), np.zeros(150))

    monkeypatch.setattr(active_shear, "read_run", made)
    for seed in range(1, 9):
        path = tmp_path / f"runs/abrasives/default/count_04_seed_{seed}/2e-07/result.h5"
        path.parent.mkdir(parents=True)
        path.touch()
    seeds = {level: [run.seed for run in collect(tmp_path, 2e-7, level)] for level in ("gate", "paper")}
    assert seeds == {"gate": [0, 1, 2, 3, 4], "paper": [0, 1, 2, 3, 4, 5, 6, 7, 8]}


def test_the_file_says_its_spacing(tmp_path):
    path = tmp_path / "ensemble.csv"
    write(path, [free()], 2.5e-7, "a command")
    assert spacing_of(path) == 2.5e-7
    path.write_text(path.read_text().replace("particle spacing", "spacing"))
    with pytest.raises(DataError, match="no line says"):
        spacing_of(path)
