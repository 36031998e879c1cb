"""The executable as a user meets it: exit statuses, one-line errors, and nothing half-written.

Statuses: 0 good, 2 bad input or output that cannot be written, 3 a run that went wrong, 4 one that was
interrupted (test_resume.py).
"""

from __future__ import annotations

import ctypes
import fcntl
import json
import os
import resource
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO

import h5py
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
SLURRY = Path(os.environ.get("SLURRY", ROOT / "build" / "slurry"))

# Couette flow in a periodic channel, 10 spacings high: a run takes well under a second.
SCENE = """\
[domain]
lower = [0.0, 0.0]
upper = [1e-5, 1e-5]
periodic = "x"

[fluid]
density = 1000.0
dynamic_viscosity = 1e-3

[numerics]
particle_spacing = 1e-6
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

[[probes]]
name = "wafer"
kind = "wall"
wall = "wafer"
points = 7

[[probes]]
name = "centre"
kind = "point"
position = [5e-6, 5e-6]

[[probes]]
name = "field"
kind = "grid"
points = [3, 5]

[output]
end_time = 1e-6
series_samples = 11
probe_samples = 4
snapshot_times = [0.0]
"""
PAD = """\
shape = "line"
from = [0.0, 0.0]
to = [1e-5, 0.0]
"""
DISC = """
[[discs]]
name = "abrasive"
placement = "single"
density = 2000.0
radius = 2e-6
position = [5e-6, 5e-6]
"""
WAVY_PAD = """\
shape = "cosine"
mean_height = {mean}
amplitude = 4e-6
wavelength = 1e-5
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def slurry(
    *words: str | Path,
    cwd: Path,
    stdout: int | IO[str] = subprocess.PIPE,
    before: Callable[[], None] | None = None,
) -> subprocess.CompletedProcess[str]:
    """Run the executable; `before` is called in its process first."""
    assert SLURRY.is_file(), f"{SLURRY} is missing: make build"
    return subprocess.run(
        [SLURRY, *map(str, words)],
        cwd=cwd,
        # Threads that spin while they wait make tests that run side by side a hundred times slower.
        env=os.environ | {"OMP_WAIT_POLICY": "passive"},
        stdout=stdout,
        stderr=subprocess.PIPE,
        text=True,
        timeout=120,
        check=False,
        preexec_fn=before,
    )


def assert_refused(done: subprocess.CompletedProcess[str], *parts: str, status: int = 2) -> None:
    assert done.returncode == status, (done.returncode, done.stderr)
    assert done.stderr.endswith("\n")
    assert len(done.stderr.splitlines()) == 1, done.stderr
    for part in parts:
        assert part in done.stderr


def line_of(text: str, found: str) -> int:
    return text[: text.index(found)].count("\n") + 1


# Good input


def test_version_and_help(tmp_path: Path) -> None:
    done = slurry("--version", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("slurry 0.") or done.stdout.startswith("slurry v")
    for words in (["--help"], ["run", "--help"], ["help", "scene"], ["help", "scene", "--markdown"]):
        done = slurry(*words, cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")
    assert "particle_spacing" in done.stdout


def test_check_prints_one_line(scene: Path) -> None:
    done = slurry("check", scene, cwd=scene.parent)
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{scene}: ok, 100 fluid particles\n", "")


def test_spacing_and_set_reach_the_scene(scene: Path) -> None:
    for words in (["--spacing", "5e-7"], ["--set", "numerics.particle_spacing=5e-7"]):
        done = slurry("check", *words, scene, cwd=scene.parent)
        assert (done.returncode, done.stderr) == (0, "")
        assert "400 fluid particles" in done.stdout


def test_check_counts_and_warns_of_discs(scene: Path) -> None:
    scene.write_text(SCENE + DISC)
    done = slurry("check", scene, cwd=scene.parent)
    assert done.returncode == 0
    assert done.stdout.endswith(" fluid particles, 1 disc\n")
    line = line_of(SCENE + DISC, "radius")
    assert done.stderr.startswith(f'warning: {scene}:{line}:10: found a disc "abrasive" of radius 2e-06 (m)')
    assert len(done.stderr.splitlines()) == 1
    done = slurry("check", scene, "--spacing", "5e-7", cwd=scene.parent)
    assert (done.returncode, done.stderr) == (0, "")


def test_discs_without_room_are_refused(scene: Path) -> None:
    scene.write_text(SCENE + DISC)
    change = "discs.abrasive.position=[5e-6, 1e-6]"
    done = slurry("check", scene, "--spacing", "5e-7", "--set", change, cwd=scene.parent)
    assert_refused(done, f"{scene}: disc 'abrasive' at", "1e-06 m behind wall 'pad'")


def test_info_tells_which_terms_run(scene: Path) -> None:
    done = slurry("info", scene, "--set", "numerics.density_diffusion=0", cwd=scene.parent)
    assert (done.returncode, done.stderr) == (0, "")
    assert "100" in done.stdout
    assert "\nlimited by        sound: numerics.acoustic_cfl" in done.stdout
    off = [line for line in done.stdout.splitlines() if "Molteni" in line]
    assert len(off) == 1 and off[0].split()[0] == "off"


def test_check_and_run_warn_of_coarse_spacings_and_of_walls_that_jump(scene: Path) -> None:
    """Wafer and wavy pad go the same way: seen from the pad both are at rest."""
    text = SCENE.replace(PAD, WAVY_PAD.format(mean=4e-6) + "velocity = [1.0, 0.0]\n")
    scene.write_text(text.replace("dynamic_viscosity = 1e-3", "dynamic_viscosity = 2.5e-6"))
    short = ["--spacing", "2.5e-7", "--set", "output.end_time=1e-8", "--set", "start.impulse=false"]
    for words in (["check"], ["run", "--quiet"]):
        done = slurry(*words, scene, *short, cwd=scene.parent)
        assert done.returncode == 0
        coarse, jumps = done.stderr.splitlines()
        assert coarse.startswith("warning: --set numerics.particle_spacing=2.5e-7: found numerics.")
        assert "a cell Reynolds number of 100, advised at most 50" in coarse
        assert jumps.startswith(f"warning: {scene}: the wall 'pad' starts at once")
        assert "set walls.wafer.velocity=[0, 0]" in jumps


def test_run_that_ends_with_a_density_too_far_off_says_so(tmp_path: Path) -> None:
    """The pad of the rough channel jumps to full speed; --quiet is about progress, not about warnings."""
    scene = ROOT / "verification/rough_channel/scene.toml"
    short = ["--spacing", "1e-6", "--set", "output.end_time=1e-6", "--quiet", "--out", "out"]
    jump = ["walls.wafer.velocity=[0, 0]", "walls.pad.velocity=[-1, 0]", "start.impulse=false"]
    done = slurry("run", scene, *short, *(f"--set={key}" for key in jump), cwd=tmp_path)
    assert (done.returncode, done.stdout) == (0, "")
    with h5py.File(tmp_path / "out/result.h5") as file:
        errors, times = (file[f"series/{name}"][...] for name in ("largest_density_error", "time"))
        when = times[errors.argmax()]
        step = round(when / file["run"].attrs["time_step"])
    said = f"the density was up to {100 * errors.max():.3g} % off, at step {step}, time {when:.6g} s"
    warning = done.stderr.splitlines()[-1]
    assert warning.startswith(f"warning: out/result.h5: {said}; allowed 5 %") and "the wall 'pad'" in warning
    done = slurry("run", scene, *short, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")


def test_run_writes_the_whole_result(scene: Path) -> None:
    done = slurry("run", scene, "--threads", "1", cwd=scene.parent)
    assert (done.returncode, done.stderr) == (0, "")
    assert "particle-steps per second" in done.stdout
    folder = scene.parent / "scene.out"
    assert sorted(path.name for path in folder.iterdir()) == ["result.h5", "result.xdmf"]
    with h5py.File(folder / "result.h5") as file:
        assert "[numerics]" in file.attrs["scene"] and "acoustic_cfl" in file.attrs["scene"]
        assert file["run"].attrs["fluid_particles"] == 100
        assert file["run"].attrs["end_time"] == pytest.approx(1e-6)
        assert file["series/time"].shape == file["series/kinetic_energy"].shape == (11,)
        assert np.all(np.isfinite(file["series/kinetic_energy"]))
        samples = len(file["probes/wafer/time"])
        assert file["probes/wafer/shear"].shape == file["probes/wafer/pressure"].shape == (samples, 7)
        assert file["probes/centre/velocity_x"].shape == file["probes/centre/time"].shape
        assert file["probes/field/velocity_x"].shape == (len(file["probes/field/time"]), 15)
        times = [float(group.attrs["time"]) for group in file["snapshots"].values()]
        assert times == pytest.approx([0, 1e-6])
        items: list[h5py.Dataset | h5py.Group] = []
        file.visititems(lambda _, item: items.append(item))
        datasets = [item for item in items if isinstance(item, h5py.Dataset)]
        assert [item.name for item in datasets if not isinstance(item.attrs.get("unit"), str)] == []
    assert "result.h5:/snapshots/0001/velocity" in (folder / "result.xdmf").read_text()


def test_quiet_run_prints_nothing(scene: Path) -> None:
    done = slurry("run", scene, "--quiet", "--out", "a/b", cwd=scene.parent)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (scene.parent / "a" / "b" / "result.h5").is_file()


def test_result_is_replaced_as_a_whole(scene: Path) -> None:
    folder = scene.parent / "scene.out"
    for spacing, particles in (("1e-6", 100), ("5e-7", 400)):
        assert slurry("run", scene, "--quiet", "--spacing", spacing, cwd=scene.parent).returncode == 0
        with h5py.File(folder / "result.h5") as file:
            assert file["run"].attrs["fluid_particles"] == particles
    assert len(list(folder.iterdir())) == 2


@pytest.mark.parametrize("command", ["check", "run"])
def test_covered_probe_and_thin_film_are_warned_of(scene: Path, command: str) -> None:
    pad = WAVY_PAD.format(mean="1e-6").replace("4e-6", "1e-6")
    text = SCENE.replace(PAD, pad).replace("position = [5e-6, 5e-6]", "position = [0.0, 1e-6]")
    scene.write_text(text + DISC.replace("[5e-6, 5e-6]", "[5e-6, 7.8e-6]"))
    words = ["--spacing", "5e-7", "--set", "output.end_time=1e-9"]
    done = slurry(command, scene, *words, cwd=scene.parent)
    assert done.returncode == 0, done.stderr
    probe, film = done.stderr.splitlines()
    assert probe.startswith(f"warning: {scene}: probe 'centre' at (0, 1e-06) m is behind wall 'pad'")
    assert film.startswith(f"warning: {scene}: the film between disc 'abrasive' and wall 'wafer' is 2e-07 m")


@pytest.mark.parametrize("command", ["check", "run", "converge"])
@pytest.mark.parametrize("change", ["output.end_time=600", "fluid.dynamic_viscosity=1e6"])
def test_too_many_steps_are_refused_before_anything_is_written(
    scene: Path, command: str, change: str
) -> None:
    done = slurry(command, scene, "--set", change, cwd=scene.parent)
    assert_refused(done, f"{scene}: found ", " steps of ", "--limit steps=")
    assert list(scene.parent.iterdir()) == [scene]


def test_complete_run_has_nothing_to_resume(scene: Path) -> None:
    assert slurry("run", scene, "--quiet", cwd=scene.parent).returncode == 0
    done = slurry("run", "--resume", "scene.out", cwd=scene.parent)
    assert_refused(done, "scene.out: there is nothing to resume: the run is complete")


@pytest.mark.parametrize(
    ("share", "shown"),
    [("0", "0"), ("0%", "0%"), ("200%", "200%"), ("abc", "abc"), ("%", "%"), ("nan", "nan")],
)
def test_wanted_error_has_to_be_a_share(scene: Path, share: str, shown: str) -> None:
    done = slurry("converge", scene, "--error", share, cwd=scene.parent)
    assert_refused(done, f"--error: found {shown}, allowed a share from 1e-09 to 1, such as 0.01", "1%")
    assert list(scene.parent.iterdir()) == [scene]


def test_bench_prints_and_writes_the_same(tmp_path: Path) -> None:
    done = slurry("bench", "--quick", "--json", "bench.json", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert [path.name for path in tmp_path.iterdir()] == ["bench.json"]
    report = json.loads((tmp_path / "bench.json").read_text())
    assert list(report) == [
        "processor", "cores", "instruction_set", "lanes", "fma_peak_gflops", "pair_sweeps", "search",
    ]  # fmt: skip
    assert report["processor"] in done.stdout and report["instruction_set"] in done.stdout
    sweeps = [(sweep["arithmetic"], sweep["sweep"]) for sweep in report["pair_sweeps"]]
    assert sweeps == [(real, name) for real in ("float", "double") for name in ("density rate", "forces")]


def test_bench_leaves_nothing_when_it_cannot_write(tmp_path: Path) -> None:
    done = slurry("bench", "--quick", "--json", "absent/bench.json", cwd=tmp_path)
    assert_refused(done, "absent/bench.json", "No such file or directory")
    assert done.stdout == ""
    assert not list(tmp_path.iterdir())


# Bad command lines


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["fly"],
        ["run"],
        ["run", "SCENE", "--fast"],
        ["run", "SCENE", "--threads", "0"],
        ["run", "SCENE", "--threads", "-1"],
        ["run", "SCENE", "--threads", "two"],
        ["run", "SCENE", "--out"],
        ["check", "SCENE", "surplus"],
        ["help"],
        ["help", "weather"],
    ],
)
def test_bad_command_line(scene: Path, words: list[str]) -> None:
    done = slurry(*(str(scene) if word == "SCENE" else word for word in words), cwd=scene.parent)
    assert_refused(done, "slurry --help")
    assert list(scene.parent.iterdir()) == [scene]


# Bad scenes: (what is replaced in SCENE, by what, what the message names, whether it has a line)


@pytest.mark.parametrize("command", ["run", "check", "info"])
@pytest.mark.parametrize(
    ("old", "new", "named", "has_line"),
    [
        pytest.param("sound_speed", "sound_sped", "sound_speed", True, id="unknown-key"),
        pytest.param(
            "particle_spacing = 1e-6", "particle_spacing = -1.0", "particle_spacing", True, id="negative"
        ),
        pytest.param("particle_spacing = 1e-6", "particle_spacing = nan", "particle_spacing", True, id="nan"),
        pytest.param("sound_speed = 10.0", 'sound_speed = "fast"', "sound_speed", True, id="wrong-type"),
        pytest.param("density = 1000.0", "density = = 1", "", True, id="syntax"),
        pytest.param("end_time = 1e-6\n", "", "end_time", False, id="missing-key"),
        pytest.param('wall = "wafer"', 'wall = "waver"', "wafer", True, id="unknown-wall"),
        pytest.param(PAD, WAVY_PAD.format(mean="4e-6"), "gap", False, id="narrow-gap"),
        pytest.param(PAD, WAVY_PAD.format(mean="9e-6"), "cross", False, id="crossing-walls"),
    ],
)
def test_bad_scene(scene: Path, command: str, old: str, new: str, named: str, has_line: bool) -> None:
    assert old in SCENE
    scene.write_text(SCENE.replace(old, new))
    done = slurry(command, scene, cwd=scene.parent)
    place = f"{scene}:{line_of(scene.read_text(), new)}:" if has_line else str(scene)
    assert_refused(done, place, named)
    assert done.stdout == ""
    assert list(scene.parent.iterdir()) == [scene], "nothing is written for a scene that is refused"


@pytest.mark.parametrize(
    "words",
    [
        ["--spacing", "-1e-6"],
        ["--spacing", "small"],
        ["--set", "numerics.particle_spacin=1e-6"],
        ["--set", "walls.waver.velocity=[0,0]"],
        ["--set", "numerics.acoustic_cfl"],
    ],
)
def test_bad_override(scene: Path, words: list[str]) -> None:
    assert_refused(slurry("run", scene, *words, cwd=scene.parent), words[1].split("=")[0].split(".")[-1])
    assert list(scene.parent.iterdir()) == [scene]


@pytest.mark.parametrize("name", ["absent.toml", ".", "absent/scene.toml"])
def test_scene_that_cannot_be_read(tmp_path: Path, name: str) -> None:
    assert_refused(slurry("run", name, cwd=tmp_path), name)
    assert not list(tmp_path.iterdir())


# Output that cannot be written


def drop_root_privilege() -> None:
    """Make the permissions of files count for root, too: drop CAP_DAC_OVERRIDE (1) from the bounding set."""
    ctypes.CDLL(None).prctl(24, 1, 0, 0, 0)


def limit_file_size(limit: int) -> Callable[[], None]:
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))


def test_folder_without_permission(scene: Path) -> None:
    closed = scene.parent / "closed"
    closed.mkdir(mode=0o555)
    for out in (closed, closed / "deeper"):
        done = slurry("run", scene, "--quiet", "--out", out, cwd=scene.parent, before=drop_root_privilege)
        assert_refused(done, str(out), "Permission denied")
    assert not list(closed.iterdir())


def test_folder_below_a_file(scene: Path) -> None:
    done = slurry("run", scene, "--quiet", "--out", scene / "out", cwd=scene.parent)
    assert_refused(done, str(scene / "out"), "Not a directory")
    assert scene.read_text() == SCENE


@pytest.fixture(scope="module")
def result_size(tmp_path_factory: pytest.TempPathFactory) -> int:
    folder = tmp_path_factory.mktemp("whole")
    (folder / "scene.toml").write_text(SCENE)
    assert slurry("run", "scene.toml", "--quiet", cwd=folder).returncode == 0
    return (folder / "scene.out" / "result.h5").stat().st_size


@pytest.mark.parametrize("share", [0.0, 0.05, 0.3, 0.6, 0.9, 0.99])
def test_full_disk_leaves_nothing(scene: Path, result_size: int, share: float) -> None:
    """A limit on the size of files stands for the full disk: EFBIG instead of ENOSPC from the same calls."""
    limit = limit_file_size(int(share * result_size))
    done = slurry("run", scene, "--quiet", cwd=scene.parent, before=limit)
    assert_refused(done, "scene.out/result.h5.partial", "File too large")
    assert not list((scene.parent / "scene.out").iterdir())


def test_full_disk_keeps_the_older_result(scene: Path, result_size: int) -> None:
    assert slurry("run", scene, "--quiet", cwd=scene.parent).returncode == 0
    folder = scene.parent / "scene.out"
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    done = slurry("run", scene, "--quiet", cwd=scene.parent, before=limit_file_size(result_size // 2))
    assert_refused(done)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize("words", [["help", "scene"], ["check", "SCENE"], ["info", "SCENE"]])
def test_full_standard_output(scene: Path, words: list[str]) -> None:
    with Path("/dev/full").open("w") as full:
        done = slurry(
            *(str(scene) if word == "SCENE" else word for word in words), cwd=scene.parent, stdout=full
        )
    assert_refused(done, "standard output", "No space left on device")


@pytest.fixture
def foreign_run(scene: Path) -> Iterator[Path]:
    """A file that another run holds."""
    partial = scene.parent / "scene.out" / "result.h5.partial"
    partial.parent.mkdir()
    with partial.open("w") as file:
        file.write("theirs")
        file.flush()
        fcntl.flock(file, fcntl.LOCK_EX)
        yield partial


def test_second_run_into_the_same_folder(scene: Path, foreign_run: Path) -> None:
    assert_refused(slurry("run", scene, "--quiet", cwd=scene.parent), str(foreign_run.name), "another run")
    assert foreign_run.read_text() == "theirs"


def test_partial_file_of_a_killed_run_is_no_hindrance(scene: Path) -> None:
    folder = scene.parent / "scene.out"
    folder.mkdir()
    (folder / "result.h5.partial").write_text("left behind")
    assert slurry("run", scene, "--quiet", cwd=scene.parent).returncode == 0
    assert sorted(path.name for path in folder.iterdir()) == ["result.h5", "result.xdmf"]


# A run that goes wrong


def test_unstable_run_ends_with_status_3(scene: Path) -> None:
    settings = ["start.velocity=shear", "start.speed=30", "output.end_time=1e-4"]
    words = [f"--set={setting}" for setting in settings]
    done = slurry("run", scene, "--quiet", *words, cwd=scene.parent)
    assert_refused(done, "step ", "scene.out/failed.h5", status=3)
    names = sorted(path.name for path in (scene.parent / "scene.out").iterdir())
    assert names == ["failed.h5", "failed.xdmf"]


def test_limits_on_sizes_are_the_users(scene: Path) -> None:
    assert_refused(
        slurry("check", scene, "--limit", "particles=10", cwd=scene.parent),
        "numerics.particle_spacing = 1e-06, about 100 particles",
        "at most 10; --limit particles=101 would allow it",
    )
    assert slurry("check", scene, "--limit", "particles=101", cwd=scene.parent).returncode == 0
    assert_refused(slurry("run", scene, "--limit", "steps=2", cwd=scene.parent), "steps of", "--limit steps=")
    assert_refused(slurry("run", scene, "--limit", "step=2", cwd=scene.parent), "a NAME of particles, discs")
