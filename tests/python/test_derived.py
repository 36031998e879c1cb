"""Quantities derived from a result with discs, against what is known by construction."""

import math

import h5py
import numpy as np
import pytest
from disc_fakes import END, TIMES, fields, write

from verification.compare import DataError
from verification.derived import DERIVED
from verification.phases import PHASES, phases

ARRAY = {
    "domain": {"lower": [0.0, 0.0], "upper": [2.0, 2.0], "periodic": "xy"},
    "fluid": {"density": 10.0, "dynamic_viscosity": 0.5, "body_force": [3.0, 0.0]},
}


def pair(apart, angle=0.0):
    """Leading and trailing disc, `apart` (n,) between the centres, their line turned by `angle` (n,)."""
    line = np.stack([np.sin(angle) * apart, np.cos(angle) * apart], axis=1)
    middle = np.stack([0.5 + 0 * TIMES, 1 - 0.4 * TIMES], axis=1)
    return {"leading": fields(middle - line / 2), "trailing": fields(middle + line / 2)}


def tumble():
    """Gap of 0.4 diameters closed by t = 0.4, the line turned by 90 degrees by 0.7, apart again after."""
    apart = 0.2 * np.interp(TIMES, [0, 0.4, 0.7, 1.0], [1.4, 1.0, 1.0, 1.5])
    return apart, np.interp(TIMES, [0, 0.4, 0.7, 1.0], [0, 0, math.pi / 2, math.pi / 2])


def test_gap(tmp_path):
    apart, angle = tumble()
    times, gap = DERIVED["gap"](write(tmp_path, pair(apart, angle)))
    np.testing.assert_allclose(gap, apart - 0.2, atol=1e-12)
    assert times[-1] == END
    with pytest.raises(DataError, match="a pair is two discs, not 1"):
        DERIVED["gap"](write(tmp_path, {"disc": fields(np.zeros((len(TIMES), 2)))}))


def test_phases_in_order(tmp_path):
    apart, angle = tumble()
    discs = pair(apart, angle)
    places = [np.stack([d["position_x"], d["position_y"]], axis=1) for d in discs.values()]
    found = phases(TIMES, *places, diameter=0.2)
    assert tuple(found) == PHASES
    assert found["drafting"] == pytest.approx(0.2, abs=0.011)
    assert found["kissing"] == pytest.approx(0.3, abs=0.011)
    assert found["tumbling"] == pytest.approx(0.55, abs=0.011)
    assert found["separation"] == pytest.approx(0.82, abs=0.011)
    assert DERIVED["phases_missing"](write(tmp_path, discs))[1] == [0.0]


@pytest.mark.parametrize(
    ("apart", "turned", "missing"),
    [
        ([1.4, 1.4, 1.4, 1.4], False, 4.0),  # they fall side by side for ever
        ([1.4, 1.15, 1.15, 1.5], True, 3.0),  # drafting, no kiss
        ([1.4, 1.0, 1.0, 1.5], False, 2.0),  # kissing and parting without tumbling
        ([1.4, 1.0, 1.0, 1.0], True, 1.0),  # they stay together
    ],
)
def test_phases_that_do_not_come_are_counted(tmp_path, apart, turned, missing):
    angle = tumble()[1] * turned
    discs = pair(0.2 * np.interp(TIMES, [0, 0.4, 0.7, 1.0], apart), angle)
    assert DERIVED["phases_missing"](write(tmp_path, discs))[1] == [missing]


def test_drag_of_an_array(tmp_path):
    discs = {"disc": fields(np.ones((len(TIMES), 2)), force_x=30.0 * (4 - math.pi * 0.01))}
    flow = 80.0 * TIMES  # to U = 2 m/s in a cell of 4 m2
    result = write(tmp_path, discs, series={"momentum_x": flow}, scene=ARRAY)
    drag = DERIVED["array_drag"](result)[1]
    assert drag[0] == 0
    assert drag[-1] == pytest.approx(30 * 4 / (0.5 * 2))
    assert DERIVED["array_balance"](result)[1] == pytest.approx(1)
    for axis, name in (("x", "array_drag"), ("none", "array_balance")):
        other = ARRAY | {"domain": ARRAY["domain"] | {"periodic": axis}}
        with pytest.raises(DataError, match="an array is one disc"):
            DERIVED[name](write(tmp_path, discs, scene=other))


def test_momentum_needs_common_times(tmp_path):
    result = write(tmp_path, pair(0.5 + 0 * TIMES), mass=3.0, series={"momentum_y": 1 + TIMES})
    np.testing.assert_allclose(DERIVED["momentum"](result)[1], np.stack([0 * TIMES, 1 + TIMES], axis=1))
    with h5py.File(result.path, "a") as file:
        file["discs/time"][:] = np.linspace(0, 0.9999, len(TIMES))
    with pytest.raises(DataError, match="not sampled at the same times"):
        DERIVED["momentum"](result)
