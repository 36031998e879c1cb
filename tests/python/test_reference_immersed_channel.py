"""The disc in a channel with an immersed wall: flows without it, with it, storage, refusals."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import reference
from reference import ReferenceError, immersed_channel, immersed_channel_run
from reference.immersed_boundary_flow import Grid
from reference.immersed_channel import DATA, SHARES, solve
from reference.immersed_channel_run import Channel, run
from reference.immersed_channel_store import read_stored, write_stored
from reference.scene import read_scene
from verification.case import load_case

NAME, CASE = "immersed_channel", load_case("single_abrasive")
SCENE = """
[domain]
lower = [1e-5, -1e-6]
upper = [5e-5, 1.9e-5]
periodic = "x"
[fluid]
density = 1000.0
dynamic_viscosity = 1e-3
[[walls]]
name = "wafer"
shape = "line"
from = [1e-5, 1.9e-5]
to = [5e-5, 1.9e-5]
fluid_side = "below"
velocity = [-1.0, 0.0]
[[walls]]
name = "pad"
{pad}
fluid_side = "above"
[output]
end_time = {end}
"""
FLAT = 'shape = "line"\nfrom = [1e-5, {height}]\nto = [5e-5, {height}]'
BUMP = 'shape = "gaussian"\nbase_height = -1e-6\namplitude = 1.3e-5\ncentre = 3e-5\nwidth = 5e-6'
WAVE = 'shape = "cosine"\nmean_height = 4e-6\namplitude = 4e-6\nwavelength = 4e-5\ncrest = 3e-5'
DISC = """
[[discs]]
name = "grain"
placement = "single"
radius = 1e-6
position = [4e-5, 1.5e-5]
density = 2000.0
"""


def channel(folder, pad=BUMP, end=1e-4, extra="", overrides=None):
    file = folder / "scene.toml"
    file.write_text(SCENE.format(pad=pad, end=end) + extra)
    return Channel(read_scene(file, overrides or {}))


@pytest.mark.parametrize("height", [8.9e-6, 9.17e-6, 9.4e-6])
def test_shear_over_a_flat_wall_is_that_of_couette_wherever_it_is_on_the_grid(tmp_path, height):
    flat = channel(tmp_path, FLAT.format(height=height))
    found = run(flat, Grid((40, 20), flat.size, (True, False)), np.array([0.0, 3e-4]))
    assert found.shear[-1] == pytest.approx(1e-3 / (1.9e-5 - height), rel=5e-3)


def test_shear_over_a_wavy_wall_converges_to_the_finite_elements(tmp_path, monkeypatch):
    monkeypatch.setattr(immersed_channel_run, "COURANT", 1.0)  # for the steady flow alone
    wave = channel(tmp_path, WAVE)
    steady = reference.load("channel_navier_stokes", wave.scene.path, {}, tmp_path)
    truth = np.abs(steady.wall_shear("wafer", np.linspace(1e-5, 5e-5, 400), 0.0)).max()
    errors = []
    for cells in ((40, 20), (80, 40)):
        found = run(wave, Grid(cells, wave.size, (True, False)), np.array([0.0, 2e-4]))
        errors.append(abs(found.shear[-1] / truth - 1))
    assert errors[1] < 0.02
    assert errors[1] < 0.6 * errors[0]


def test_disc_of_the_fluids_density_goes_with_a_couette_flow(tmp_path, monkeypatch):
    """Between two flat walls: at the speed of the flow where it is, turning with half the shear rate."""
    monkeypatch.setattr(immersed_channel_run, "COURANT", 0.5)
    free = channel(tmp_path, FLAT.format(height=1e-6), extra=DISC, overrides={
        "discs.grain.position": [3e-5, 1e-5], "discs.grain.density": 1000.0})  # fmt: skip
    found = run(free, Grid((80, 40), free.size, (True, False)), np.array([0.0, 1.5e-4]))
    height = found.states[-1, 1] - 2e-6  # above the lower wall
    assert found.states[-1, 3] == pytest.approx(-height / 1.8e-5, rel=0.02)
    assert found.states[-1, 5] == pytest.approx(0.5 / 1.8e-5, rel=0.1)  # on four cells
    assert height == pytest.approx(9e-6, abs=5e-7)  # it drifts, the less the shorter the steps


@pytest.fixture
def coarse(monkeypatch):
    monkeypatch.setattr(immersed_channel_run, "GAP_CELLS", 16)
    monkeypatch.setattr(immersed_channel_run, "DISC_CELLS", 5)
    monkeypatch.setattr(immersed_channel_run, "COURANT", 1.0)
    monkeypatch.setattr(immersed_channel, "SAMPLES", 20)


def test_scenes_are_computed_kept_and_stored(tmp_path, coarse, monkeypatch):
    here = channel(tmp_path, end=6e-5, extra=DISC)
    file, cache = here.scene.path, tmp_path / "cache"
    first = reference.load("immersed_channel", file, {}, cache)
    assert 0 < first.error_estimate < 0.2
    assert first.clearance > 1e-6
    assert len(first.error_table().splitlines()) == 5 + len(SHARES)
    place = first.disc("grain", "position", np.array([0.0, 6e-5, 7e-5]))
    assert_allclose(place[0], [4e-5, 1.5e-5])
    assert place[1, 0] < 3e-5
    assert np.isnan(place[2]).all()
    assert first.channel.since == pytest.approx(4.9e-5, rel=1e-5)
    assert np.isnan([first.greatest_wafer_shear(t) for t in (4.8e-5, 6.1e-5)]).all()
    assert 100 < first.greatest_wafer_shear(5.5e-5) < 250
    with pytest.raises(ReferenceError, match="not spin of grain"):
        first.disc("grain", "spin", np.zeros(1))
    assert reference.load("immersed_channel", file, {}, cache).seconds == first.seconds

    arrays = solve(here, 6e-5)
    assert_allclose(arrays["shear"], first.grids["shear"])
    stored = tmp_path / "immersed_channel_test.csv"
    write_stored(stored, here.scene.flow(), arrays)
    for key, array in read_stored(stored).arrays.items():
        assert_allclose(array, arrays[key], rtol=1e-6, atol=1e-12)
    monkeypatch.setattr(immersed_channel, "DATA", tmp_path)
    assert reference.load("immersed_channel", file, {}, cache).digest == read_stored(stored).digest
    for old, new in (("0,3e-06,", "0,4e-06,"), ("sha256", "sha1"), ("grid,", "grids,")):
        whole = stored.read_text()
        stored.write_text(whole.replace(old, new))
        with pytest.raises(ReferenceError, match="make it again"):
            read_stored(stored)
        stored.write_text(whole)


def test_coarsest_stored_grid_is_found_again(tmp_path):
    """Over the first tenth of the time; as a shorter run has slightly other steps, not to rounding."""
    found = reference.load(NAME, CASE.scene_path, {}, tmp_path)
    stored = read_stored(DATA / "immersed_channel_single_abrasive.csv")
    assert found.digest == stored.digest
    assert found.error_estimate < 0.02
    assert found.times[-1] >= found.scene.end_time
    times = stored.arrays["times"][:21]
    again = run(found.channel, found.channel.grid(SHARES[0]), times)
    assert_allclose(again.shear[5:], stored.arrays["shear"][0, 5:21], rtol=2e-3)
    assert_allclose(again.states[:, :2], stored.arrays["states"][0, :21, :2], rtol=0, atol=1e-8)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        ({"domain.periodic": "none"}, "periodic in x"),
        ({"walls.pad.velocity": [1.0, 0.0]}, "rests"),
        ({"walls.wafer.velocity": [0.0, 0.0]}, "move along itself"),
        ({"walls.wafer.from": [1e-5, 1.8e-5], "walls.wafer.to": [5e-5, 1.8e-5]}, "upper side"),
        ({"walls.pad.base_height": -2e-6}, "must lie in the domain"),
        ({"fluid.body_force": [1.0, 0.0]}, "body force"),
        ({"output.end_time": 4e-5}, "go on beyond 4.9e-05 s"),
        ({"discs.grain.position": [3e-5, 1.35e-5], "output.end_time": 5.2e-5}, "of a wall"),
    ],
)
def test_scenes_out_of_reach_are_refused(tmp_path, coarse, overrides, message):
    here = tmp_path / "scene.toml"
    here.write_text(SCENE.format(pad=BUMP, end=6e-5) + DISC)
    with pytest.raises(ReferenceError, match=message):
        reference.load(NAME, here, overrides, tmp_path)
