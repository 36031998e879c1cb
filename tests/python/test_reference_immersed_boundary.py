"""The immersed-boundary reference: against published numbers, its convergence, stored files, refusals."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import reference
from reference import ReferenceError, immersed_boundary, immersed_boundary_run
from reference.extrapolation import extrapolated
from reference.immersed_boundary import DATA, SHARES
from reference.immersed_boundary_discs import Disc
from reference.immersed_boundary_run import Problem, run
from reference.immersed_boundary_store import read_stored, write_stored

BOX = """
[domain]
lower = [{left}, 0.0]
upper = [{right}, 0.06]
[fluid]
density = 1000.0
dynamic_viscosity = {viscosity}
gravity = [0.0, -9.81]
{walls}[output]
end_time = {end}
"""
WALL = '[[walls]]\nname = "{}"\nshape = "line"\nfrom = [{}, {}]\nto = [{}, {}]\nfluid_side = "{}"\n'
DISC = '[[discs]]\nname = "{}"\nplacement = "single"\nradius = 1.25e-3\nposition = [{}, {}]\ndensity = {}\n'


def box_of(left, right, viscosity, end):
    walls = (
        WALL.format("left", left, 0.0, left, 0.06, "right"),
        WALL.format("right", right, 0.06, right, 0.0, "left"),
        WALL.format("bottom", left, 0.0, right, 0.0, "above"),
        WALL.format("top", left, 0.06, right, 0.06, "below"),
    )
    return BOX.format(left=left, right=right, viscosity=viscosity, walls="".join(walls), end=end)


def settling(left=0.0, end=0.65):
    box = box_of(left, left + 0.02, 0.01, end)
    return box + DISC.format("ball", left + 0.01, 0.04, 1250.0)


def pair():
    box = box_of(0.0, 0.02, 1e-3, 0.3)
    return (
        box + DISC.format("trailing", 0.01001, 0.05, 1500.0) + DISC.format("leading", 0.00999, 0.045, 1500.0)
    )


def load(folder, text, overrides=None):
    file = folder / "scene.toml"
    file.write_text(text)
    return reference.load("immersed_boundary", file, overrides or {}, folder / "cache")


def test_settling_converges_to_the_published_speed(tmp_path):
    disc = load(tmp_path, settling())
    t = np.linspace(0, 0.65, 66)
    speed = -disc.disc("ball", "velocity_y", t)
    assert disc.until == 0.65
    assert speed.max() == pytest.approx(0.0557, rel=0.01)
    assert 0 < disc.error_estimate < 0.005
    assert_allclose(np.gradient(disc.disc("ball", "position", t)[:, 1], t)[1:-1], -speed[1:-1], atol=5e-4)
    shifted = load(tmp_path, settling(left=-0.01))
    offset = shifted.disc("ball", "position", t) - disc.disc("ball", "position", t)
    assert_allclose(offset, np.tile([-0.01, 0.0], (len(t), 1)), atol=1e-12)


def test_pair_lies_in_the_published_band_before_contact(tmp_path):
    """Depths at 0.10 and 0.14 s from glowinski2001, uhlmann2005 and koblitz2017, and 3e-4 m beside them."""
    discs = load(tmp_path, pair())
    bands = {"leading": [(0.022308, 0.022414), (0.026978, 0.027439)],
             "trailing": [(0.017177, 0.017371), (0.022967, 0.023295)]}  # fmt: skip
    for name, band in bands.items():
        depth = 0.06 - discs.disc(name, "position_y", np.array([0.10, 0.14]))
        for value, (low, high) in zip(depth, band, strict=True):
            assert low - 3e-4 < value < high + 3e-4
    assert 0.15 < discs.until < discs.touched[-1] < 0.2
    assert np.isnan(discs.disc("leading", "position", np.array([discs.until + 1e-3]))).all()
    assert np.isfinite(discs.finest("leading", "position", np.array([discs.until + 1e-3]))).all()


@pytest.mark.parametrize("name", ["disc_settling", "disc_pair"])
def test_coarsest_stored_grid_is_found_again(tmp_path, name):
    """Over the first 15 % of the time; as a shorter run has slightly other steps, not to rounding."""
    stored = read_stored(DATA / f"immersed_boundary_{name}.csv")
    found = load(tmp_path, settling() if name == "disc_settling" else pair())
    assert found.digest == stored.digest
    times = stored.arrays["times"][:31]
    states, _ = run(found.problem, found.problem.grid(SHARES[0]), times)
    expected = stored.arrays["states"][0][:31]
    assert np.abs(expected[-1, :, 1] - expected[0, :, 1]).min() > 5e-4
    assert_allclose(states[..., :2], expected[..., :2], rtol=0, atol=1e-7)
    assert_allclose(states[..., 3:5], expected[..., 3:5], rtol=0, atol=1e-5)


@pytest.fixture
def coarse(monkeypatch):
    monkeypatch.setattr(immersed_boundary_run, "FINEST_CELLS", 8)
    monkeypatch.setattr(immersed_boundary_run, "LAYER_CELLS", 0.1)


def test_other_scenes_are_computed_and_kept(tmp_path, coarse):
    text = settling(end=0.02).replace("0.01\ngravity", "0.02\ngravity")
    first = load(tmp_path, text)
    assert first.seconds > 0
    assert -0.015 < first.disc("ball", "velocity_y", np.array([0.02]))[0] < -0.01
    assert len(first.error_table().splitlines()) == 3 + len(SHARES)
    again = load(tmp_path, text)
    assert again.digest == first.digest
    assert (again.states == first.states).all()
    assert load(tmp_path, text, {"output.end_time": 0.01}).digest != first.digest


def test_discs_close_to_walls_from_the_start_are_refused(tmp_path, coarse):
    with pytest.raises(ReferenceError, match="from the start"):
        load(tmp_path, settling(end=0.002), {"discs.ball.position": [0.01, 0.0015]})


@pytest.mark.parametrize("order", [1.3, 2.0])
def test_order_and_error_are_those_of_the_grids(order):
    spacings = 1 / np.array(SHARES)
    found = extrapolated(1 + 0.01 * spacings**order, spacings)
    assert found[0].item() == pytest.approx(1)
    assert found[1:] == (pytest.approx(order), pytest.approx(0.01))


def test_stored_file_comes_back_and_its_changes_are_seen(tmp_path):
    disc = Disc(1e-3, 1500.0, (0.01, 0.012))
    problem = Problem((0.02, 0.03), (False, True), 1000.0, 1e-6, (0.0, -9.81), (disc,))
    arrays = {
        "times": np.linspace(0, 1, 4),
        "states": np.random.default_rng(3).normal(size=(3, 4, 1, 6)),
        "cells": np.array([[1, 2], [2, 4], [4, 8]]),
        "touched": np.array([1.0, 2.0, 2.0]),
        "seconds": np.array(7.0),
    }
    file = tmp_path / "stored.csv"
    write_stored(file, problem, arrays)
    stored = read_stored(file)
    assert stored.identity == problem.identity()
    for key, array in arrays.items():
        assert_allclose(stored.arrays[key], array, rtol=1e-8)
    for old, new in ((",0.333", ",0.334"), ("sha256", "sha1"), ("grid,", "grids,")):
        file.write_text(file.read_text().replace(old, new, 1))
        with pytest.raises(ReferenceError, match="make it again"):
            read_stored(file)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        ({"walls.top.velocity": [1.0, 0.0]}, "at rest"),
        ({"walls.top.from": [0.01, 0.06]}, "whole sides"),
        ({"domain.periodic": "x"}, "whole sides"),
        ({"fluid.body_force": [1.0, 0.0]}, "body force"),
        ({"fluid.gravity": [0.0, 0.0]}, "nothing moves"),
        ({"start.arrangement": "empty"}, "fluid"),
        ({"discs": []}, "discs"),
        ({"walls": []}, "4 side"),
        ({"output.end_time": 0.0}, "end_time"),
    ],
)
def test_scenes_out_of_reach_are_refused(tmp_path, overrides, message):
    with pytest.raises(ReferenceError, match=message):
        load(tmp_path, settling(), overrides)


def test_unknown_quantity_is_refused(tmp_path):
    ball = load(tmp_path, settling())
    for name, quantity in (("ball", "force_x"), ("wall", "spin")):
        with pytest.raises(ReferenceError, match=f"not {quantity} of {name}"):
            ball.disc(name, quantity, np.zeros(1))
    assert immersed_boundary.QUANTITIES.keys() >= {"position_x", "velocity_y", "angle", "spin"}
