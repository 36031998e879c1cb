import re
import shutil
import sys

import pytest
from verification_fakes import FakeSolver, load

from verification import execute, faults, mutations, run
from verification.faults import Fault, FaultError

COUETTE = {"case": "couette", "scheme": "default", "level": "gate", "spacing": 5e-7}
CHECKS = ("velocity at 2e-05 s",)


@pytest.fixture
def solver(monkeypatch):
    fake, main = FakeSolver(), run.main
    monkeypatch.setattr(execute, "call", fake.call)
    monkeypatch.setattr(run, "main", lambda arguments: main(arguments, load))
    return fake


def detect(tmp_path, fault, **options):
    return faults.detect(fault, faults.Path(sys.executable), tmp_path, **options)


def test_a_set_fault_is_detected_and_the_healthy_run_is_made_once(solver, tmp_path):
    fault = Fault("viscosity", **COUETTE, checks=CHECKS, set=("fluid.dynamic_viscosity=2e-3",))
    assert "above tolerance" in detect(tmp_path, fault)
    assert solver.calls == 2
    detect(tmp_path, fault)
    assert solver.calls == 3


def test_a_fault_without_effect_is_missed(solver, tmp_path):
    with pytest.raises(FaultError, match="stays green"):
        detect(tmp_path, Fault("nothing", **COUETTE, checks=CHECKS, set=("start.seed=2",)))


def test_a_check_that_is_red_anyway_shows_nothing(solver, tmp_path):
    solver.error = 1
    with pytest.raises(FaultError, match="red without the fault"):
        detect(tmp_path, Fault("any", **COUETTE, checks=CHECKS, set=("start.seed=2",)))


def test_an_unknown_check_is_refused(solver, tmp_path):
    with pytest.raises(FaultError, match="no check is called speed"):
        detect(tmp_path, Fault("any", **COUETTE, checks=("speed",), set=("start.seed=2",)))


@pytest.mark.parametrize(("status", "detected"), [(3, True), (2, False), (-11, False)])
def test_a_run_that_the_fault_stops(solver, tmp_path, monkeypatch, status, detected):
    def call(command, timeout):
        return (
            f"exit status {status}: message" if "start.seed=2" in command else solver.call(command, timeout)
        )

    monkeypatch.setattr(execute, "call", call)
    fault = Fault("nan", **COUETTE, checks=CHECKS, set=("start.seed=2",))
    if detected:
        assert "exit status 3" in detect(tmp_path, fault)
    else:
        with pytest.raises(FaultError, match="shows nothing"):
            detect(tmp_path, fault)


def test_a_source_fault_uses_the_faulty_build(solver, tmp_path):
    fault = Fault("sign", **COUETTE, checks=CHECKS, file="solver/a.hpp", find="+", replace="-")

    def make(fault, out):
        solver.error = 0.1
        faulty = tmp_path / "slurry"
        shutil.copy("/bin/sh", faulty)
        return faulty

    assert "above tolerance" in detect(tmp_path, fault, make=make)


SOURCE = Fault("sign", **COUETTE, checks=CHECKS, file="solver/main.cpp", find="return 0", replace="return 7")


def project(folder, text="int main() { return 0; }\n"):
    (folder / "solver").mkdir(parents=True)
    (folder / "solver" / "main.cpp").write_text(text)
    cmake = "cmake_minimum_required(VERSION 3.18)\nproject(p CXX)\nadd_executable(slurry solver/main.cpp)\n"
    (folder / "CMakeLists.txt").write_text(cmake)
    return folder


def test_a_source_fault_is_built_apart(tmp_path):
    source = project(tmp_path / "tree")
    binary = faults.build(SOURCE, tmp_path / "out", source)
    assert execute.call([str(binary)], 10).startswith("exit status 7")
    assert "return 0" in (source / "solver" / "main.cpp").read_text()
    broken = Fault(
        "broken", **COUETTE, checks=CHECKS, file="solver/main.cpp", find="return 0", replace="return x"
    )
    with pytest.raises(FaultError, match="does not build: .*error"):
        faults.build(broken, tmp_path / "out", source)


def test_the_copy_forgets_the_last_fault_and_touches_nothing_else(tmp_path):
    source, copy = project(tmp_path / "tree"), tmp_path / "copy"
    faults.synchronise(source, copy, SOURCE)
    before = (copy / "CMakeLists.txt").stat().st_mtime_ns
    (copy / "solver" / "stale.cpp").write_text("")
    other = Fault("other", **COUETTE, checks=CHECKS, file="CMakeLists.txt", find="3.18", replace="3.19")
    faults.synchronise(source, copy, SOURCE)
    assert (copy / "CMakeLists.txt").stat().st_mtime_ns == before
    assert not (copy / "solver" / "stale.cpp").exists()
    faults.synchronise(source, copy, other)
    assert "return 0" in (copy / "solver" / "main.cpp").read_text()


@pytest.mark.parametrize(("text", "reason"), [("return 0; return 0;", "2 places"), ("int", "0 places")])
def test_a_source_fault_needs_exactly_one_match(tmp_path, text, reason):
    with pytest.raises(FaultError, match=reason):
        faults.synchronise(project(tmp_path / "tree", text), tmp_path / "copy", SOURCE)


def test_a_fault_is_either_set_or_source():
    for fields in ({}, {"set": ("a=1",), "file": "solver/main.cpp"}):
        with pytest.raises(FaultError, match="either"):
            Fault("bad", **COUETTE, checks=CHECKS, **fields)


def test_the_command_counts(solver, tmp_path, capsys):
    head = f'case = "couette"\nscheme = "default"\nlevel = "gate"\nspacing = 5e-7\nchecks = ["{CHECKS[0]}"]\n'
    toml = f'[[faults]]\nname = "a"\nset = ["fluid.dynamic_viscosity=2e-3"]\n{head}'
    toml += f'[[faults]]\nname = "b"\nset = ["start.seed=2"]\n{head}'
    (tmp_path / "faults.toml").write_text(toml)
    options = [
        "--faults",
        str(tmp_path / "faults.toml"),
        "--solver",
        sys.executable,
        "--out",
        str(tmp_path / "out"),
    ]
    assert faults.main(options) == 1
    output = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in output] == ["DETECTED a", "MISSED b", "1 passed, 1 failed"]
    assert faults.main([*options, "--only", "a"]) == 0
    assert faults.main([*options, "--only", "c"]) == 2


def test_the_faults_of_the_repository_can_be_read():
    names = [fault.name for fault in faults.load(faults.ROOT / "faults.toml")]
    assert len(names) == len(set(names)) >= 6


def test_a_copy_has_every_folder_that_the_build_reads() -> None:
    lists = (faults.REPOSITORY / "CMakeLists.txt").read_text()
    read = set(re.findall(r"\b((?:tests/)?[a-z]+)/[\w*/]*\.(?:cpp|hpp|cmake)", lists))
    assert {"solver", "tests/solver", "tests/fuzz"} <= read
    assert read - {"generated"} <= set(faults.SOURCES)  # generated: in the build folder


def test_the_page_lists_every_fault_with_what_was_said(tmp_path):
    one = Fault("one", **COUETTE, checks=CHECKS, set=("start.seed=2",))
    two = Fault("two", **COUETTE, checks=CHECKS, file="solver/a.hpp", find="1", replace="2")
    stopped = "velocity: exit status 3: step 8 | too dense; its state is in /somewhere/failed.h5"
    page = tmp_path / "faults.md"
    faults.write_page(page, [(one, "DETECTED", stopped), (two, "MISSED", "velocity stays green")])
    lines = page.read_text().splitlines()
    assert "**1 of 2 caught**" in lines[2]
    assert lines[-2] == (
        "| one | the scene | couette | DETECTED | velocity: exit status 3: step 8 / too dense |"
    )
    assert lines[-1] == "| two | solver/a.hpp | couette | MISSED | velocity stays green |"


def test_where_a_library_refuses_what_a_line_of_ours_asks_for_that_line_is_named():
    output = """In file included from ours.cpp:1:
lib.h: In instantiation of 'void size(T) [with T = float]':
ours.cpp:85:81:   required from here
lib.h:807:7: error: static assertion failed: INTEGER_WAS_EXPECTED
  807 |       assert
lib.h: In instantiation of 'void size(T) [with T = int]':
ours.cpp:12:3:   required from here
lib.h:9:7: warning: unused
"""
    assert faults.error_lines(output) == [
        "ours.cpp:85:81:   required from here",
        "lib.h:807:7: error: static assertion failed: INTEGER_WAS_EXPECTED",
    ]
    place = mutations.ERROR.match(faults.error_lines(output)[0])
    assert (place[1], place[2]) == ("ours.cpp", "85")
