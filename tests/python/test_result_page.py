"""docs/result.md against a run that has everything: no name is missing there, and none is made up."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
SLURRY = Path(os.environ.get("SLURRY", ROOT / "build" / "slurry"))

# Probes have the names that the page's headings give them.
SCENE = """
[domain]
lower = [0.0, 0.0]
upper = [1e-5, 1e-5]
periodic = "x"
[fluid]
density = 1000.0
dynamic_viscosity = 1e-3
[numerics]
particle_spacing = 5e-7
sound_speed = 10.0
[[walls]]
name = "wafer"
shape = "line"
from = [0.0, 1e-5]
to = [1e-5, 1e-5]
fluid_side = "below"
velocity = [1.0, 0.0]
[[walls]]
name = "pad"
shape = "line"
from = [0.0, 0.0]
to = [1e-5, 0.0]
fluid_side = "above"
[[discs]]
name = "first"
placement = "single"
density = 2000.0
radius = 1e-6
position = [9.5e-6, 7e-6]
velocity = [1.0, 0.0]
motion = "prescribed"
[[discs]]
name = "second"
placement = "single"
density = 2000.0
radius = 1e-6
position = [5e-6, 3e-6]
[[probes]]
name = "WALL"
kind = "wall"
wall = "wafer"
points = 5
[[probes]]
name = "POINT"
kind = "point"
position = [5e-6, 3e-6]
[[probes]]
name = "GRID"
kind = "grid"
points = [4, 3]
[output]
end_time = 1e-6
series_samples = 1000
probe_samples = 2
snapshot_times = [0.0, 1e-12]
"""

Names = dict[str, tuple[str, int]]  # by path: the unit, empty for an attribute, and the number of axes


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> h5py.File:
    folder = tmp_path_factory.mktemp("run")
    (folder / "scene.toml").write_text(SCENE)
    command = [SLURRY, "run", folder / "scene.toml", "--out", folder, "--quiet"]
    subprocess.run(command, check=True, timeout=60)
    with h5py.File(folder / "result.h5") as file:
        yield file


def written_names(page: str) -> Names:
    """What the tables of the page say, each under the heading of its group."""
    names: Names = {}
    for section in re.split(r"^## ", page, flags=re.MULTILINE)[1:]:
        group = re.match(r"`(/[^`]*)`", section).group(1).rstrip("/")
        for name, unit, shape in re.findall(r"^\| `(\w+)` \| ([^|]*?) ?\| ([^|]+) \|", section, re.MULTILINE):
            path = f"{group}/{name}"
            assert path not in names
            names[path] = ("", 0) if shape == "attribute" else (unit, shape.count(",") + 1)
    return names


def found_names(file: h5py.File) -> Names:
    names: Names = {f"/{name}": ("", 0) for name in file.attrs}

    def note(path: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            names[f"/{path}"] = (item.attrs["unit"], item.ndim)
        else:
            names.update({f"/{path}/{name}": ("", 0) for name in item.attrs})

    file.visititems(note)
    return {path: kind for path, kind in names.items() if not re.match(r"/snapshots/(?!0000)", path)}


def test_the_page_has_the_names_units_and_shapes_of_a_run(run):
    written, found = written_names((ROOT / "docs" / "result.md").read_text()), found_names(run)
    assert written == found
    assert len(found) > 70


def test_a_run_is_as_the_page_says(run):
    wall = run["snapshots/0000/wall"][()]
    assert set(wall) == {-1, 0, 1, 2, 3}
    assert run["snapshots/0000/position_y"][wall == 0].min() > 1e-5  # the scene's first wall is the upper one
    assert run["discs"].attrs["names"] == "first,second"
    assert run["discs/position_x"][-1, 0] == pytest.approx(1.05e-5)
    steps = run["run"].attrs["steps"]
    assert len(run["series/time"]) == len(run["discs/time"]) == len(run["probes/POINT/time"]) == steps + 1
    assert list(run["snapshots"]) == ["0000", "0001"]
    assert run["probes/GRID/pressure"].shape == (2, 12)
    assert run["probes/GRID/x"].shape == (4,)
    assert run["run"].attrs["first_contact_time"] == -1


def test_the_grid_runs_along_x_first_and_points_in_discs_are_nan(run):
    speed = run["probes/GRID/velocity_x"][-1].reshape(3, 4)
    assert speed[2, :2].min() > 5 * abs(speed[0]).max()  # near the moving wall, and near the other
    assert np.isnan(run["probes/POINT/pressure"]).all()


def test_the_points_of_a_wall_are_where_it_was_at_the_start(run):
    assert run["probes/WALL/x"][()] == pytest.approx([1e-6, 3e-6, 5e-6, 7e-6, 9e-6])
    assert run["probes/WALL/time"][0] > 0
