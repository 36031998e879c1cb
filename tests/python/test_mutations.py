"""What mutants a source offers, which are drawn, and what is said of them; the runs are stood in for."""

import argparse
import json

import pytest

from verification import mutations
from verification.faults import FaultError
from verification.mutations import PHYSICS, Mutant, draw, judge, mutants_of, planted, tally

SOURCE = """// a + b = c;
#include "x + y"
double energy(double m, double v) { // of one
    double sum = 0;
    sum += m * v * v / 2;
    return sum - 3 * m;
}
"""
AFTER = {
    (5, "sign", "    sum -= m * v * v / 2;"),
    (5, "drop", "    sum += 0 * (m * v * v / 2);"),
    (5, "scale", "    sum += 1.02 * (m * v * v / 2);"),
    (6, "sign", "    return sum + 3 * m;"),
    (6, "scale", "    return 1.02 * (sum - 3 * m);"),
}


def test_signs_terms_and_factors_of_the_code_alone():
    found = list(mutants_of("solver/energy.cpp", SOURCE))
    assert {(m.line, m.kind, m.after) for m in found} == AFTER
    assert len({m.name for m in found}) == len(found)


def test_in_templates_over_packs_the_factor_is_a_pack():
    scaled = [m for m in mutants_of("a.hpp", f"template <class P>\n{SOURCE}") if m.kind == "scale"]
    assert all("P(1.02f) * (" in m.after for m in scaled) and len(scaled) == 2


def test_the_draw_is_even_and_always_the_same():
    files = {f: (mutations.REPOSITORY / f).read_text() for f in PHYSICS}
    every = [m for file, text in files.items() for m in mutants_of(file, text)]
    drawn = draw(every, 60)
    assert drawn == draw(list(reversed(every)), 60)
    assert len(set(drawn)) == 60
    assert {m.file for m in drawn} == set(PHYSICS)
    assert {m.kind for m in drawn} == {"sign", "drop", "scale"}


def test_planting_changes_one_line(tmp_path):
    (tmp_path / "energy.cpp").write_text(SOURCE)
    mutant = next(mutants_of("energy.cpp", SOURCE))
    fault = planted(mutant, tmp_path)
    lines = zip(fault.find.split("\n"), fault.replace.split("\n"), strict=True)
    changed = [pair for pair in lines if len(set(pair)) == 2]
    assert changed == [(mutant.before, mutant.after)]
    (tmp_path / "energy.cpp").write_text("// new\n" + SOURCE)
    with pytest.raises(FaultError, match="has changed"):
        planted(mutant, tmp_path)


@pytest.fixture
def options(tmp_path):
    (tmp_path / "energy.cpp").write_text(SOURCE)
    (tmp_path / "answers").mkdir()
    return argparse.Namespace(source=tmp_path, out=tmp_path, cmake_flag=[], timeout=1)


@pytest.mark.parametrize(("found", "outcome"), [("unit test A.b", "caught"), ("", "survived")])
def test_an_answer_is_stored_and_not_made_again(options, monkeypatch, found, outcome):
    monkeypatch.setattr(mutations, "build", lambda *_: options.out / "slurry")
    monkeypatch.setattr(mutations, "examine", lambda *_: found)
    mutant = next(mutants_of("energy.cpp", SOURCE))
    answer = judge(mutant, options)
    assert (answer["outcome"], answer["by"]) == (outcome, found)
    monkeypatch.setattr(mutations, "examine", None)
    assert judge(mutant, options) == answer


def test_what_does_not_build_is_said_so_and_other_errors_stop(options, monkeypatch):
    def fail(message):
        def build(*_):
            raise FaultError(message)

        return build

    mutant = next(mutants_of("energy.cpp", SOURCE))
    monkeypatch.setattr(mutations, "build", fail("the verification could not start"))
    with pytest.raises(FaultError, match="start"):
        judge(mutant, options)
    monkeypatch.setattr(mutations, "build", fail("does not build: error"))
    assert judge(mutant, options)["outcome"] == "not built"


@pytest.mark.parametrize(("caught", "enough"), [(9, True), (8, False), (0, False)])
def test_the_tally_leaves_out_what_does_not_build(caught, enough):
    outcomes = ["caught"] * caught + ["survived"] * (10 - caught) + ["not built"] * 5
    line, verdict = tally([{"outcome": outcome} for outcome in outcomes])
    assert line.startswith(f"{caught} of 10 caught") and verdict == enough
    assert not tally([{"outcome": "not built"}])[1]


CMAKE = """cmake_minimum_required(VERSION 3.18)
project(p CXX)
add_executable(slurry solver/energy.cpp)
add_executable(slurry_tests solver/energy.cpp)
"""
MAIN = """#include <cstdio>
int main() {
    double sum = 0;
    sum += 2.0 * 3;
    double unused = 1;
    unused += 2.0 * unused;
    if (sum == 6) { return 0; }
    std::puts("[  FAILED  ] Energy.Sum (0 ms)");
    return 1;
}
"""


def test_mutants_are_built_and_the_survivor_is_told_from_the_caught(tmp_path, monkeypatch):
    source = tmp_path / "tree"
    (source / "solver").mkdir(parents=True)
    (source / "CMakeLists.txt").write_text(CMAKE)
    (source / "solver" / "energy.cpp").write_text(MAIN)
    (tmp_path / "answers").mkdir()
    monkeypatch.setattr(mutations, "CASES", ())
    options = argparse.Namespace(source=source, out=tmp_path, cmake_flag=[], timeout=60)
    found = {m.line: m for m in mutants_of("solver/energy.cpp", MAIN) if m.kind == "drop"}
    assert judge(found[4], options)["by"] == "unit test Energy.Sum"
    assert judge(found[6], options)["outcome"] == "survived"
    broken = Mutant("solver/energy.cpp", 4, "sign", found[4].before, "    sum = ;")
    assert judge(broken, options)["outcome"] == "not built"


def test_a_red_unit_test_is_named(tmp_path):
    tests = tmp_path / "slurry_tests"
    tests.write_text("#!/bin/sh\necho '[  FAILED  ] Kernel.IntegralIsOne (3 ms)'\nexit 1\n")
    tests.chmod(0o755)
    assert mutations.red_unit_test(tests, 10) == "unit test Kernel.IntegralIsOne"
    tests.write_text("#!/bin/sh\nkill -11 $$\n")
    assert "exit status -11" in mutations.red_unit_test(tests, 10)
    tests.write_text("#!/bin/sh\nexit 0\n")
    assert mutations.red_unit_test(tests, 10) == ""


def test_a_red_check_is_named(tmp_path, monkeypatch):
    def run(arguments):
        check = {"quantity": "velocity", "reason": "above", "passed": False}
        check |= {"reported": False, "known_shortfall": "--case" not in arguments}
        (tmp_path / "results.json").write_text(json.dumps({"cases": [{"checks": [check]}]}))
        return 1

    monkeypatch.setattr(mutations.run, "main", run)
    assert mutations.red_check(tmp_path, tmp_path, "couette", 1) == "couette: velocity: above"
    monkeypatch.setattr(mutations.run, "main", lambda _: 2)
    with pytest.raises(FaultError, match="could not start"):
        mutations.red_check(tmp_path, tmp_path, "couette", 1)


def test_the_command(options, monkeypatch, capsys):
    monkeypatch.setattr(mutations, "PHYSICS", ("energy.cpp",))
    monkeypatch.setattr(mutations, "build", lambda *_: options.out / "slurry")
    monkeypatch.setattr(mutations, "examine", lambda *_: "unit test A.b")
    arguments = ["--source", str(options.source), "--out", str(options.out)]
    assert mutations.main([*arguments, "--list"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == len(AFTER)
    assert mutations.main(arguments) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "5 of 5 caught (100 %), 0 survived, 0 do not build"
    assert "5 of 5 mutants run" in (options.out / "report.md").read_text()
    assert isinstance(next(mutants_of("energy.cpp", SOURCE)), Mutant)
