"""A run that is killed at any moment and resumed gives the same numbers as one left alone, bit for bit.

`make test` kills a few times; `make test-kill` 50 times (pytest option --kills).
"""

from __future__ import annotations

import os
import random
import re
import resource
import signal
import subprocess
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from test_cli import ROOT, SCENE, SLURRY, assert_refused, limit_file_size, slurry

# What is measured of the machine, not of the flow.
MEASURED = re.compile(r"threads|wall_seconds|seconds_.*|particle_steps_per_second|bytes_per_particle")
DISCS = """
[[discs]]
name = "abrasives"
placement = "random"
density = 2000.0
radius = 1e-6
count = 2

[start]
arrangement = "jittered"
"""


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scene of a second or so, with discs, probes and snapshots, and its result on one thread."""
    scene = tmp_path_factory.mktemp("alone") / "scene.toml"
    text = SCENE.replace("spacing = 1e-6", "spacing = 2.5e-7").replace("end_time = 1e-6", "end_time = 1e-5")
    scene.write_text(text.replace("[0.0]\n", "[0.0, 2e-6, 6e-6]\n") + DISCS)
    done = slurry("run", scene, "--quiet", "--threads", "1", cwd=scene.parent)
    assert (done.returncode, done.stderr) == (0, "")
    return scene


def contents(path: Path) -> dict[str, bytes]:
    """Every dataset and attribute of a result, by name, as bytes."""
    found: dict[str, bytes] = {}

    def note(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            found[name] = f"{item.shape} {item.dtype} ".encode() + np.asarray(item[...]).tobytes()
        for key, value in item.attrs.items():
            if not MEASURED.fullmatch(key):
                found[f"{name}@{key}"] = value.encode() if isinstance(value, str) else value.tobytes()

    with h5py.File(path) as file:
        file.visititems(note)
        note("", file)
    return found


def assert_same_result(folder: Path, alone: Path, ignored: str = "@scene") -> None:
    expected, got = (contents(path / "result.h5") for path in (alone.parent / "scene.out", folder))
    assert [name for name in expected | got if expected.get(name) != got.get(name) and name != ignored] == []
    assert (folder / "result.xdmf").read_bytes() == (alone.parent / "scene.out/result.xdmf").read_bytes()
    assert sorted(path.name for path in folder.iterdir()) == ["result.h5", "result.xdmf"]


def start(scene: Path, folder: Path, threads: int, interval: float = 1e-3) -> subprocess.Popen[str]:
    """Start a run, or go on from its checkpoint where there is one."""
    target = ["--resume", folder] if any(folder.glob("checkpoint*.h5")) else ["--out", folder, scene]
    words = ["run", *target, "--checkpoint-interval", interval, "--quiet", "--threads", threads]
    environment = os.environ | {"OMP_WAIT_POLICY": "passive"}
    return subprocess.Popen([SLURRY, *map(str, words)], stderr=subprocess.PIPE, text=True, env=environment)


def run_with_kills(scene: Path, folder: Path, most: int, generator: random.Random) -> int:
    """Kill the run at random moments, at most so often, and let it come to its end. Returns how often."""
    for kill in range(most + 1):
        process = start(scene, folder, threads=1 + kill % 2, interval=generator.choice([0, 0.05, 0.2]))
        try:
            process.wait(timeout=generator.uniform(0, 0.6) if kill < most else 120)
        except subprocess.TimeoutExpired:
            process.kill()
        complaint = process.communicate()[1]
        # Killed between two renames there is only the one before.
        assert complaint == "" or complaint.endswith("is not there; going on from the one before\n")
        assert process.returncode in (0, -signal.SIGKILL)
        if process.returncode == 0:
            break
    return kill


def test_killed_at_random_moments(alone: Path, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    generator = random.Random(1)
    kills = 0
    while kills < request.config.getoption("kills"):
        folder = tmp_path / f"run_{kills}"
        kills += run_with_kills(alone, folder, request.config.getoption("kills") - kills, generator)
        assert_same_result(folder, alone)


@pytest.fixture
def interrupted(alone: Path, tmp_path: Path) -> Path:
    """A folder with two checkpoints, as a run leaves it that gets SIGTERM."""
    folder = tmp_path / "interrupted"
    process = start(alone, folder, threads=1)
    while not (folder / "checkpoint.previous.h5").exists():
        time.sleep(1e-3)
        assert process.poll() is None
    process.send_signal(signal.SIGTERM)
    complaint = process.communicate()[1]
    assert process.returncode == 4
    assert "SIGTERM" in complaint and f"slurry run --resume {folder}\n" in complaint
    assert len(complaint.splitlines()) == 1
    assert sorted(path.name for path in folder.iterdir()) == ["checkpoint.h5", "checkpoint.previous.h5"]
    return folder


@pytest.mark.parametrize("named", [True, False])
@pytest.mark.parametrize("threads", [1, 2])
def test_interrupted_and_resumed(alone: Path, interrupted: Path, threads: int, named: bool) -> None:
    words = ["--resume", interrupted, "--quiet", "--threads", threads, "--checkpoint-interval", 600]
    done = slurry("run", *([alone] if named else []), *map(str, words), cwd=interrupted.parent)
    assert (done.returncode, done.stderr) == (0, "")
    assert_same_result(interrupted, alone)


def test_resumed_run_warns_of_the_density_before_its_checkpoint(tmp_path: Path) -> None:
    """The start, where the density is off, is in the interrupted part."""
    scene = tmp_path / "scene.toml"
    jump = {
        "velocity = [1.0, 0.0]": "",
        "crest = 0.0": "velocity = [1.0, 0.0]",
        "spacing = 2.5e-7": "spacing = 1e-6",
        "end_time = 9e-5": "end_time = 6e-4\nseries_samples = 8001\n[start]\nimpulse = false",
    }
    text = (ROOT / "verification/rough_channel/scene.toml").read_text()
    for old, new in jump.items():
        assert old in text
        text = text.replace(old, new)
    scene.write_text(text)
    whole = slurry("run", scene, "--quiet", cwd=tmp_path)
    folder = tmp_path / "interrupted"
    process = start(scene, folder, threads=1)
    while not (folder / "checkpoint.previous.h5").exists():
        time.sleep(1e-3)
        assert process.poll() is None
    process.send_signal(signal.SIGTERM)
    process.communicate()
    assert process.returncode == 4
    done = slurry("run", "--resume", folder, "--quiet", cwd=tmp_path)
    said, expected = (ended.stderr.splitlines()[-1].split(": ")[2:] for ended in (done, whole))
    assert done.returncode == 0 and "the density was up to" in said[0]
    assert said == expected


def test_damaged_checkpoint_is_seen_and_the_one_before_taken(alone: Path, interrupted: Path) -> None:
    checkpoint = interrupted / "checkpoint.h5"
    data = bytearray(checkpoint.read_bytes())
    data[len(data) // 2] ^= 1
    checkpoint.write_bytes(data)
    words = ["--resume", interrupted, "--quiet", "--checkpoint-interval", "600"]
    done = slurry("run", *words, cwd=interrupted.parent)
    assert done.returncode == 0
    assert len(done.stderr.splitlines()) == 1
    assert "warning:" in done.stderr and "checksum" in done.stderr and str(checkpoint) in done.stderr
    assert_same_result(interrupted, alone)


def test_no_good_checkpoint_is_refused(interrupted: Path) -> None:
    for path in interrupted.iterdir():
        path.write_bytes(path.read_bytes()[:-1])
    done = slurry("run", "--resume", interrupted, cwd=interrupted.parent)
    assert_refused(done, "checkpoint.h5: it is cut short", "checkpoint.previous.h5: it is cut short")
    assert_refused(slurry("run", "--resume", "absent", cwd=interrupted.parent), "absent/checkpoint.h5")


def test_another_scene_is_refused(alone: Path, interrupted: Path) -> None:
    before = {path.name: path.read_bytes() for path in interrupted.iterdir()}
    change = ["--set", "numerics.sound_speed=20"]
    for words in ([alone, *change], change):
        done = slurry("run", "--resume", interrupted, *words, cwd=interrupted.parent)
        assert_refused(done, "numerics.sound_speed = 10.0, here 20.0", str(interrupted / "checkpoint.h5"))
    assert {path.name: path.read_bytes() for path in interrupted.iterdir()} == before


def test_new_run_over_a_checkpoint_says_so(alone: Path, interrupted: Path) -> None:
    done = slurry("run", alone, "--out", interrupted, "--quiet", cwd=interrupted.parent)
    assert done.returncode == 0
    assert done.stderr.startswith("warning:") and "slurry run --resume" in done.stderr
    assert_same_result(interrupted, alone)


@pytest.mark.parametrize(
    "words", [["--resume"], ["--resume", "a", "--out", "b"], ["--checkpoint-interval", "x"]]
)
def test_bad_command_line(alone: Path, words: list[str]) -> None:
    assert_refused(slurry("run", alone, *words, cwd=alone.parent))


# Places that fail


def test_checkpoint_that_cannot_be_written_does_not_end_the_run(alone: Path, tmp_path: Path) -> None:
    """The result alone would fit."""
    limit = limit_file_size(1_000_000)
    words = [
        "--set",
        "output.snapshot_times=[]",
        "--checkpoint-interval",
        "1e-3",
        "--quiet",
        "--out",
        tmp_path / "out",
    ]
    done = slurry("run", alone, *words, cwd=tmp_path, before=limit)
    assert done.returncode == 0, done.stderr
    assert "warning: no checkpoint at step" in done.stderr and "File too large" in done.stderr
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["result.h5", "result.xdmf"]


def test_full_disk_keeps_the_checkpoint(alone: Path, interrupted: Path) -> None:
    size = (interrupted / "checkpoint.h5").stat().st_size
    done = slurry("run", "--resume", interrupted, "--quiet", cwd=ROOT, before=limit_file_size(size // 4))
    assert_refused(done, "result.h5.partial", "File too large")
    words = ["--resume", interrupted, "--quiet", "--checkpoint-interval", "600"]
    assert slurry("run", *words, cwd=ROOT).returncode == 0
    assert_same_result(interrupted, alone)


@pytest.mark.parametrize("mebibytes", [60, 75, 90])
def test_out_of_memory_has_a_clear_end(alone: Path, tmp_path: Path, mebibytes: int) -> None:
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (mebibytes << 20, mebibytes << 20))

    words = [
        "--spacing",
        "2e-8",
        "--set",
        "output.end_time=1e-10",
        "--set",
        "output.snapshot_times=[]",
        "--threads",
        "1",
        "--quiet",
    ]
    done = slurry("run", alone, *words, "--out", tmp_path / "out", cwd=tmp_path, before=limit)
    assert_refused(done, "out of memory")
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())


def test_failed_state_is_set_aside_and_the_good_one_kept(alone: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    words = ["--set", "start.velocity=shear", "--set", "start.speed=30", "--quiet"]
    done = slurry("run", alone, *words, "--out", folder, cwd=tmp_path)
    assert_refused(done, "step ", "time ", str(folder / "failed.h5"), "raise numerics.sound_speed", status=3)
    assert sorted(path.name for path in folder.iterdir()) == ["failed.h5", "failed.xdmf"]
    with h5py.File(folder / "failed.h5") as file:
        last = sorted(file["snapshots"])[-1]
        assert file["run"].attrs["steps"] > 0
        assert len(file[f"snapshots/{last}/position_x"]) > file["run"].attrs["fluid_particles"]
    assert slurry("run", alone, "--quiet", "--out", folder, cwd=tmp_path).returncode == 0
    assert_same_result(folder, alone)
