"""Planted faults (design.md section 8) in a stored reference: truncated, of another geometry, with a NaN."""

import json
import sys

import numpy as np
import pytest
from verification_fakes import FakeReference, FakeSolver

from reference.base import read_arrays, write_arrays
from verification import execute, run

GEOMETRY = {"amplitude": -5e-6}


def truncate(file):
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


def other_geometry(file):
    write_arrays(file, "digest", {"amplitude": -4e-6}, {"pressure": np.ones(50)})


def with_nan(file):
    write_arrays(file, "digest", GEOMETRY, {"pressure": np.full(50, np.nan)})


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (truncate, "not a whole HDF5 file"),
        (other_geometry, "belongs to another geometry"),
        (with_nan, "values that are not finite"),
    ],
)
def test_a_bad_stored_reference_fails_every_check_that_needs_it(tmp_path, monkeypatch, damage, reason):
    stored = tmp_path / "channel.h5"
    write_arrays(stored, "digest", GEOMETRY, {"pressure": np.ones(50)})

    def load(name, scene_path, overrides, cache):
        read_arrays(stored, "digest", GEOMETRY)
        return FakeReference()

    monkeypatch.setattr(execute, "call", FakeSolver().call)
    arguments = ["--solver", sys.executable, "--out", str(tmp_path), "--no-report", "--no-baseline"]
    arguments += ["--case", "rough_channel", "--scheme", "default", "--spacings", "2.5e-7"]
    assert run.main(arguments, load) == 0
    damage(stored)
    assert run.main(arguments, load) == 1
    cases = json.loads((tmp_path / "results.json").read_text())["cases"]
    checks = [check for case in cases for check in case["checks"] if check["kind"] == "finite-element"]
    assert len(checks) == 8
    assert all(not check["passed"] and reason in check["reason"] for check in checks)
