"""Each budget on results that keep it and on results that break it by a known amount."""

import h5py
import numpy as np
import pytest
from disc_fakes import END, TIMES, falling, fields, write

from verification.budgets import BUDGETS
from verification.compare import DataError

SPACING = 0.1
WALLS = [
    {"name": "left", "shape": "line", "fluid_side": "right", "from": [0.0, 0.0], "to": [0.0, 1.0]},
    {"name": "right", "shape": "line", "fluid_side": "left", "from": [1.0, 0.0], "to": [1.0, 1.0]},
    {
        "name": "pad", "shape": "cosine", "fluid_side": "above", "mean_height": 0.1, "amplitude": 0.1,
        "wavelength": 1.0, "velocity": [0.25, 0.0],
    },
]  # fmt: skip
SCENE = {
    "domain": {"lower": [0.0, 0.0], "upper": [1.0, 1.0], "periodic": "none"},
    "fluid": {"density": 2.0, "dynamic_viscosity": 1.0},
    "numerics": {"sound_speed": 10.0},
}
RUN = {"particle_mass": 2.0 * SPACING**2, "fluid_particles": 2, "greatest_overlap": 0.0}


def value(name, result):
    times, values = BUDGETS[name](result)
    assert times == [END] and values.shape == (1,)
    return values[0]


def fluid(folder, series, scene=SCENE, run=RUN):
    return write(folder, {"unused": fields(np.zeros((len(TIMES), 2)))}, series=series, run=run, scene=scene)


def with_particles(folder, points, scene):
    result = fluid(folder, {}, scene)
    with h5py.File(result.path, "a") as file:
        file["run"].attrs["fluid_particles"] = len(points)
        group = file.create_group("snapshots/0000")
        group.attrs["time"] = END
        group["position_x"], group["position_y"] = np.array(points).T
        group["wall"] = np.full(len(points), -1)
        for name in ("velocity_x", "velocity_y", "pressure"):
            group[name] = np.zeros(len(points))
    return result


def test_density_error_is_the_worst_of_all_samples(tmp_path):
    worst = np.where(np.arange(len(TIMES)) == 40, 0.07, 0.01)
    assert value("density_error", fluid(tmp_path, {"largest_density_error": worst})) == 0.07


@pytest.mark.parametrize(("attribute", "expected"), [(0.0, 0.0), (0.02, 0.2)])
def test_overlap_in_spacings(tmp_path, attribute, expected):
    discs, _ = falling()
    run = RUN | {"greatest_overlap": attribute}
    result = write(tmp_path, discs, run=run, scene=SCENE | {"discs": [{"name": "disc"}]})
    assert value("overlap", result) == pytest.approx(expected)


# The pad has moved by a quarter of its wavelength: its crest is at x = 0.25, and at x = 0.5 it is 0.1 high.
@pytest.mark.parametrize(
    ("points", "expected"),
    [
        ([(0.5, 0.11), (0.25, 0.21)], 0.0),
        ([(0.25, 0.19)], 0.1),
        ([(0.5, 0.5), (-0.03, 0.5)], 0.3),
        ([(1.02, 0.5)], 0.2),
    ],
)
def test_leak_behind_walls(tmp_path, points, expected):
    assert value("leak", with_particles(tmp_path, points, SCENE | {"walls": WALLS})) == pytest.approx(
        expected
    )


def test_leak_into_a_disc_across_a_periodic_side(tmp_path):
    discs = {"disc": fields(np.tile([0.95, 0.5], (len(TIMES), 1)))}
    domain = SCENE["domain"] | {"periodic": "x"}
    scene = SCENE | {"domain": domain, "discs": [{"name": "disc"}]}
    result = with_particles(tmp_path, [(0.03, 0.5)], scene)
    with h5py.File(result.path, "a") as file:
        del file["discs"]
    with h5py.File(write(tmp_path / "discs", discs).path, "r") as source, h5py.File(result.path, "a") as file:
        source.copy("discs", file)
    assert value("leak", result) == pytest.approx(0.2)
    result.scene["domain"]["periodic"] = "none"
    assert value("leak", result) == 0


def test_energy_may_fall_and_not_rise(tmp_path):
    energy = 3 * np.exp(-TIMES)
    assert value("energy_created", moving(tmp_path / "falls", energy)) == 0
    energy[50] = 3.3
    assert value("energy_created", moving(tmp_path / "rises", energy)) == pytest.approx(0.1)


def moving(folder, energy):
    return fluid(folder, {"kinetic_energy": energy, "momentum_x": 0 * TIMES})


def test_gravity_gives_a_disc_its_energy_and_no_more(tmp_path):
    """Free fall from rest in a fluid that does not move: M = 2, displaced rho pi R^2."""
    displaced = 2 * np.pi * 0.1**2
    weight = (2 - displaced) * 5.0
    speed = weight / 2 * TIMES
    position = np.stack([0 * TIMES, -speed * TIMES / 2], axis=1)
    scene = SCENE | {"discs": [{"name": "disc"}], "fluid": SCENE["fluid"] | {"gravity": [0.0, -5.0]}}
    for factor, expected in ((1.0, 0.0), (1.1, 0.21)):
        discs = {"disc": fields(position, velocity_y=-factor * speed)}
        result = write(
            tmp_path / str(factor), discs, run=RUN, scene=scene, series={"kinetic_energy": 0 * TIMES}
        )
        assert value("energy_created", result) == pytest.approx(expected, abs=1e-12)


def test_rounding_at_rest_is_no_energy(tmp_path):
    assert value("energy_created", moving(tmp_path, 1e-30 * TIMES)) < 1e-12


def test_momentum_must_stay(tmp_path):
    series = {"kinetic_energy": 0.5 + 0 * TIMES, "momentum_x": 1 + 0 * TIMES}
    assert value("momentum_created", fluid(tmp_path / "stays", series)) == 0
    series["momentum_x"] = 1 + 0.01 * TIMES
    scale = np.sqrt(2 * 2 * RUN["particle_mass"] * 0.5)
    assert value("momentum_created", fluid(tmp_path / "grows", series)) == pytest.approx(0.01 / scale)
    with pytest.raises(DataError, match="nothing moves"):
        BUDGETS["momentum_created"](fluid(tmp_path / "rest", {"kinetic_energy": 0 * TIMES}))


def test_energy_growth_compares_the_last_quarters(tmp_path):
    assert value("energy_growth", moving(tmp_path / "steady", 2 + 0 * TIMES)) == 0
    assert value("energy_growth", moving(tmp_path / "step", np.where(TIMES > 0.745, 2.2, 2.0))) == (
        pytest.approx(0.1, rel=0.05)
    )


def test_energy_growth_needs_samples(tmp_path):
    few = np.linspace(0, END, 7)
    series = {"kinetic_energy": few, "momentum_x": few}
    result = write(tmp_path, {"d": fields(np.zeros((7, 2)))}, times=few, series=series, run=RUN, scene=SCENE)
    with pytest.raises(DataError, match="7 samples are too few"):
        BUDGETS["energy_growth"](result)


def test_density_drift(tmp_path):
    density = 2 + 0.02 * TIMES
    assert value("density_drift", fluid(tmp_path, {"mean_density": density})) == pytest.approx(0.01)


@pytest.mark.parametrize("name", ["density_error", "energy_created", "energy_growth", "density_drift"])
def test_what_is_not_a_number_is_refused(tmp_path, name):
    bad = np.where(np.arange(len(TIMES)) == 3, np.nan, 1.0)
    series = dict.fromkeys(("largest_density_error", "kinetic_energy", "mean_density"), bad)
    with pytest.raises(DataError, match="not finite"):
        BUDGETS[name](fluid(tmp_path, series))
