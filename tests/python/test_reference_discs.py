"""References of scenes with discs: free flight, the rotating disc; no other takes such a scene."""

import math

import numpy as np
import pytest

from reference import ReferenceError, disc_near_wall, load, rotating_disc
from reference.scene import read_scene
from verification.case import ROOT

FLIGHT, ROTATING, NEAR_WALL = (
    ROOT / name / "scene.toml" for name in ("disc_flight", "disc_rotating", "disc_near_wall")
)


def test_free_flight(tmp_path):
    flight = load("free_flight", FLIGHT, {}, tmp_path)
    t = np.array([0.0, 2.0])
    np.testing.assert_allclose(flight.disc("disc", "position", t), [[0.2, 0.8], [1.6, 0.0]], atol=1e-15)
    np.testing.assert_allclose(flight.disc("disc", "velocity", t), [[0.7, -0.4]] * 2)
    np.testing.assert_allclose(flight.disc("disc", "angle", t), [0, 6])
    np.testing.assert_allclose(flight.disc("disc", "spin", t), [3, 3])
    with pytest.raises(ReferenceError, match="not torque"):
        flight.disc("disc", "torque", t)
    with pytest.raises(ReferenceError, match="no disc 'moon', only disc"):
        flight.disc("moon", "angle", t)


@pytest.mark.parametrize(
    "change",
    [
        {"start.arrangement": "lattice"},
        {"fluid.gravity": [0.0, -9.81]},
        {"discs.disc.motion": "fixed"},
    ],
)
def test_no_free_flight_where_something_acts(tmp_path, change):
    with pytest.raises(ReferenceError, match="free_flight needs"):
        load("free_flight", FLIGHT, change, tmp_path)


def test_the_torque_in_a_round_box_is_exact():
    """Between circles the torque is 4 pi mu W R^2 / (1 - R^2) for an outer radius of 1 (batchelor1967)."""
    radius = 0.5
    exact = 4 * math.pi * radius**2 / (1 - radius**2)
    errors = [
        abs(rotating_disc.torque(rotating_disc.mesh(radius, np.ones_like, level)) / exact - 1)
        for level in range(3)
    ]
    assert errors[2] < 1e-6
    assert math.log2(errors[1] / errors[2]) > 3.5


def test_rotating_disc(tmp_path):
    reference = load("rotating_disc", ROTATING, {}, tmp_path)
    assert reference.error_estimate < 1e-4
    scale = 0.01 * 0.16 * 2.5e-3**2
    # The square lies between the circles that touch it from inside and from outside.
    between = [4 * math.pi / (1 - (2.5e-3 / outer) ** 2) for outer in (5e-3, 5e-3 * math.sqrt(2))]
    assert between[1] < -reference.torque / scale < between[0]
    assert reference.disc("disc", "torque", np.zeros(3)) == pytest.approx([reference.torque] * 3)
    backwards = load("rotating_disc", ROTATING, {"discs.disc.spin": -0.16}, tmp_path)
    assert backwards.torque == pytest.approx(-reference.torque)
    assert backwards.digest != reference.digest
    with pytest.raises(ReferenceError, match="the torque on disc only"):
        reference.disc("disc", "spin", np.zeros(3))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"discs.disc.position": [0.006, 0.005]}, "in the middle"),
        ({"discs.disc.motion": "free"}, "motion = 'prescribed'"),
        ({"discs.disc.spin": 16.0}, "Re of at most"),
        ({"discs.disc.radius": 6e-3}, "does not fit"),
        ({"walls.top.velocity": [0.1, 0.0]}, "four lines at rest"),
        ({"discs.disc.spin": "fast"}, "must be a finite number"),
        ({"discs.disc.speed": 1.0}, "not a key of a scene"),
        ({"discs.disc.placement": "random"}, "must be one of single"),
    ],
)
def test_other_scenes_are_refused(tmp_path, change, reason):
    with pytest.raises(ReferenceError, match=reason):
        load("rotating_disc", ROTATING, change, tmp_path)


@pytest.mark.parametrize("film", [0.03, 0.01])
def test_the_force_of_a_thin_film_is_that_of_lubrication(film):
    """4 pi mu U / arccosh(1 + h / R) of a disc by a plane (jeffrey1981), and an order of 1 of the rest."""
    force, torque = disc_near_wall.force_and_torque(disc_near_wall.half_period(7, 1 + film, 4, 2), "top")
    lubrication = 4 * math.pi / math.acosh(1 + film)
    assert abs(force - lubrication) < 4
    assert abs(torque) < 4


def test_disc_near_wall(tmp_path):
    reference = load("disc_near_wall", NEAR_WALL, {}, tmp_path)
    assert reference.error_estimate < 2e-3
    forces = reference.disc("disc", "force", np.zeros(3))
    assert forces.shape == (3, 2)
    assert forces[:, 0] == pytest.approx([reference.force] * 3)
    assert reference.force < 0 < reference.torque  # the wafer slides to the left above the disc
    below = {
        "walls.wafer.velocity": [0.0, 0.0],
        "walls.pad.velocity": [-0.1, 0.0],
        "discs.disc.position": [2e-6, 7e-7],
    }
    mirrored = load("disc_near_wall", NEAR_WALL, below, tmp_path)
    assert mirrored.force == pytest.approx(reference.force, rel=1e-9)
    assert mirrored.torque == pytest.approx(-reference.torque, rel=1e-9)
    assert mirrored.digest != reference.digest
    with pytest.raises(ReferenceError, match="force along x and torque on disc only"):
        reference.disc("disc", "spin", np.zeros(3))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"discs.disc.motion": "free"}, "one disc, fixed"),
        ({"discs.disc.position": [2e-6, 3.6e-6]}, "does not fit"),
        ({"walls.pad.velocity": [0.1, 0.0]}, "one of which slides"),
        ({"walls.wafer.velocity": [-1.0, 0.0]}, "Re of at most"),
    ],
)
def test_other_scenes_have_no_force_near_a_wall(tmp_path, change, reason):
    with pytest.raises(ReferenceError, match=reason):
        load("disc_near_wall", NEAR_WALL, change, tmp_path)


def test_flows_without_discs_take_no_scene_with_them(tmp_path):
    with pytest.raises(ReferenceError, match="taylor_green is a flow without discs"):
        load("taylor_green", ROOT / "disc_conservation" / "scene.toml", {}, tmp_path)
    with pytest.raises(ReferenceError, match="without discs and gravity"):
        load("taylor_green", ROOT / "taylor_green" / "scene.toml", {"fluid.gravity": [0, -9.81]}, tmp_path)


def test_a_scene_has_its_discs():
    scene = read_scene(ROOT / "disc_pair" / "scene.toml", {"discs.trailing.density": 1100.0})
    assert [disc.name for disc in scene.discs] == ["leading", "trailing"]
    assert scene.disc("trailing").density == 1100.0
    assert (scene.disc("leading").motion, scene.gravity) == ("free", (0.0, -9.81))
    assert scene.flow() != read_scene(ROOT / "disc_pair" / "scene.toml", {}).flow()
