"""The table of verification/accuracy.md from errors, and its place in the page."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from verification import ablation
from verification.markers import replace_between

CASE = {"case": "poiseuille", "variant": "poiseuille", "spacing": 5e-7}


def rows(*errors: dict[str, float]) -> list[dict[str, Any]]:
    """One run of each change."""
    return [
        {"name": name, "members": [{"errors": of, "failure": ""}]}
        for name, of in zip(("default scheme", "worse", "better"), errors, strict=True)
    ]


def runs(*errors: float) -> list[dict[str, Any]]:
    return [{"errors": {"velocity": error}, "failure": ""} for error in errors]


def test_only_what_is_beyond_chance_is_marked() -> None:
    found = rows(*[{"velocity": 0.01}] * 3)
    found[0]["members"] = runs(0.01, 0.011, 0.009)
    found[1]["members"] = runs(0.01, 0.03, 0.005)
    found[2]["members"] = runs(0.005, 0.0051, 0.0049)
    lines = ablation.table([(CASE, found)]).splitlines()
    assert lines[2:] == [
        "| default scheme | 1 ± 0.06 |",
        "| worse | 1.5 ± 0.8 |",
        "| better | **0.5 ± 0.006** |",
    ]


def test_runs_that_stop_are_counted() -> None:
    found = rows(*[{"velocity": 0.01}] * 3)
    found[1]["members"] = [*runs(0.01), {"errors": {}, "failure": "exit status 3: a particle left"}]
    assert ablation.table([(CASE, found)]).splitlines()[3] == "| worse | 1 of 2 stop |"


def test_the_table_marks_what_is_better_and_what_is_worse() -> None:
    found = rows({"velocity": 0.01}, {"velocity": 0.02}, {"velocity": 0.005})
    lines = ablation.table([(CASE, found)]).splitlines()
    assert lines[0] == "| change | poiseuille, 5e-07 m: velocity |"
    assert lines[2:] == ["| default scheme | 1 |", "| worse | *2* |", "| better | **0.5** |"]


def test_of_several_times_the_worst_counts() -> None:
    found = rows(*[{"velocity at 1 s": 0.01, "velocity at 2 s": 0.03}] * 3)
    assert ablation.table([(CASE, found)]).splitlines()[2] == "| default scheme | 3 |"


def test_a_run_that_stops_and_a_change_that_a_case_lacks_are_told_apart() -> None:
    found = rows({"velocity": 0.01}, {}, {"velocity": 0.01})
    found[1]["members"][0]["failure"] = "exit status 3: a particle left"
    other = rows({"energy": 0.01}, {"energy": 0.01}, {"energy": 0.01})[:2]
    lines = ablation.table([(CASE, found), (CASE, other)]).splitlines()
    assert lines[3] == "| worse | stops | 1 |"
    assert lines[4] == "| better | 1 |  |"


def test_the_plan_has_the_benchs_changes_and_more() -> None:
    names = [
        entry.get("name")
        for entry in ablation.plan_of({"variants": [{"name": "more"}]})["ablation"]["variants"]
    ]
    assert names[-1] == "more"
    assert "without density diffusion" in names


def test_what_is_kept_becomes_the_page_and_what_is_missing_a_failure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- ablation:begin -->\nold\n<!-- ablation:end -->\nafter\n")
    found = rows({"velocity": 0.01}, {"velocity": 0.02}, {"velocity": 0.005})
    ablation.file_of(tmp_path, CASE).write_text(json.dumps({"rows": found}))
    assert ablation.main(["--table-only", "--out", str(tmp_path), "--page", str(page)]) == 1
    assert "no errors are kept for taylor_green" in capsys.readouterr().out
    assert page.read_text().startswith("before\n<!-- ablation:begin -->\n| change |")
    assert page.read_text().endswith("| better | **0.5** |\n<!-- ablation:end -->\nafter\n")


def test_a_page_without_markers_is_refused(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("<!-- ablation:begin -->\n")
    with pytest.raises(ValueError, match="ablation:end"):
        replace_between(page, "ablation", "text")
    assert page.read_text() == "<!-- ablation:begin -->\n"
