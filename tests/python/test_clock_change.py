"""A clock of the machine that is set back or forward changes neither numbers nor checkpoints of a run.

libfaketime stands between the run and the clock: calls for the time of day are answered from a file, those
for the steady clock by the machine.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from test_cli import SCENE, SLURRY, slurry
from test_resume import DISCS, assert_same_result

LIBRARIES = sorted(Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"))
DAY = 86400.0  # s


@pytest.fixture
def clock(tmp_path: Path) -> Path:
    """A file that says by how much the clock is off, and an environment in which it is."""
    if not LIBRARIES:
        pytest.skip("Debian's libfaketime is not installed (packages.apt)")
    file = tmp_path / "clock"
    file.write_text("+0\n")
    return file


def faked(clock: Path) -> dict[str, str]:
    return os.environ | {
        "LD_PRELOAD": str(LIBRARIES[0]),
        "FAKETIME_TIMESTAMP_FILE": str(clock),
        "FAKETIME_NO_CACHE": "1",
        "DONT_FAKE_MONOTONIC": "1",
        "OMP_WAIT_POLICY": "passive",
    }


def set_clock(clock: Path, offset: str) -> None:
    partial = clock.with_suffix(".partial")
    partial.write_text(offset + "\n")
    partial.replace(clock)


def changed(path: Path) -> int | None:
    """When, by the machine's clock; None if it is not there."""
    with contextlib.suppress(FileNotFoundError):
        return path.stat().st_mtime_ns
    return None


def wait_for_checkpoint(folder: Path, process: subprocess.Popen[str]) -> None:
    """Until there is another one, and the run has noted when: a jump before that would not matter to it."""
    path = folder / "checkpoint.h5"
    before = changed(path)
    while changed(path) in (None, before):
        assert process.poll() is None, "the run came to its end without another checkpoint"
        time.sleep(1e-3)
    time.sleep(0.02)


def test_the_clock_of_a_process_is_off_by_what_the_file_says(clock: Path) -> None:
    words = [sys.executable, "-c", "import time; print(time.time(), time.monotonic())"]
    for days in (-3, 400):
        set_clock(clock, f"{days:+d}d")
        told = subprocess.run(words, env=faked(clock), capture_output=True, text=True, check=True).stdout
        of_day, steady = map(float, told.split())
        assert of_day - time.time() == pytest.approx(days * DAY, abs=60)
        assert steady == pytest.approx(time.monotonic(), abs=60)


def test_a_clock_that_jumps_disturbs_no_run(clock: Path, tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    text = SCENE.replace("spacing = 1e-6", "spacing = 2.5e-7").replace("end_time = 1e-6", "end_time = 1e-4")
    scene.write_text(text + DISCS)
    done = slurry("run", scene, "--quiet", "--threads", "1", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    folder = tmp_path / "disturbed"
    words = ["run", scene, "--out", folder, "--checkpoint-interval", "0.05", "--quiet", "--threads", "1"]
    process = subprocess.Popen(
        [SLURRY, *map(str, words)], env=faked(clock), stderr=subprocess.PIPE, text=True
    )
    for offset in ("-3d", "+400d", "-3d"):
        wait_for_checkpoint(folder, process)
        set_clock(clock, offset)
    wait_for_checkpoint(folder, process)
    assert (process.communicate()[1], process.returncode) == ("", 0)
    assert_same_result(folder, scene)
