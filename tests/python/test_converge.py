"""`slurry converge` as a user meets it, and the judgement of its bands against the truth."""

from __future__ import annotations

import json
import math
import shlex
import signal
import subprocess
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest
from test_cli import SCENE, SLURRY, slurry

from verification import converge


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A study of the other tests' Couette channel, 20 spacings high at its finest, and what it printed."""
    folder = tmp_path_factory.mktemp("study")
    (folder / "scene.toml").write_text(SCENE)
    done = slurry("converge", "scene.toml", "--spacing", "5e-7", "--quiet", "--error", "5%", cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
    return folder / "scene.converge", done.stdout


def test_every_probe_has_a_row_in_table_and_file(study: tuple[Path, str]) -> None:
    folder, printed = study
    stored = json.loads((folder / "convergence.json").read_text())
    rows = {(row["place"], row["quantity"]): row for row in stored["quantities"]}
    assert {place for place, _ in rows} == {"flow", "wafer", "centre", "field"}
    for place, quantity in rows:
        assert any(line.split()[:2] == [place, quantity] for line in printed.splitlines())
    assert len(stored["runs"]) == 3
    spacings = [run["spacing_m"] for run in stored["runs"]]
    assert spacings == sorted(spacings, reverse=True)
    assert spacings[-1] == pytest.approx(5e-7)
    assert stored["twice_the_sound_speed"]["sound_speed_m_per_s"] == pytest.approx(20)
    assert all(row["band"] is None or row["band"] >= 0 for row in rows.values())
    assert stored["plans"][0]["error"] == pytest.approx(0.05)
    assert "a band of 5 %" in printed


def test_the_figure_is_well_formed(study: tuple[Path, str]) -> None:
    root = ElementTree.parse(study[0] / "convergence.svg").getroot()
    assert root.tag.endswith("svg")
    assert not list(study[0].rglob("*.partial"))


def test_the_runs_can_be_read_like_any_other(study: tuple[Path, str]) -> None:
    assert len(list(study[0].glob("*/result.h5"))) == 4


def test_a_spacing_that_was_changed_is_told(study: tuple[Path, str], tmp_path: Path) -> None:
    assert "becomes" not in study[1]
    (tmp_path / "scene.toml").write_text(SCENE)
    done = slurry(
        "converge", "scene.toml", "--spacing", "5.3e-7", "--set", "output.end_time=1e-7", cwd=tmp_path
    )
    first = done.stdout.splitlines()[0]
    assert first.startswith("spacing 5.3e-07 m becomes 5.2632e-07 m so that the domain's sides, ")
    stored = json.loads((tmp_path / "scene.converge/convergence.json").read_text())
    assert stored["asked_spacing_m"] == pytest.approx(5.3e-7)
    assert stored["runs"][-1]["spacing_m"] == pytest.approx(1e-5 / 19)


def test_an_interrupted_study_says_how_to_go_on_and_does(tmp_path: Path) -> None:
    (tmp_path / "my scene.toml").write_text(SCENE)
    words = ["converge", "my scene.toml", "--spacing", "2.5e-7", "--set", "output.end_time=4e-5", "--quiet"]
    process = subprocess.Popen([SLURRY, *words], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    studied = tmp_path / "my scene.converge"
    while not list(studied.glob("*/result.h5")):  # the coarsest is through, the next one runs
        time.sleep(1e-3)
        assert process.poll() is None
    process.send_signal(signal.SIGTERM)
    complaint = process.communicate()[1]
    command = f"slurry {' '.join(words).replace('my scene.toml', repr('my scene.toml'))} --reuse"
    assert process.returncode == 4
    assert complaint.startswith("ended by SIGTERM after step ") and complaint.endswith(
        f"to go on: {command}\n"
    )
    kept = {path: path.stat().st_mtime_ns for path in studied.glob("*/result.h5")}
    assert len(list(studied.glob("*/checkpoint.h5"))) == 1
    done = slurry(*shlex.split(command)[1:], cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert kept.items() <= {path: path.stat().st_mtime_ns for path in studied.glob("*/result.h5")}.items()
    assert not list(studied.glob("*/checkpoint.h5")) and (studied / "convergence.svg").exists()


def test_runs_of_the_same_scene_are_kept_when_asked_for(study: tuple[Path, str]) -> None:
    files = {path: path.stat().st_mtime_ns for path in study[0].glob("*/result.h5")}
    words = ("converge", "scene.toml", "--spacing", "5e-7", "--quiet", "--reuse")
    assert slurry(*words, cwd=study[0].parent).returncode == 0
    assert files == {path: path.stat().st_mtime_ns for path in files}
    assert slurry(*words, "--set", "output.end_time=9e-7", cwd=study[0].parent).returncode == 0
    assert not any(stamp == path.stat().st_mtime_ns for path, stamp in files.items())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--error", "0"], "--error"),
        (["--error", "abc"], "--error"),
        (["--spacings", "2"], "--spacings"),
        (["--spacings", "9"], "choose a smaller --spacing"),
        (["--spacing", "1e-6"], "choose a smaller --spacing"),
    ],
)
def test_bad_wishes_are_refused_in_one_line(tmp_path: Path, words: list[str], said: str) -> None:
    (tmp_path / "scene.toml").write_text(SCENE)
    done = slurry("converge", "scene.toml", *words, "--quiet", cwd=tmp_path)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert said in done.stderr
    assert not list(tmp_path.rglob("result.h5"))


def row(**changes: Any) -> dict[str, Any]:
    return {
        "place": "flow", "quantity": "kinetic_energy", "verdict": "converging", "taken": "mean",
        "from_s": 1.0, "order": 2.0, "value": 5.0, "band": 0.5, "band_of_spacing": 0.4, "scale": 5.0,
    } | changes  # fmt: skip


def test_a_mean_is_held_against_the_mean_of_the_truth() -> None:
    judged = converge.judge(row(), lambda time: 3 * time, end_time=2.0)
    assert judged["truth"] == pytest.approx(4.5)
    assert judged["covered"]
    assert not converge.judge(row(taken="final"), lambda time: 3 * time, end_time=2.0)["covered"]


def test_a_band_that_is_too_narrow_or_missing_does_not_cover() -> None:
    assert not converge.judge(row(band=0.4), lambda time: 4.5, end_time=2.0)["covered"]
    assert not converge.judge(row(band=None), lambda time: 5.0, end_time=2.0)["covered"]


def test_a_truth_that_is_not_a_number_is_an_error() -> None:
    with pytest.raises(converge.DataError):
        converge.judge(row(), lambda time: math.nan, end_time=2.0)


def test_refusals_count_apart() -> None:
    rows = [
        {"band": 1.0, "error": 0.5, "covered": True},
        {"band": 1.0, "error": 4.0, "covered": False},
        {"band": None, "error": 1.0, "covered": False},
    ]
    found = converge.summary(rows)
    assert (found["bands"], found["covered"], found["coverage"]) == (2, 1, 0.5)
    assert found["refused"] == pytest.approx(1 / 3)
    assert found["band_over_error"] == pytest.approx((2 + 0.25) / 2)
    assert math.isnan(converge.summary([])["coverage"])


@pytest.mark.parametrize(("covered", "refused", "status"), [(9, 0, 0), (8, 0, 1), (9, 9, 1), (0, 10, 1)])
def test_few_covering_bands_and_many_refusals_fail(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, covered: int, refused: int, status: int
) -> None:
    rows = [{**row(), "study": "one", "error": 0.1, "covered": k < covered} for k in range(10)]
    for k in range(refused):
        rows[9 - k] |= {"band": None, "covered": False}
    monkeypatch.setattr(converge, "run_study", lambda study, *_: rows if study["case"] == "couette" else [])
    assert converge.main(["--solver", "/bin/true", "--out", str(tmp_path)]) == status
    assert (tmp_path / converge.RESULTS).exists()
