"""The checks of the single abrasive see a disc that is not there, or late, and a shear of another size."""

import dataclasses
import math

import h5py
import numpy as np
import pytest
from disc_fakes import fields, write

from reference import load
from verification.case import load_case
from verification.compare import CheckResult, DataError
from verification.derived import DERIVED
from verification.measure import Result
from verification.truth import error_of

CASE = load_case("single_abrasive")
VARIANT = CASE.variants[0]
SCENE = CASE.scene(VARIANT)
END = SCENE["output"]["end_time"]
TIMES = np.linspace(0, END, 161)
ALONG = np.linspace(1e-7, 3.99e-5, 200)


@pytest.fixture(scope="module")
def truth(tmp_path_factory):
    return load(CASE.reference, CASE.scene_path, {}, tmp_path_factory.mktemp("cache"))


def run_of(folder, truth, shear=None, delay=0.0):
    """A run whose wafer shear has `shear` (n,) as its greatest, in one place, negative as a wafer's is."""
    if shear is None:
        shear = np.array([truth.greatest_wafer_shear(t) for t in TIMES])
    shear = np.where(np.isfinite(shear), shear, 600.0)
    place = truth.disc("abrasive", "position", np.maximum(TIMES - delay, 0))
    result = write(folder, {"abrasive": fields(place)}, times=TIMES)
    with h5py.File(result.path, "a") as file:
        group = file.create_group("probes/wafer")
        group["time"], group["x"] = TIMES, ALONG
        group["pressure"] = np.zeros((len(TIMES), len(ALONG)))
        group["shear"] = -np.outer(shear, 0.2 + 0.8 * (np.arange(len(ALONG)) == 70))
    return Result(result.path, END, SCENE)


def judged(result, truth):
    """For each check of the gate, whether its error is within its tolerance."""
    found = {}
    for check in CASE.checks("default", "gate", VARIANT.name):
        value = error_of(check, result, truth)
        found[check.quantity] = CheckResult(check, value, check.tolerance).passed
    return found


def test_the_references_own_passage_passes(tmp_path, truth):
    assert all(judged(run_of(tmp_path, truth), truth).values())


def test_a_shear_without_a_disc_is_seen(tmp_path, truth):
    still = np.full(len(TIMES), truth.greatest_wafer_shear(END))
    assert not judged(run_of(tmp_path, truth, still), truth)["shear_over_time"]


def test_a_shear_of_another_size_is_seen(tmp_path, truth):
    values = np.array([truth.greatest_wafer_shear(t) for t in TIMES])
    assert not judged(run_of(tmp_path, truth, 1.12 * values), truth)["greatest_shear"]


def test_a_late_disc_is_seen(tmp_path, truth):
    assert not judged(run_of(tmp_path, truth, delay=5e-6), truth)["disc_place"]


def test_a_shear_that_is_not_a_number_gives_no_number(tmp_path, truth):
    result = run_of(tmp_path, truth)
    with h5py.File(result.path, "a") as file:
        file["probes/wafer/shear"][80, 10] = math.nan
    with pytest.raises(DataError, match="not finite"):
        DERIVED["greatest_wafer_shear"](result)
    check = CASE.checks("default", "gate", VARIANT.name)[0]
    assert not dataclasses.replace(CheckResult(check, math.nan, 0.1)).reported
