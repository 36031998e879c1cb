"""What a check of discs is held against: it measures, it can fail, and bad data are refused with a reason."""

import h5py
import numpy as np
import pytest
from disc_fakes import END, TIMES, check, falling, fields, write

from verification import curves
from verification.compare import CheckResult, Curves, DataError
from verification.truth import error_of

NUMBERS = {"value": (-0.5,), "field": "velocity_y", "statistic": "min", "window": (0.0, END)}


class Falling:
    error_estimate = 1e-2

    def disc(self, name, quantity, t):
        assert (name, quantity) == ("disc", "position")
        return np.stack([0 * t, 1 - 0.5 * t], axis=1)


@pytest.fixture
def result(tmp_path):
    return write(tmp_path / "run", *falling())


@pytest.fixture
def published(tmp_path, monkeypatch):
    """curve.csv: low and high, 0.02 below and above 1 - t / 2, at t = 0.1, ..., 0.9; low stops at 0.8."""
    monkeypatch.setattr(curves.read, "__defaults__", (tmp_path,))
    monkeypatch.setattr(curves.within, "__defaults__", (tmp_path,))
    rows = [
        f"{t:g},{1 - t / 2 - 0.02 if t < 0.85 else ''},{1 - t / 2 + 0.02}" for t in np.linspace(0.1, 0.9, 9)
    ]
    (tmp_path / "curve.csv").write_text("# a citation, with a comma\nt_s,low,high\n" + "\n".join(rows))
    return lambda *columns, **changes: Curves("curve.csv", "t_s", columns, **changes)


def moved(tmp_path, shift):
    discs, radius = falling()
    discs["disc"]["position_y"] = discs["disc"]["position_y"] + shift
    return write(tmp_path / f"moved{shift}", discs, radius)


def test_numbers_and_statistics(result):
    assert error_of(check(**NUMBERS), result) == pytest.approx(0, abs=1e-12)
    for statistic, value, error in (
        ("max", 0.7, 0.3),
        ("min", 0.7, 0.2),
        ("mean", 0.75, 0),
        ("deviation", 0, 0.15),
    ):
        found = error_of(check(statistic=statistic, value=(value,), window=(0.0, END)), result)
        assert found == pytest.approx(error, abs=5e-3)
    assert error_of(check(value=(0.8,), time=0.5), result) == pytest.approx(0.05)
    assert error_of(check(value=(0.8,)), result) == pytest.approx(0.3)  # the end


def test_a_stated_scale_makes_the_error_relative(result):
    assert error_of(check(value=(0.0,), unit="", stated_scale=5.0), result) == pytest.approx(0.1)
    with pytest.raises(DataError, match="scale"):
        error_of(check(value=(0.0,), stated_scale=0.0), result)


def test_a_band_of_numbers_has_two_sides(tmp_path):
    result = write(tmp_path, *falling(), run={"first_contact_time": 0.5})
    contact = {"at": "run", "field": "first_contact_time", "unit": "s"}
    for band, error in (((0.4, 0.6), 0), ((0.1, 0.2), 0.3), ((0.7, 0.8), 0.2)):
        assert error_of(check(value=band, **contact), result) == pytest.approx(error)
    with pytest.raises(DataError, match="says nothing of least_gap"):
        error_of(check(value=(0.0,), at="run", field="least_gap"), result)
    for never in (-1.0, np.nan):
        bad = write(tmp_path / "bad", *falling(), run={"first_contact_time": never})
        try:
            assert error_of(check(value=(0.16, 0.174), **contact), bad) > 1
        except DataError as error:
            assert "not finite" in str(error)


def test_vectors_against_one_number(result):
    assert error_of(check(field="velocity", value=(0.0,), window=(0.0, END)), result) == pytest.approx(0.5)


def test_a_reference_of_discs_over_a_window(result, tmp_path):
    over = check(window=(0.0, END), kind="independent")
    assert error_of(over, result, Falling()) == pytest.approx(0, abs=1e-12)
    assert error_of(over, moved(tmp_path, 0.02), Falling()) == pytest.approx(0.02)
    with pytest.raises(DataError, match="own error is 0.01, above 0.001"):
        error_of(check(window=(0.0, END)), result, Falling())
    with pytest.raises(DataError, match="no reference"):
        error_of(over, result)


def test_another_variant_is_interpolated(result, tmp_path):
    discs, radius = falling()
    half = {key: values[::2] for key, values in discs["disc"].items()}
    coarse = write(tmp_path / "coarse", {"disc": half}, radius, times=TIMES[::2])
    over = check(against="coarse", window=(0.0, 0.6))
    assert error_of(over, result, None, [coarse]) == pytest.approx(0, abs=1e-12)
    assert error_of(over, moved(tmp_path, 0.03), None, [coarse]) == pytest.approx(0.03)
    with pytest.raises(DataError, match="nothing of variant coarse"):
        error_of(over, result)
    short = write(tmp_path / "short", *falling())
    short.end_time = 0.5
    with h5py.File(short.path, "a") as file:
        for key in list(file["discs"]):
            values = file[f"discs/{key}"][()]
            del file[f"discs/{key}"]
            file[f"discs/{key}"] = values[:51] if len(values) > 51 else values
    with pytest.raises(DataError, match=r"nothing before 0 s or after 0.5 s"):
        error_of(over, result, None, [short])


def test_published_curves_and_the_band_between_them(result, tmp_path, published):
    one = check(data=published("high"), window=(0.1, 0.9))
    assert error_of(one, result) == pytest.approx(0.02)
    band = check(data=published("low", "high"), window=(0.1, 0.8))
    assert error_of(band, result) == pytest.approx(0, abs=1e-12)
    for shift, error in ((0.05, 0.03), (-0.05, 0.03)):
        assert error_of(band, moved(tmp_path, shift), None) == pytest.approx(error)
    downwards = check(data=published("high", offset=1.0, factor=-1.0), window=(0.1, 0.1))
    assert error_of(downwards, result) == pytest.approx(0.95 - 0.03)


@pytest.mark.parametrize(
    ("columns", "window", "reason"),
    [
        (("low",), (0.1, 0.9), "not finite"),
        (("high",), (0.1, 1.2), "does not reach"),
        (("high",), (-0.5, 0.9), "does not reach"),
        (("middle",), (0.1, 0.9), "no column 'middle'"),
    ],
)
def test_short_and_missing_curves_fail(result, published, columns, window, reason):
    with pytest.raises(DataError, match=reason):
        error_of(check(data=published(*columns), window=window), result)


def test_damaged_curves_fail(tmp_path):
    for text in ("", "t_s,low\n0.1,x\n", "t_s,low\n0.2,1\n0.1,1\n", "t_s,low\n,1\n"):
        (tmp_path / "bad.csv").write_text(text)
        with pytest.raises(DataError, match=r"bad\.csv"):
            curves.within(Curves("bad.csv", "t_s", ("low",)), (0.1, 0.2), tmp_path)
    with pytest.raises(DataError, match="cannot be read"):
        curves.read(Curves("none.csv", "t_s", ("low",)), tmp_path)


def test_the_envelope_of_all_variants(result, tmp_path, published):
    envelope = check(data=published("low", "high"), against="*", window=(0.1, 0.8))
    members = [moved(tmp_path, shift) for shift in (-0.05, 0.0, 0.05)]
    assert error_of(envelope, result, None, members) == pytest.approx(0, abs=1e-12)
    assert error_of(envelope, result, None, members[1:]) == pytest.approx(0.02)
    with pytest.raises(DataError, match="nothing of variant"):
        error_of(envelope, result)


def test_conserved_quantities_are_held_step_by_step(tmp_path):
    steady = np.full_like(TIMES, 3.0)
    kept = check(at="derived", field="momentum", conserved=True, metric="largest_deviation", unit="")
    discs, radius = falling()
    assert error_of(kept, write(tmp_path, discs, radius, series={"momentum_x": steady})) == 0
    kicked = steady + 0.03 * (TIMES > 0.5)
    assert error_of(kept, write(tmp_path, discs, radius, series={"momentum_x": kicked})) == pytest.approx(
        0.03 / 3.03
    )
    # What one gives the other takes: a kick of the disc (mass 2) that the fluid feels as well.
    discs["disc"]["velocity_x"] = -0.015 * (TIMES > 0.5)
    given = write(tmp_path, discs, radius, series={"momentum_x": kicked})
    assert error_of(kept, given) == pytest.approx(0, abs=1e-14)
    with pytest.raises(DataError, match="101 samples of 200 steps"):
        error_of(kept, write(tmp_path, discs, radius, run={"steps": 200}))


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"at": "disc:other"}, "no disc other, only disc"),
        ({"field": "colour"}, "no discs/colour_x"),
        ({"at": "derived", "field": "colour"}, "nothing derived is called colour"),
        ({"at": "series", "field": "colour"}, "no series/colour"),
        ({"window": (0.0, 2.0), "statistic": "min"}, "does not reach from 0 s to 2 s"),
        ({"window": (0.5, 0.501), "statistic": "min"}, "1 samples from 0.5 s"),
        ({"time": 0.0551}, "no sample at 0.0551 s"),
    ],
)
def test_what_is_not_there_is_refused(result, changes, reason):
    with pytest.raises(DataError, match=reason):
        error_of(check(**({"value": (0.5,)} | changes)), result)


def test_damaged_discs_are_refused(tmp_path):
    discs, radius = falling()
    nan = {"disc": discs["disc"] | {"position_y": np.where(TIMES == 0.5, np.nan, 1.0)}}
    with pytest.raises(DataError, match="position_y of disc disc holds 1 values"):
        error_of(check(value=(0.5,), time=0.2), write(tmp_path, nan, radius))
    with pytest.raises(DataError, match="do not increase"):
        error_of(check(value=(0.5,)), write(tmp_path, discs, radius, times=TIMES[::-1]))
    short = {"disc": {key: values[:90] for key, values in discs["disc"].items()}}
    with pytest.raises(DataError, match="the last sample of disc disc is at 0.89 s"):
        error_of(check(value=(0.5,)), write(tmp_path, short, radius, times=TIMES[:90]))
    result = write(tmp_path, discs, radius)
    with h5py.File(result.path, "a") as file:
        del file["discs"]
    with pytest.raises(DataError, match="the result has no discs"):
        error_of(check(value=(0.5,)), result)


def test_a_reported_check_decides_nothing_but_must_have_a_number():
    inside, outside = (CheckResult(check(reported=True), value, 0.01) for value in (0.0, 0.02))
    assert inside.reported
    assert outside.reported
    assert not outside.passed
    assert not CheckResult(check(reported=True), np.nan, 0.01).reported
    assert not CheckResult(check(reported=True), 0.0, 0.01, reason="no run").reported
    assert not CheckResult(check(), 0.0, 0.01).reported


def test_two_discs_at_once(tmp_path):
    discs = falling("first")[0] | {"second": fields(np.tile([0.6, 0.9], (len(TIMES), 1)))}
    result = write(tmp_path, discs)
    assert error_of(check(at="disc:second", value=(0.9,)), result) == pytest.approx(0)
    assert error_of(check(at="disc:first", value=(0.9,)), result) == pytest.approx(0.4)
