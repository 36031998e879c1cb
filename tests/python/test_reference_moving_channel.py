"""The unsteady finite elements: against the steady flow that a flat wafer has, their order, stored files."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import reference
from reference import ReferenceError, moving_channel, moving_channel_flow
from reference.base import canonical
from reference.moving_channel import DATA, INSTANTS, Period, solve
from reference.moving_channel_flow import Flow, Space
from reference.moving_channel_store import read_stored, write_stored
from reference.moving_channel_units import Units, Waves
from reference.scene import read_scene
from verification.case import load_case

CHANNEL = """
[domain]
lower = [0.0, 0.0]
upper = [3e-5, 1.8e-5]
periodic = "x"
[fluid]
density = 1000
dynamic_viscosity = 1e-3
[[walls]]
name = "pad"
shape = "cosine"
mean_height = 5e-6
amplitude = -5e-6
wavelength = 3e-5
fluid_side = "above"
velocity = [-1.0, 0.0]
[[walls]]
name = "wafer"
fluid_side = "below"
"""
FLAT = 'shape = "line"\nfrom = [0.0, 1.5e-5]\nto = [3e-5, 1.5e-5]\n'
CAVITY = 'shape = "arc"\nbase_height = 1.5e-5\ncentre = 1.5e-5\nradius = 3e-6\nangle = 2.0\nupward = true\n'
CASE = load_case("wafer_feature")


def scene(folder, wafer, overrides=None):
    (folder / "scene.toml").write_text(CHANNEL + wafer)
    return read_scene(folder / "scene.toml", overrides or {})


@pytest.fixture
def coarse(monkeypatch):
    for name, value in {"SPIN_UP": 2, "SPIN_UP_STEPS": 10, "STEPS": 10, "SAMPLES": 10}.items():
        monkeypatch.setattr(moving_channel, name, value)
    monkeypatch.setattr(moving_channel_flow, "PER_GAP", 1)
    monkeypatch.setattr(moving_channel_flow, "KINK_SIZE", 0.1)


def test_flat_wafer_has_the_steady_flow_with_order_three(tmp_path, monkeypatch):
    """A moving pad under a flat wafer is the steady flow of the other reference, seen from the wafer."""
    monkeypatch.setattr(moving_channel_flow, "PER_GAP", 2)
    units = Units(scene(tmp_path, FLAT))
    steady = reference.load("channel_navier_stokes", tmp_path / "scene.toml", {}, tmp_path)
    problem, errors = units.problem(), []
    space = Space(problem, 0)
    x = np.linspace(0, 3e-5, 50)
    y = np.full_like(x, 1.3e-5)
    for steps in (20, 40, 80):
        period = Period.run(Flow(problem, space, steps, None), steps, 2 * steps)
        worst = 0.0
        for phase in (0.25, 0.7):
            phase = round(phase * steps) / steps
            place, eta = units.laboratory(x, y, phase)
            found = period.at(phase, place / units.length, eta) * units.stress
            worst = max(worst, np.abs(found - steady.pressure(x, y, phase * units.period)).max())
        errors.append(worst / 380)
    assert errors[2] < 5e-3
    assert np.log2(errors[0] / errors[1]) > 2.3


def test_waves_are_exact_for_what_they_hold():
    x = np.linspace(2.0, 7.0, 64, endpoint=False)
    waves = Waves.through(1 + np.cos(2 * np.pi * 3 * x / 5 - 0.4), 2.0, 5.0)
    at = np.array([[0.3, 2.1], [9.7, -4.0]])
    assert_allclose(waves.height(at), 1 + np.cos(2 * np.pi * 3 * at / 5 - 0.4), atol=1e-12)
    assert_allclose(waves.slope(at), -1.2 * np.pi * np.sin(2 * np.pi * 3 * at / 5 - 0.4), atol=1e-12)


def test_lines_stand_on_corners_and_crowd_where_these_point_into_the_fluid(tmp_path):
    for wafer, sharp in ((CAVITY, True), (CAVITY.replace("true", "false"), False)):
        problem = Units(scene(tmp_path, wafer, {"walls.pad.velocity": [2.0, 0.0]})).problem()
        x, eta = problem.lines(0)
        assert [kink[1] for kink in problem.kinks] == [sharp, sharp]
        for kink, _ in problem.kinks:
            assert np.abs(x - kink).min() < 1e-12
            assert (np.sort(np.abs(x - kink))[1] < 0.02) == sharp
        assert (np.diff(eta)[-1] < 0.02) == sharp
        assert problem.reynolds == pytest.approx(2 * Units(scene(tmp_path, wafer)).problem().reynolds)


def test_stored_pressures_are_read_as_written_and_only_whole(tmp_path, coarse, monkeypatch):
    flow = scene(tmp_path, CAVITY)
    units = Units(flow)
    arrays = solve(units, [(1.5e-5, 1.2e-5)])
    file = tmp_path / "moving_channel_test.csv"
    write_stored(file, flow.flow(), arrays)
    stored = read_stored(file)
    assert stored.identity == canonical(flow.flow())
    for key in arrays:
        assert_allclose(stored.arrays[key], arrays[key], rtol=1e-4, atol=1e-2 if "oint" in key else 1e-6)
    monkeypatch.setattr(moving_channel, "DATA", tmp_path)
    found = reference.load("moving_channel", tmp_path / "scene.toml", {}, tmp_path / "cache")
    assert found.digest == stored.digest
    point = np.array([1.5e-5]), np.array([1.2e-5])
    for instant in INSTANTS:
        time = (3 + instant) * units.period
        assert_allclose(found.pressure(*point, time), arrays["at_points"][0][round(10 * instant)], rtol=0.05)
        top = found.pressure(np.array([1e-5]), np.array([1.5e-5]), time)
        assert_allclose(found.wall_pressure("wafer", np.array([1e-5]), time), top, rtol=1e-3)
    with pytest.raises(ReferenceError, match="at 0 T, 0.2 T.* alone"):
        found.pressure(point[0], point[1] - 1e-6, 0.1 * units.period)
    with pytest.raises(ReferenceError, match="'wafer' alone"):
        found.wall_pressure("pad", point[0], 0.0)
    text = file.read_text()
    for wrong in (
        text.replace("wall,0.1,", "wall,0.1,1"),
        text[: len(text) // 2],
        text.replace("# run", "# r"),
    ):
        file.write_text(wrong)
        with pytest.raises(ReferenceError, match="make it again"):
            read_stored(file)


def test_other_scenes_are_computed_and_kept(tmp_path, coarse):
    scene(tmp_path, FLAT)
    first = reference.load("moving_channel", tmp_path / "scene.toml", {}, tmp_path)
    assert first.error_estimate > 1e-3  # on these meshes
    assert len(first.error_table().splitlines()) == 7
    again = reference.load("moving_channel", tmp_path / "scene.toml", {}, tmp_path)
    assert (again.fields == first.fields).all()
    slower = reference.load(
        "moving_channel", tmp_path / "scene.toml", {"walls.pad.velocity": [-0.5, 0.0]}, tmp_path
    )
    assert slower.digest != first.digest


@pytest.mark.parametrize(
    ("wafer", "overrides", "reason"),
    [
        (FLAT, {"walls.wafer.velocity": [1.0, 0.0]}, "a top at rest"),
        (FLAT, {"walls.pad.velocity": [0.0, 0.0]}, "moves along x"),
        (FLAT, {"walls.pad.amplitude": -5e-6, "walls.pad.wavelength": 1.5e-6}, "more than 12 waves"),
        (FLAT, {"walls.pad.mean_height": 1.2e-5}, "collide"),
        (FLAT, {"fluid.body_force": [1.0, 0.0]}, "no body force"),
    ],
)
def test_refusals(tmp_path, wafer, overrides, reason):
    with pytest.raises(ReferenceError, match=reason):
        Units(scene(tmp_path, wafer, overrides))


@pytest.mark.parametrize("variant", CASE.variants, ids=lambda variant: variant.name)
def test_store_belongs_to_the_scene(tmp_path, variant, monkeypatch):
    """The scene of the case finds it; a coarse run of a period from rest is near it after half of that."""
    monkeypatch.setattr(moving_channel_flow, "PER_GAP", 1.5)
    monkeypatch.setattr(moving_channel_flow, "KINK_SIZE", 0.05)
    found = reference.load("moving_channel", CASE.path(variant), dict(variant.set), tmp_path)
    stored = read_stored(DATA / f"moving_channel_{variant.name}.csv")
    assert found.digest == stored.digest
    tolerances = [check.tolerance for check in CASE.checks("default", "paper", variant.name)]
    assert found.error_estimate < 0.2 * min(t for t in tolerances if t > 0.02)
    assert found.repetition < 1e-3
    problem = found.units.problem()
    rough = Period.run(Flow(problem, Space(problem, 0), 40, None), 40, 60)
    x = np.linspace(0, 4e-5, 80, endpoint=False)
    for phase in (0.25, 0.45):
        near = rough.at(phase, x / found.units.length, np.ones_like(x)) * found.units.stress
        truth = found.wall_pressure("wafer", x, phase * found.units.period)
        assert np.sqrt(np.mean((near - truth) ** 2)) < 0.06 * np.ptp(truth)


def test_periodic_samples_are_met_and_smooth():
    phases = np.arange(10) / 10
    values = np.stack([np.cos(2 * np.pi * phases), 3 + np.sin(6 * np.pi * phases)], axis=1)
    assert_allclose(moving_channel._periodic(values, 0.3), values[3], atol=1e-12)
    at = 0.123
    assert_allclose(
        moving_channel._periodic(values, at), [np.cos(2 * np.pi * at), 3 + np.sin(6 * np.pi * at)], atol=1e-12
    )
