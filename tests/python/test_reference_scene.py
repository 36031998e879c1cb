"""Reading scenes and overrides, the shapes of walls, and the command that makes references."""

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from reference import ReferenceError, walls
from reference.scene import read_scene

ROOT = Path(__file__).resolve().parents[2]
SCENE = """
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
velocity = [1.0, 0.0]
[[walls]]
name = "pad"
fluid_side = "above"
"""
SHAPES = {
    "line": "from = [0, 1e-6]\nto = [4e-5, 1e-6]",
    "cosine": "mean_height = 2e-6\namplitude = 1e-6\nwavelength = 2e-5\ncrest = 3e-6",
    "gaussian": "base_height = 0\namplitude = 1e-5\ncentre = 3e-5\nwidth = 5e-6",
    "arc": "base_height = 1e-6\ncentre = 3.9e-5\nradius = 5e-6\nangle = 2.0943951023931953\nupward = true",
    "sine": "base_height = 3e-6\namplitude = 2e-6\ncentre = 1e-5\nlength = 1e-5",
    "profile": 'file = "pad.csv"\nbase_height = 1e-6',
}


def write(folder, shape, extra=""):
    x = np.linspace(0, 4e-5, 81)
    np.savetxt(folder / "pad.csv", np.column_stack((x, 2e-6 * np.cos(2 * math.pi * x / 4e-5))), delimiter=",",
               header="x (m), y (m)")  # fmt: skip
    file = folder / "scene.toml"
    file.write_text(f'{SCENE}shape = "{shape}"\n{SHAPES[shape]}\n{extra}')
    return file


def pad(folder, shape):
    scene = read_scene(write(folder, shape), {})
    return walls.graph(scene, scene.walls[1])


@pytest.mark.parametrize("shape", SHAPES)
def test_slopes_are_those_of_the_heights(tmp_path, shape):
    graph = pad(tmp_path, shape)
    x = np.linspace(-1e-5, 7e-5, 1601) + 1.23e-9
    away = [np.abs((x - kink + 2e-5) % 4e-5 - 2e-5) > 1e-8 for kink in graph.kinks]
    x = x[np.logical_and.reduce(away)] if away else x
    h = 1e-10
    assert_allclose(graph.slope(x), (graph.height(x + h) - graph.height(x - h)) / (2 * h), atol=1e-5)
    assert_allclose(graph.height(x + 4e-5), graph.height(x), atol=1e-18)
    assert np.diff(graph.height(np.linspace(0, 4e-5, 40001))).max() < 2e-8


def test_shapes_have_their_heights(tmp_path):
    expected = {
        "line": (0.0, 1e-6), "cosine": (3e-6, 3e-6), "gaussian": (3e-5, 1e-5), "arc": (3.9e-5, 3.5e-6),
        "sine": (1.25e-5, 5e-6), "profile": (4e-5, 3e-6),
    }  # fmt: skip
    for shape, (x, height) in expected.items():
        assert pad(tmp_path, shape).height(np.array([x])) == pytest.approx(height, rel=1e-6)


def test_overrides_reach_tables_and_named_walls(tmp_path):
    file = write(tmp_path, "cosine")
    scene = read_scene(file, {"walls.pad.velocity": [-1, 0], "walls": {"wafer": {"velocity": [0, 0]}}})
    assert [wall.velocity for wall in scene.walls] == [(0.0, 0.0), (-1.0, 0.0)]
    assert read_scene(file, {"start.speed": 2}).start_speed == 2


@pytest.mark.parametrize(
    ("overrides", "reason"),
    [
        ({"walls.floor.velocity": [0, 0]}, "no 'floor' here, only wafer, pad"),
        ({"walls.pad.velocty": [0, 0]}, "walls.pad.velocty is not a key"),
        ({"walls.pad": 3}, "must follow|must be a table"),
        ({"fluid.density": "heavy"}, "fluid.density = 'heavy' must be a finite number"),
        ({"fluid.density": -1}, "must be positive"),
        ({"fluid.dynamic_viscosity": math.nan}, "finite"),
        ({"fluid.viscosity": 1}, "fluid.viscosity is not a key"),
        ({"domain.upper": [1.0]}, "two numbers"),
        ({"domain.upper": [0.0, 0.0]}, "must exceed"),
        ({"domain.periodic": "z"}, "one of none, x, y, xy"),
        ({"walls.pad.shape": "square"}, "one of line, cosine"),
        ({"walls.pad.shape": "arc"}, "walls.pad.base_height is missing"),
        ({"fluid.density.kind": 1}, "is a value, not a table"),
    ],
)
def test_bad_values_are_refused(tmp_path, overrides, reason):
    with pytest.raises(ReferenceError, match=reason) as caught:
        read_scene(write(tmp_path, "cosine"), overrides)
    assert "scene.toml" in str(caught.value)


def test_unreadable_files_are_refused(tmp_path):
    with pytest.raises(ReferenceError, match="not a readable scene"):
        read_scene(tmp_path / "none.toml", {})
    (tmp_path / "bad.toml").write_text("[domain\n")
    with pytest.raises(ReferenceError, match="line 1"):
        read_scene(tmp_path / "bad.toml", {})
    scene = write(tmp_path, "profile")
    for content, reason in (
        ("0,0\n1,nan\n2,0\n3,0\n", "finite"),
        ("0,0\n", "four rows"),
        ("a,b\n", "readable"),
        ("0,0\n2,0\n1,0\n3,0\n", "increase"),
    ):
        (tmp_path / "pad.csv").write_text(content)
        with pytest.raises(ReferenceError, match=reason):
            read_scene(scene, {})


def make(folder, *arguments):
    command = [sys.executable, "-m", "reference.make", "--cache", str(folder / "cache"), *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120, check=False)


def test_make_makes_the_references_of_cases(tmp_path):
    case = tmp_path / "cases" / "plane"
    case.mkdir(parents=True)
    (case / "checks.toml").write_text(
        'reference = "start_up_couette"\n[[variants]]\nname = "slow"\n[[variants]]\nname = "fast"\n'
        'set = { "walls.wafer.velocity" = [2.0, 0.0] }\n'
    )
    write(case, "line")
    done = make(tmp_path, "--verification", tmp_path / "cases")
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("exact, own error") == 2
    assert "plane fast" in done.stdout
    unknown = make(tmp_path, "--verification", tmp_path / "cases", "plain")
    assert (unknown.returncode, unknown.stdout) == (2, "")
    assert "no case 'plain'; there are: plane" in unknown.stderr


def test_make_says_so_when_there_is_nothing_to_make(tmp_path):
    done = make(tmp_path, "--verification", tmp_path)
    assert done.returncode == 0
    assert "no cases yet" in done.stdout


def test_make_takes_a_scene(tmp_path):
    scene = write(tmp_path, "line")
    assert "exact" in make(tmp_path, "--scene", scene, "--reference", "start_up_couette").stdout
    assert make(tmp_path, "--scene", scene).returncode == 2
    refused = make(tmp_path, "--scene", scene, "--reference", "taylor_green")
    assert refused.returncode == 2
    assert "scene.toml: taylor_green needs" in refused.stderr
