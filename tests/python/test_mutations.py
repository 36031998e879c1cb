"""How mutants are built, run and reported; the solver and its verification are stood in for."""

import argparse
import dataclasses
import json
import os

import pytest

from verification import mutations
from verification.faults import FaultError
from verification.mutants import HEADER, mutants_of
from verification.mutations import Control, active, control_run, judge, near, passes, plant_all, stored_answer
from verification.mutations_report import tally, write_report

CMAKE = """cmake_minimum_required(VERSION 3.18)
project(p CXX)
set(CMAKE_CXX_STANDARD 20)
include_directories(.)
add_executable(slurry solver/energy.cpp)
add_executable(slurry_tests solver/energy.cpp)
"""
FILE = "solver/energy.cpp"
SOURCE = """#include <cstdio>
struct Mass { double kg; double value() const { return kg * 1; } };
int main(int arguments, char**) {
    double sum = 0;
    sum += 2.0 * 3;
    double unused = 1;
    unused += arguments * unused;
    Mass mass{1};
    mass = Mass{sum * 2};
    if (sum == 6) {
        std::puts("[       OK ] Energy.Sum (20 ms)\\n[       OK ] Shapes/Mass.Sum/0 (900 ms)");
        return 0;
    }
    std::puts("[  FAILED  ] Energy.Sum (0 ms)");
    return 1;
}
"""


@pytest.fixture
def options(tmp_path):
    source = tmp_path / "tree"
    (source / "solver").mkdir(parents=True)
    (source / "CMakeLists.txt").write_text(CMAKE)
    (source / FILE).write_text(SOURCE)
    (source / "tests" / "solver").mkdir(parents=True)
    (source / "tests" / "solver" / "energy_test.cpp").write_text(
        "TEST(Energy, Sum) {}\nTEST_P(Mass, Sum) {}\n"
    )
    (tmp_path / "answers").mkdir()
    return argparse.Namespace(
        source=source, out=tmp_path, cmake_flag=[], explained=tmp_path / "why.toml", page=tmp_path / "page.md"
    )


def drawn():
    return [m for m in mutants_of(FILE, SOURCE) if m.line in (5, 7, 9)]


def test_all_are_built_at_once_and_the_survivor_is_told_from_the_caught(options, monkeypatch):
    monkeypatch.setattr(mutations, "CASES", ())
    every = drawn()
    refused = plant_all(every, options)
    assert {m.line for m in every if m.name in refused} == {9}  # a Mass has no product
    control = control_run(options)
    assert control.tests == {"Energy.Sum": 0.02, "Shapes/Mass.Sum/0": 0.9}
    number = {m.line: n for n, m in enumerate(every) if m.kind == "drop"}
    caught = judge(every[number[5]], number[5], control, options, quick=True)
    assert caught["by"] == "unit test Energy.Sum"
    unused = every[number[7]], number[7], control, options
    assert judge(*unused, quick=True) is None
    answer = judge(*unused, quick=False)
    assert answer["outcome"] == "survived"
    assert not answer["reached"]  # nothing tests what becomes of it


def test_no_mutant_no_build(options):
    (options.source / FILE).write_text(SOURCE.replace("sum == 6", "sum = ;"))
    with pytest.raises(FaultError, match="does not build"):
        plant_all([], options)
    assert HEADER in {
        str(f.relative_to(options.out / "source")) for f in (options.out / "source").rglob("*.hpp")
    }


def program(options, script):
    for name in mutations.TARGETS:
        path = options.out / "build" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)
    return path


@pytest.mark.parametrize(
    ("script", "found"),
    [
        ("echo '[  FAILED  ] Kernel.IntegralIsOne (3 ms)'; exit 1", "unit test Kernel.IntegralIsOne"),
        (
            "echo '[  FAILED  ] All/Wall.Slips/arc, where GetParam() = 1'; exit 1",
            "unit test All/Wall.Slips/arc",
        ),
        ("kill -11 $$", "unit tests: exit status -11"),
        ("exec sleep 9", "unit tests: no end within 1 s"),
        ("exit 0", ""),
    ],
)
def test_a_red_unit_test_is_named(options, script, found):
    assert mutations.run_tests(program(options, script), ["A.b"], 1, options.source)[0] == found


def test_nothing_is_judged_where_the_control_is_red(options, monkeypatch):
    program(options, "exit 1")
    with pytest.raises(FaultError, match="red with no mutant active: unit tests"):
        control_run(options)
    program(options, "echo '[       OK ] A.b (3 ms)'")
    monkeypatch.setattr(mutations, "red_check", lambda *_: "couette: velocity: above")
    with pytest.raises(FaultError, match="red with no mutant active: couette"):
        control_run(options)


def test_the_control_is_made_once_for_a_program(options, monkeypatch):
    program(options, "echo '[       OK ] A.b (3 ms)'")
    monkeypatch.setattr(mutations, "red_check", lambda *_: "")
    first = control_run(options)
    monkeypatch.setattr(mutations, "run_tests", None)
    assert control_run(options) == first
    program(options, "exit 0")
    with pytest.raises(TypeError):
        control_run(options)


def test_quick_tests_nearby_come_first_and_slow_ones_last(options):
    assert near(FILE, options.source) == {"Energy", "Mass"}
    times = {"Far.Quick": 0.1, "Energy.Slow": 9, "Shapes/Mass.Quick/0": 0.1, "Energy.Quick": 0.1}
    assert passes(Control("", times, {}), {"Energy", "Mass"}) == [
        ["Shapes/Mass.Quick/0", "Energy.Quick"],
        ["Far.Quick"],
        ["Energy.Slow"],
    ]


def test_the_mutant_is_active_only_inside():
    with pytest.raises(ValueError, match="x"), active(7, "-1"):
        assert os.environ["SLURRY_MUTANT"] == "7:-1"
        raise ValueError("x")
    assert "SLURRY_MUTANT" not in os.environ


def test_an_answer_is_made_once_but_a_survivor_again_for_other_tests(options, monkeypatch):
    caught, survivor, *_ = drawn()
    factors = []

    def examine(mutant, *_):
        factors.append(os.environ["SLURRY_MUTANT"])
        return "unit test A.b" if mutant is caught or "nan" in factors[-1] else ""

    monkeypatch.setattr(mutations, "examine", examine)
    first, second = Control("first", {}, {}), Control("second", {}, {})
    assert stored_answer(caught, first, options) is None
    assert judge(caught, 0, first, options, quick=True)["outcome"] == "caught"
    assert judge(survivor, 1, first, options, quick=True) is None
    answer = judge(survivor, 1, first, options, quick=False)
    assert (answer["outcome"], answer["reached"]) == ("survived", "unit test A.b")
    assert factors == ["0:-1", "1:0", "1:0", "1:nan"]
    assert stored_answer(survivor, first, options) == answer
    assert stored_answer(survivor, second, options) is None
    moved = dataclasses.replace(caught, line=99)
    assert stored_answer(moved, second, options)["line"] == 99


def test_a_red_check_is_named(tmp_path, monkeypatch):
    def run(arguments):
        check = {"quantity": "velocity", "reason": "above", "passed": False}
        check |= {"reported": False, "known_shortfall": "--case" not in arguments}
        (tmp_path / "results.json").write_text(json.dumps({"cases": [{"checks": [check]}]}))
        return 1

    monkeypatch.setattr(mutations.run, "main", run)
    found = mutations.red_check(tmp_path, tmp_path, "couette", "default", 1)
    assert found == "couette (default): velocity: above"
    monkeypatch.setattr(mutations.run, "main", lambda _: 2)
    with pytest.raises(FaultError, match="could not start"):
        mutations.red_check(tmp_path, tmp_path, "couette", "default", 1)


@pytest.mark.parametrize(("caught", "enough"), [(9, True), (8, False), (0, False)])
def test_the_tally_leaves_out_what_does_not_build(caught, enough):
    outcomes = ["caught"] * caught + ["survived"] * (10 - caught) + ["not built"] * 5
    line, verdict = tally([{"outcome": outcome} for outcome in outcomes])
    assert line.startswith(f"{caught} of 10 caught")
    assert verdict == enough
    assert not tally([{"outcome": "not built"}])[1]


def test_the_report_says_what_caught_each_and_why_others_survive(options):
    found = [
        {"outcome": "caught", "by": "unit test A.b", "reached": ""},
        {"outcome": "caught", "by": "couette (default): velocity: above", "reached": ""},
        {"outcome": "survived", "by": "", "reached": "unit test A.b"},
        {"outcome": "survived", "by": "", "reached": ""},
    ]
    answers = [dataclasses.asdict(m) | a for m, a in zip(drawn(), found, strict=False)]
    options.explained.write_text(f'[survivors]\n"{answers[2]["name"]}" = "an allowance"\n')
    write_report(answers, 9, options)
    report = (options.out / "report.md").read_text()
    assert "2 of 4 caught (50 %), 2 survived, 0 do not build; 4 of 9 mutants run" in report
    assert "an allowance (with NaN: unit test A.b)" in report
    assert "not explained (no check runs it)" in report
    assert f"| {FILE} | 4 | 1 | 1 | 2 |" in report
    assert not options.page.exists()
    write_report(answers, 4, options)
    assert "couette" not in options.page.read_text()


def test_the_command(options, monkeypatch, capsys):
    monkeypatch.setattr(mutations, "PHYSICS", (FILE,))
    monkeypatch.setattr(mutations, "plant_all", lambda *_: set())
    monkeypatch.setattr(mutations, "control_run", lambda *_: Control("", {}, {}))
    monkeypatch.setattr(mutations, "examine", lambda *_: "unit test A.b")
    arguments = ["--source", str(options.source), "--out", str(options.out)]
    assert mutations.main([*arguments, "--list"]) == 0
    count = len(capsys.readouterr().out.splitlines())
    assert mutations.main(arguments) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1] == f"{count} of {count} caught (100 %), 0 survived, 0 do not build"
    assert lines[0].startswith(f"[quick unit tests 1/{count}, 0 min left] CAUGHT {FILE}:")


def test_mutants_of_chosen_files_alone_never_become_the_page_of_all(options, monkeypatch, capsys):
    other = "solver/other.cpp"
    (options.source / other).write_text("{ double loss = 2.0 * gain(); }")
    monkeypatch.setattr(mutations, "PHYSICS", (FILE, other))
    arguments = ["--source", str(options.source), "--list", "--file", other]
    assert mutations.main(arguments) == 0
    assert {line.split(":")[0] for line in capsys.readouterr().out.splitlines()} == {other}
    for wrong in (["--page", str(options.page)], ["--file", "solver/main.cpp"]):
        with pytest.raises(SystemExit, match="2"):
            mutations.main([*arguments, *wrong])
