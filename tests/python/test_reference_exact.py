"""The exact references solve their equations; scenes they do not fit are refused."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import erfc

import reference
from reference import ReferenceError

CHANNEL = """
[domain]
lower = [0.0, 0.0]
upper = [2e-4, 1e-3]
periodic = "x"
[fluid]
density = 1000
dynamic_viscosity = 1e-3
[[walls]]
name = "top"
shape = "line"
from = [0.0, 1e-3]
to = [2e-4, 1e-3]
fluid_side = "below"
[[walls]]
name = "bottom"
shape = "line"
from = [0.0, 0.0]
to = [2e-4, 0.0]
fluid_side = "above"
"""
BOX = """
[domain]
lower = [-1.0, 0.5]
upper = [1.0, 2.5]
periodic = "xy"
[fluid]
density = 2.0
dynamic_viscosity = 0.04
[start]
velocity = "taylor_green"
speed = 3.0
"""
MOVING = {"walls.top.velocity": [0.02, 0.0], "walls.bottom.velocity": [-0.005, 0.0]}
FORCED = {"fluid.body_force": [0.1, 0.0]}
FLOWS = [("start_up_couette", MOVING), ("start_up_poiseuille", FORCED)]
NU = 1e-6
Y = np.linspace(0, 1e-3, 41)


@pytest.fixture
def load(tmp_path):
    (tmp_path / "channel.toml").write_text(CHANNEL)
    (tmp_path / "box.toml").write_text(BOX)

    def loader(name, overrides):
        scene = "box.toml" if name == "taylor_green" else "channel.toml"
        return reference.load(name, tmp_path / scene, overrides, tmp_path / "cache")

    return loader


@pytest.mark.parametrize(("name", "overrides"), FLOWS)
@pytest.mark.parametrize("t", [0.02, 0.1, 0.5])
def test_start_up_obeys_the_momentum_equation(load, name, overrides, t):
    flow = load(name, overrides)
    y, h, dt = Y[4:-4], 2e-6, 1e-5
    rate = (flow.profile(y, t + dt) - flow.profile(y, t - dt)) / (2 * dt)
    diffusion = NU * (flow.profile(y + h, t) - 2 * flow.profile(y, t) + flow.profile(y - h, t)) / h**2
    force = overrides.get("fluid.body_force", [0.0])[0]
    assert_allclose(rate, diffusion + force, atol=2e-4 * np.abs(diffusion).max() + 1e-8)


@pytest.mark.parametrize(("name", "overrides"), FLOWS)
def test_start_up_begins_at_rest_and_ends_steady(load, name, overrides):
    flow = load(name, overrides)
    speeds = [overrides.get(f"walls.{wall}.velocity", [0.0])[0] for wall in ("bottom", "top")]
    assert_allclose(flow.profile(Y, 0.0)[1:-1], 0)
    force = overrides.get("fluid.body_force", [0.0])[0]
    assert_allclose(flow.profile(Y[20:21], 1e-3), force * 1e-3, atol=1e-15)  # the walls are not felt yet
    assert_allclose(flow.profile(np.array([-1.0, 2.0]), 0.3), speeds, atol=1e-15)
    assert_allclose(flow.profile(Y, 50.0), flow.steady(Y / 1e-3), rtol=1e-12, atol=1e-15)
    assert flow.kinetic_energy(0.0) == 0
    assert flow.velocity(Y, Y, 0.1).shape == (41, 2)
    assert not flow.velocity(Y, Y, 0.1)[:, 1].any()


@pytest.mark.parametrize(("name", "overrides"), FLOWS)
@pytest.mark.parametrize("t", [0.005, 0.05, 0.5])
def test_start_up_shear_and_energy_follow_from_the_profile(load, name, overrides, t):
    flow = load(name, overrides)
    h = 1e-8
    for wall, y, inward in (("bottom", 0.0, 1), ("top", 1e-3, -1)):
        u = flow.profile(y + inward * h * np.arange(3), t)
        slope = (-1.5 * u[0] + 2 * u[1] - 0.5 * u[2]) / h
        assert_allclose(flow.wall_shear(wall, np.zeros(4), t), np.full(4, -1e-3 * slope), rtol=1e-4)
        assert not flow.wall_pressure(wall, np.zeros(4), t).any()
    points, weights = np.polynomial.legendre.leggauss(80)
    energy = 0.5 * 1000 * 2e-4 * 5e-4 * weights @ flow.profile(5e-4 * (points + 1), t) ** 2
    assert flow.kinetic_energy(t) == pytest.approx(energy, rel=1e-10)


def test_couette_of_short_times_is_stokes_first_problem(load):
    flow = load("start_up_couette", {"walls.bottom.velocity": [0.02, 0.0]})
    t = 1e-5
    assert_allclose(flow.profile(Y, t), 0.02 * erfc(Y / math.sqrt(4 * NU * t)), atol=1e-14)
    with pytest.raises(ReferenceError, match="t > 0"):
        flow.wall_shear("bottom", Y, 0.0)
    with pytest.raises(ReferenceError, match="t > 0"):
        flow.profile(Y, math.nan)


def test_taylor_green_solves_navier_stokes(load):
    flow = load("taylor_green", {})
    random = np.random.default_rng(3)
    x, y, t, h = random.uniform(-1, 1, 30), random.uniform(0.5, 2.5, 30), 0.7, 1e-4

    def u(i, j, dt=0.0):
        return flow.velocity(x + i * h, y + j * h, t + dt)

    dx, dy = (u(1, 0) - u(-1, 0)) / (2 * h), (u(0, 1) - u(0, -1)) / (2 * h)
    assert_allclose(dx[:, 0] + dy[:, 1], 0, atol=1e-9)
    laplacian = (u(1, 0) + u(-1, 0) + u(0, 1) + u(0, -1) - 4 * u(0, 0)) / h**2
    here = u(0, 0)
    left = (u(0, 0, h) - u(0, 0, -h)) / (2 * h) + here[:, :1] * dx + here[:, 1:] * dy - 0.02 * laplacian
    gradient = np.column_stack(
        [flow.pressure(x + h, y, t) - flow.pressure(x - h, y, t),
         flow.pressure(x, y + h, t) - flow.pressure(x, y - h, t)]
    ) / (2 * h)  # fmt: skip
    assert_allclose(left, -gradient / 2, atol=1e-5)


def test_taylor_green_starts_as_the_solver_does(load):
    flow = load("taylor_green", {})
    corner = flow.velocity(np.array([-1.0]), np.array([1.0]), 0.0)
    assert_allclose(corner, [[-3.0, 0.0]], atol=1e-14)
    x, y = (a.ravel() for a in np.meshgrid(np.arange(64) / 32 - 1, np.arange(64) / 32 + 0.5))
    energy = 0.5 * 2.0 * np.mean(np.sum(flow.velocity(x, y, 0.4) ** 2, axis=1)) * 4
    assert flow.kinetic_energy(0.4) == pytest.approx(energy, rel=1e-12)
    assert flow.kinetic_energy(1.0) / flow.kinetic_energy(0.0) == pytest.approx(
        math.exp(-2 * 8 * math.pi**2 * 0.02 / 4)
    )
    assert abs(flow.pressure(x, y, 0.0).mean()) < 1e-14


@pytest.mark.parametrize(
    ("name", "overrides", "reason"),
    [
        ("start_up_couette", {}, "a wall that moves"),
        ("start_up_couette", MOVING | FORCED, "body_force"),
        ("start_up_poiseuille", MOVING | FORCED, "walls at rest"),
        ("start_up_poiseuille", {}, "a body force"),
        ("start_up_couette", MOVING | {"domain.periodic": "none"}, "periodic in x"),
        ("start_up_couette", MOVING | {"start.velocity": "shear"}, "starts from rest"),
        ("start_up_couette", MOVING | {"walls.top.from": [0.0, 9e-4]}, "horizontal"),
        ("taylor_green", {"domain.periodic": "x"}, "periodic in x and y"),
        ("taylor_green", {"domain.upper": [1.0, 2.6]}, "as high as wide"),
        ("taylor_green", {"start.speed": 0.0}, "start.speed"),
        ("no_such_flow", {}, "no reference 'no_such_flow'"),
    ],
)
def test_scenes_that_do_not_fit_are_refused(load, name, overrides, reason):
    with pytest.raises(ReferenceError, match=reason):
        load(name, overrides)


def test_references_carry_their_identity(load):
    flows = [load(name, overrides) for name, overrides in [*FLOWS, ("taylor_green", {})]]
    assert len({flow.digest for flow in flows}) == 3
    assert load("start_up_couette", MOVING | {"numerics.particle_spacing": 1.0}).digest == flows[0].digest
    assert load("taylor_green", {"start.speed": 1.0}).digest != flows[2].digest
    for flow in flows:
        assert flow.kind == "exact"
        assert flow.error_estimate < 1e-12
        assert flow.seconds >= 0
        assert flow.source
