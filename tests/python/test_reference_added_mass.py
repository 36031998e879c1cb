"""The start of a disc by added mass and boundary layer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.special import erfcx

from reference import ReferenceError, load
from reference.added_mass import accelerations, image_sum
from verification.case import ROOT

SCENE = ROOT / "disc_added_mass" / "scene.toml"


def start(cache: Path, **changes: object):
    return load("added_mass", SCENE, changes, cache)


def test_the_images_of_a_square_are_those_of_a_sum_over_dipoles() -> None:
    n, m = np.mgrid[-40:41, -4000:4001].astype(float)
    square = n**2 + m**2
    square[40, 4000] = np.inf
    dipoles = (-1.0) ** n * (n**2 - m**2) / square**2
    assert image_sum() == pytest.approx(-dipoles.sum(), rel=1e-3)


def test_the_integral_equation_has_its_known_solution() -> None:
    times = np.linspace(0, 1, 401) ** 2
    found = accelerations(times, 2.0, 0.6, 0.0, 3.0)  # U' + 0.3 int U' / sqrt(t - s) ds = 1.5
    assert found == pytest.approx(1.5 * erfcx(0.3 * np.sqrt(np.pi * times)), rel=1e-4)


def test_drag_alone_leads_to_the_final_speed() -> None:
    times = np.linspace(0, 1, 2001)
    assert accelerations(times, 2.0, 0.0, 6.0, 3.0) == pytest.approx(1.5 * np.exp(-3 * times), rel=1e-4)


def test_without_viscosity_the_mass_of_the_fluid_counts(tmp_path: Path) -> None:
    changes = {"fluid.dynamic_viscosity": 1e-12}
    speed = start(tmp_path, **changes).disc("disc", "velocity", np.array([0.0, 0.01]))
    mass = 1 + 2 * image_sum() * (1.25e-3 / 0.02) ** 2
    assert speed[:, 0] == pytest.approx([0, 0])
    assert speed[1, 1] == pytest.approx(0.01 * 900 * 9.81 / (100 + 1000 * mass), rel=1e-5)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"discs.disc.velocity": [0.0, 0.1]}, "at rest"),
        ({"discs.disc.position": [0.011, 0.01]}, "middle"),
        ({"domain.upper": [0.02, 0.03]}, "middle of a closed square"),
        ({"output.end_time": 0.1}, "start alone"),
        ({"fluid.gravity": [0.0, 0.0]}, "gravity"),
    ],
)
def test_what_it_does_not_hold_for_is_refused(tmp_path: Path, changes: dict, reason: str) -> None:
    with pytest.raises(ReferenceError, match=reason):
        start(tmp_path, **changes)


def test_other_quantities_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ReferenceError, match="knows velocity"):
        start(tmp_path).disc("disc", "spin", np.array([0.0]))
