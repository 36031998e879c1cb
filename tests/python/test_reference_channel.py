"""The finite-element channel: the paper's check values, balances, frames, evaluation and the stored file."""

import time

import h5py
import numpy as np
import pytest
from numpy.testing import assert_allclose

import reference
from reference import ReferenceError, channel_navier_stokes
from reference.scene import read_scene

NAME = "channel_navier_stokes"
ROUGH = """
[domain]
lower = [0.0, 0.0]
upper = [3e-5, 1.5e-5]
periodic = "x"
[fluid]
density = 1000
dynamic_viscosity = 1e-3
[numerics]
particle_spacing = 5e-7
sound_speed = 10
[[walls]]
name = "wafer"
shape = "line"
from = [0.0, 1.5e-5]
to = [3e-5, 1.5e-5]
fluid_side = "below"
velocity = [1.0, 0.0]
[[walls]]
name = "pad"
shape = "cosine"
mean_height = 5e-6
amplitude = -5e-6
wavelength = 3e-5
fluid_side = "above"
"""
GAUSSIAN = """
[domain]
lower = [0.0, 0.0]
upper = [4e-5, 2e-5]
periodic = "x"
[fluid]
density = 1000
dynamic_viscosity = 1e-3
[[walls]]
name = "wafer"
shape = "line"
from = [0.0, 2e-5]
to = [4e-5, 2e-5]
fluid_side = "below"
[[walls]]
name = "pad"
shape = "gaussian"
base_height = 0
amplitude = 17e-6
centre = 2e-5
width = 5e-6
fluid_side = "above"
velocity = [1.0, 0.0]
"""
BOTTOM_MOVES = {"walls.wafer.velocity": [0.0, 0.0], "walls.pad.velocity": [-1.0, 0.0]}
X = np.linspace(0, 3e-5, 3000, endpoint=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("channel")
    (path / "rough.toml").write_text(ROUGH)
    (path / "gaussian.toml").write_text(GAUSSIAN)
    return path


@pytest.fixture(scope="module")
def rough(folder):
    return reference.load(NAME, folder / "rough.toml", {}, folder / "cache")


@pytest.fixture
def coarse(monkeypatch):
    """Two meshes instead of three: errors of about 0.1 %, in a quarter of the time."""
    monkeypatch.setattr(channel_navier_stokes, "MESHES", 2)
    monkeypatch.setattr(channel_navier_stokes, "MOST_ERROR", 1e-2)


def stored(folder):
    return next((folder / "cache").glob("*.h5"))


def test_rough_channel_has_the_check_values(rough):
    pressure = rough.wall_pressure("wafer", X, 0.0)
    shear = rough.wall_shear("wafer", X, 0.0)
    assert np.ptp(pressure) == pytest.approx(381.8, abs=0.05)
    assert pressure.max() - pressure.mean() == pytest.approx(182.4, abs=0.1)
    assert X[pressure.argmax()] == pytest.approx(9.5e-6, abs=0.15e-6)
    assert shear.max() == pytest.approx(199.55, abs=0.05)
    assert shear.min() == pytest.approx(52.7, abs=0.1)


def test_own_error_is_proved_and_printed(rough):
    assert 0 < rough.error_estimate < 2e-4
    assert rough.changes[1].max() < rough.changes[0].max() / 8
    assert "order" in rough.error_table()
    assert len(rough.error_table().splitlines()) == 5


def test_forces_on_the_fluid_balance(rough):
    shear = [rough.wall_shear(wall, X, 0.0) for wall in ("wafer", "pad")]
    pad_slope = rough.units.bottom.slope(X)
    drag = shear[0] + shear[1] - rough.wall_pressure("pad", X, 0.0) * pad_slope
    assert abs(drag.mean()) < 1e-6 * shear[0].mean()


def test_wall_values_are_those_of_the_field(rough):
    inside = 1.5e-5 - 1e-10
    assert_allclose(
        rough.wall_pressure("wafer", X, 0), rough.pressure(X, np.full_like(X, 1.5e-5), 0), atol=0.05
    )
    slope = (1 - rough.velocity(X, np.full_like(X, inside), 0)[:, 0]) / 1e-10
    assert_allclose(rough.wall_shear("wafer", X, 0), 1e-3 * slope, atol=0.05)


def test_field_keeps_the_laws(rough):
    """No divergence, no slip, momentum by finite differences, no mean pressure."""
    x = np.linspace(1.3e-6, 2.9e-5, 41)
    y = rough.units.bottom.height(x) + 0.37 * (1.5e-5 - rough.units.bottom.height(x))
    h = 2e-9
    at = {(i, j): rough.velocity(x + i * h, y + j * h, 0) for i in (-1, 0, 1) for j in (-1, 0, 1)}
    dx, dy = (at[1, 0] - at[-1, 0]) / (2 * h), (at[0, 1] - at[0, -1]) / (2 * h)
    assert np.abs(dx[:, 0] + dy[:, 1]).max() < 1e-3 * np.abs(dy).max()
    bottom = rough.velocity(x, rough.units.bottom.height(x), 0)
    assert_allclose(bottom, 0, atol=1e-12)
    laplacian = (at[1, 0] + at[-1, 0] + at[0, 1] + at[0, -1] - 4 * at[0, 0]) / h**2
    force = 1e-3 * laplacian - 1000 * (at[0, 0][:, :1] * dx + at[0, 0][:, 1:] * dy)
    gradient = np.column_stack(
        [rough.pressure(x + h, y, 0) - rough.pressure(x - h, y, 0),
         rough.pressure(x, y + h, 0) - rough.pressure(x, y - h, 0)]
    ) / (2 * h)  # fmt: skip
    assert np.linalg.norm(force - gradient) < 1e-2 * np.linalg.norm(gradient)
    xs, etas = np.meshgrid(X[::10], (np.arange(200) + 0.5) / 200)
    gap = 1.5e-5 - rough.units.bottom.height(xs)
    mean = np.sum(gap * rough.pressure(xs.ravel(), (1.5e-5 - gap * (1 - etas)).ravel(), 0).reshape(gap.shape))
    assert abs(mean / gap.sum()) < 2e-3


def test_the_two_variants_are_one_flow(folder, rough, coarse, tmp_path):
    moving = reference.load(NAME, folder / "rough.toml", BOTTOM_MOVES, tmp_path)
    t = 7e-6
    x, y = np.linspace(0, 3e-5, 50), np.linspace(1.1e-5, 1.5e-5, 50)
    seen = moving.velocity(x - t, y, t) + [1.0, 0.0]
    assert_allclose(seen, rough.velocity(x, y, 0), atol=2e-3)
    assert_allclose(moving.pressure(x - t, y, t), rough.pressure(x, y, 0), atol=0.5)
    assert_allclose(moving.wall_pressure("wafer", X, t), moving.wall_pressure("wafer", X + t, 0), atol=1e-9)
    assert_allclose(moving.wall_shear("pad", X, t), moving.wall_shear("pad", X, 0), atol=1e-9)
    assert_allclose(rough.wall_shear("wafer", X, t), rough.wall_shear("wafer", X + t, 0), atol=1e-9)
    assert_allclose(moving.wall_shear("wafer", X, 0), rough.wall_shear("wafer", X, 0), atol=0.5)


def test_kinetic_energy_is_the_field_s(rough):
    eta, weight = np.polynomial.legendre.leggauss(24)
    xs, etas = np.meshgrid(X[::10], (eta + 1) / 2)
    gap = 1.5e-5 - rough.units.bottom.height(xs)
    velocity = rough.velocity(xs.ravel(), (1.5e-5 - gap * (1 - etas)).ravel(), 0)
    density = 500 * np.sum(velocity**2, axis=1).reshape(gap.shape)
    energy = np.sum(density * gap * weight[:, None] / 2) * 3e-5 / gap.shape[1]
    assert rough.kinetic_energy(0.0) == pytest.approx(energy, rel=1e-5)


def test_many_points_are_quick_and_outside_ones_are_at_the_wall(rough):
    random = np.random.default_rng(1)
    x, y = random.uniform(-3e-5, 6e-5, 100_000), random.uniform(1e-5, 1.5e-5, 100_000)
    started = time.process_time()
    rough.velocity(x, y, 0)
    assert time.process_time() - started < 1
    assert_allclose(rough.velocity(np.array([1e-5]), np.array([1.6e-5]), 0), [[1, 0]], atol=1e-12)
    assert_allclose(rough.velocity(x[:9] + 3e-5, y[:9], 0), rough.velocity(x[:9], y[:9], 0), atol=1e-12)


def test_gaussian_asperity_has_the_check_values(folder, coarse, tmp_path):
    gaussian = reference.load(NAME, folder / "gaussian.toml", {}, tmp_path)
    x = np.linspace(0, 4e-5, 4000, endpoint=False)
    pressure = gaussian.wall_pressure("wafer", x, 0)
    assert np.abs(gaussian.wall_shear("wafer", x, 0)).max() == pytest.approx(287.2, rel=2e-3)
    assert pressure.max() - pressure.mean() == pytest.approx(456.6, rel=2e-3)


def test_plane_flow_is_exact(folder, coarse, tmp_path):
    """A flat pad and a body force: Couette and Poiseuille superposed lie in the finite-element space."""
    plane = {"walls.pad.amplitude": 0.0, "walls.pad.mean_height": 0.0, "fluid.body_force": [4e4, 0.0]}
    flow = reference.load(NAME, folder / "rough.toml", plane, tmp_path)
    y = np.linspace(0, 1.5e-5, 31)
    exact = y / 1.5e-5 + 4e4 / 2e-6 * y * (1.5e-5 - y)
    assert_allclose(flow.velocity(np.full_like(y, 1e-5), y, 0)[:, 0], exact, atol=1e-8)
    assert_allclose(flow.wall_shear("wafer", X, 0), 1e-3 / 1.5e-5 - 1000 * 4e4 * 0.75e-5, rtol=1e-6)
    assert_allclose(flow.wall_pressure("pad", X, 0), 0, atol=1e-6)


def test_identity_ignores_the_particles_but_nothing_else(folder, rough):
    kept = {"numerics.particle_spacing": 1e-7, "scene.scheme": "wang2014", "output.end_time": 1.0}
    again = reference.load(NAME, folder / "rough.toml", kept, folder / "cache")
    assert again.digest == rough.digest
    assert again.seconds == rough.seconds
    assert_allclose(
        again.velocity(X, np.full_like(X, 1.2e-5), 0), rough.velocity(X, np.full_like(X, 1.2e-5), 0)
    )
    flows = [
        read_scene(folder / "rough.toml", change).flow()
        for change in (
            {},
            {"fluid.density": 999},
            {"walls.pad.crest": 1e-6},
            {"walls.pad.velocity": [0.1, 0]},
        )
    ]
    assert all(a != b for i, a in enumerate(flows) for b in flows[:i])
    assert read_scene(folder / "rough.toml", {"fluid.density": 1000.0}).flow() == flows[0]


def test_damaged_files_are_refused(folder, rough, tmp_path):
    content = stored(folder).read_bytes()
    victim = tmp_path / stored(folder).name

    def refusal():
        with pytest.raises(ReferenceError) as caught:
            reference.load(NAME, folder / "rough.toml", {}, tmp_path)
        assert victim.name in str(caught.value)
        return str(caught.value)

    victim.write_bytes(content[: len(content) // 2])
    assert "not a whole HDF5 file" in refusal()
    victim.write_bytes(b"")
    assert "not a whole HDF5 file" in refusal()
    for change, reason in (
        (lambda file: file["fields"].__setitem__((0, 3, 3), np.nan), "not finite"),
        (lambda file: file["fields"].__setitem__((0, 3, 3), 1.5), "checksum"),
        (lambda file: file.__delitem__("tractions"), "checksum"),
        (lambda file: file.attrs.__setitem__("digest", "0"), "other scripts"),
        (lambda file: file.attrs.__setitem__("problem", "{}"), "another geometry"),
    ):
        victim.write_bytes(content)
        with h5py.File(victim, "r+") as file:
            change(file)
        assert reason in refusal()


def test_nothing_is_left_of_a_file_that_cannot_be_written(rough, tmp_path, monkeypatch):
    def full(*_):
        raise OSError("no space left on device")

    monkeypatch.setattr(h5py.File, "__setitem__", full)
    with pytest.raises(ReferenceError, match="no space"):
        reference.base.write_arrays(tmp_path / "a.h5", "d", {}, {"x": np.zeros(3)})
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"walls.wafer.velocity": [0.0, 0.0]}, "nothing drives"),
        ({"walls.pad.velocity": [0.0, 1.0]}, "along y"),
        ({"domain.periodic": "none"}, "periodic in x"),
        ({"walls.pad.amplitude": -1.5e-5, "walls.pad.mean_height": 1e-5}, "meet or cross"),
        ({"walls.pad.wavelength": 2e-5}, "whole wavelengths"),
        ({"walls.pad.fluid_side": "below"}, "one wall with the fluid above"),
        ({"walls.wafer.from": [0.0, 1.4e-5]}, "horizontal"),
    ],
)
def test_flows_out_of_reach_are_refused(folder, tmp_path, change, reason):
    with pytest.raises(ReferenceError, match=reason) as caught:
        reference.load(NAME, folder / "rough.toml", change, tmp_path)
    assert "rough.toml" in str(caught.value)


def test_two_curved_walls_moving_apart_are_refused(tmp_path):
    line = 'shape = "line"\nfrom = [0.0, 1.5e-5]\nto = [3e-5, 1.5e-5]'
    cosine = 'shape = "cosine"\nmean_height = 1.5e-5\namplitude = 1e-6\nwavelength = 3e-5'
    curved = ROUGH.replace(line, cosine)
    (tmp_path / "curved.toml").write_text(curved)
    with pytest.raises(ReferenceError, match="against each other"):
        reference.load(NAME, tmp_path / "curved.toml", {}, tmp_path)


def test_unknown_wall_is_refused(rough):
    with pytest.raises(ReferenceError, match="no wall 'floor'"):
        rough.wall_shear("floor", X, 0)
