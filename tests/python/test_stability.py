"""The search for margins, and what counts as surviving, without a solver."""

import argparse
import json
import sys

import pytest

from verification import execute
from verification.case import HARD, ROOT, CaseError, load_case
from verification.stability import __main__ as stability
from verification.stability import margins, report, trial
from verification.stability.margins import RESOLUTION, TARGET, find
from verification.stability.trial import Direction, Trial, harder, memory_growth


def at(factor, survives):
    return Trial(factor, {"a.b": factor}, "survived" if survives else "stopped", "" if survives else "why")


def margin(limit, breaks_at, base=True):
    found = find(lambda factor: at(factor, factor < breaks_at), at(1.0, base), limit)
    assert len({t.factor for t in found.trials}) == len(found.trials)
    return found


@pytest.mark.parametrize("breaks_at", [1.1, 1.49, 1.51, 2.0, 4.0, 7.9])
def test_the_limit_is_between_the_margin_and_the_first_failure(breaks_at):
    found = margin(8.0, breaks_at)
    assert found.factor < breaks_at <= found.broken_at <= RESOLUTION * found.factor
    assert found.met == (found.factor >= TARGET)
    assert found.last.factor == found.broken_at


def test_without_a_limit_the_bracket_is_the_margin():
    found = margin(3.0, 100)
    assert (found.factor, found.broken_at, found.last) == (pytest.approx(3.0), float("inf"), None)
    assert found.met


def test_a_base_that_fails_is_made_easier():
    found = margin(8.0, 0.5, base=False)
    assert found.factor < 0.5 <= found.broken_at <= RESOLUTION * found.factor
    assert not found.met
    assert margin(8.0, 0.01, base=False).factor == 0


def test_an_island_of_survival_beyond_the_limit_counts_for_nothing():
    found = find(lambda f: at(f, not 1.4 < f < 2.0), at(1.0, True), 8.0)
    assert found.factor < 1.5


SCENE = {"numerics": {"sound_speed": 10.0}, "discs": [{"name": "disc", "velocity": [0.0, 2.0]}]}


def test_values_are_scaled_by_their_powers():
    direction = Direction("d", "m", {"numerics.sound_speed": -1, "discs.disc.velocity": 1}, 4.0)
    assert harder(SCENE, direction, 2.0) == {"numerics.sound_speed": 5.0, "discs.disc.velocity": [0.0, 4.0]}
    with pytest.raises(CaseError, match="no other"):
        harder(SCENE, Direction("d", "m", {"discs.other.velocity": 1}, 4.0), 2.0)
    with pytest.raises(CaseError, match="limit above 1"):
        Direction("d", "m", {"a": 1}, 1.0)


def outcome(tmp_path, failure):
    case = load_case("hard_taylor_green")
    run = execute.Run(case, "default", case.variants[0], 0.04, True)
    return execute.Outcome(run, execute.Result(tmp_path / "result.h5", 5.0, case.scene()), failure)


@pytest.mark.parametrize(
    ("failure", "end"),
    [
        ("exit status 3: step 7: density", "stopped"),
        ("exit status 2: refused", "refused"),
        ("exit status -11: no message", "broke"),
        ("the solver did not end within 1 s", "broke"),
        ("", "wrong"),  # there is no result
    ],
)
def test_how_a_run_ends(tmp_path, failure, end):
    assert trial.verdict(outcome(tmp_path, failure))[0] == end


@pytest.mark.parametrize(("growth", "expected"), [(0.0, 0.0), (0.5, 0.5)])
def test_memory_growth(tmp_path, growth, expected):
    sizes = [100] * 50 + [100] * 10 + [100 + 100 * growth] * 40 + [0]
    (tmp_path / "memory").write_text("\n".join(str(int(size)) for size in sizes))
    assert memory_growth(tmp_path / "memory") == pytest.approx(expected)
    (tmp_path / "memory").write_text("1\n2\n")
    assert memory_growth(tmp_path / "memory") == 0


def test_memory_is_sampled_while_a_command_runs(tmp_path):
    grow = (
        "import time\nheld = []\nfor _ in range(8): held.append(bytearray(2**22)); time.sleep(0.15)\nexit(3)"
    )
    command = [sys.executable, str(trial.WRAPPER), str(tmp_path / "m"), "60", sys.executable, "-c", grow]
    assert execute.call(command, 100).startswith("exit status 3")
    sizes = [int(line) for line in (tmp_path / "m").read_text().split()]
    assert len(sizes) >= 3 and max(sizes) > sizes[0] + 2**22
    command[3] = "0.3"
    assert "did not end within 0.3 s" in execute.call(command, 100)


@pytest.fixture
def solver(monkeypatch, tmp_path):
    """Stands in for the runs: half the case's sound speed is survived, less is not."""
    calls = []

    def attempt(subject, values, factor, options, folder):
        calls.append(factor)
        survives = values.get("numerics.sound_speed", 10.0) >= 5.0
        return Trial(factor, values, *(("survived", "") if survives else ("stopped", "too fast"))), None

    monkeypatch.setattr(stability, "attempt", attempt)
    monkeypatch.setattr(
        stability, "base_scene", lambda s, o, f: (attempt(s, {}, 1.0, o, f)[0], s.case.scene())
    )
    monkeypatch.setattr(stability.References, "prepare", lambda self, wanted: None)
    (tmp_path / "slurry").write_text("a solver")
    return argparse.Namespace(
        solver=tmp_path / "slurry", out=tmp_path / "out", jobs=2, timeout=1, calls=calls
    )


def planned(**changes):
    case = load_case("hard_taylor_green")
    data = {**case.data, "directions": [{"variants": ["re_1000"], "names": ["sound_speed"]}], **changes}
    return list(stability.tasks(stability.dataclasses.replace(case, data=data), stability.directions()))


def test_answers_are_stored_and_not_made_again(solver):
    answers = stability.run_all(planned(), solver)
    assert answers[-1]["met"] and answers[-1]["margin"] == pytest.approx(2, rel=0.11)
    made = len(solver.calls)
    assert stability.run_all(planned(), solver) == answers and len(solver.calls) == made
    stored = solver.out / "margins" / "hard_taylor_green-re_1000-sound_speed.json"
    stored.unlink()  # as after an interruption
    stability.run_all(planned(), solver)
    again = len(solver.calls)
    assert made < again < 2 * made
    solver.solver.write_text("another solver")
    stability.run_all(planned(), solver)
    assert len(solver.calls) == again + made


def test_the_report_and_the_verdict(solver, capsys, monkeypatch):
    answers = stability.run_all(planned(), solver)
    report.write(answers, solver.out)
    assert report.verdict(answers) == 0
    assert "numerics.sound_speed: 10 →" in (solver.out / "report.md").read_text()
    assert (solver.out / "margins.png").stat().st_size > 1000
    assert len(json.loads((solver.out / "stability.json").read_text())) == len(answers)
    monkeypatch.setattr(margins, "TARGET", 3.0)
    solver.solver.write_text("a solver of another target")
    answers = stability.run_all(planned(), solver)
    assert report.verdict(answers) == 1
    assert "FAILED: hard_taylor_green re_1000 sound_speed: margin" in capsys.readouterr().out
    excused = {"re_1000-sound_speed": "for a reason"}
    assert report.verdict(stability.run_all(planned(known_shortfalls=excused), solver)) == 0


def test_the_page_has_the_margins_of_all_cases_or_is_left_alone(solver, monkeypatch, tmp_path, capsys):
    directions = [{"variants": ["re_1000"], "names": ["sound_speed", "jitter"]}]
    page = tmp_path / "README.md"
    page.write_text("above\n<!-- margins:begin -->\n<!-- margins:end -->\nbelow\n")
    monkeypatch.setattr(stability.os, "access", lambda path, mode: True)
    some = planned(directions=directions)
    monkeypatch.setattr(
        stability, "tasks", lambda case, known: some if case.name == "hard_taylor_green" else []
    )
    command = ["--solver", str(solver.solver), "--out", str(solver.out), "--page", str(page)]
    assert stability.main([*command, "--report-only"]) == 2  # nothing has been run
    assert stability.main([*command, "--case", "hard_taylor_green"]) == 2
    assert "some are missing" in capsys.readouterr().err and "|" not in page.read_text()
    assert stability.main(command) == 0
    lines = page.read_text().splitlines()
    assert lines[0] == "above" and lines[-1] == "below"
    row = next(line for line in lines if line.startswith("| `hard_taylor_green`, re 1000 |"))
    assert row.endswith("| survived |  | sound speed 1.84, jitter 2.50+ |")


def test_what_is_not_there_is_refused(capsys):
    with pytest.raises(CaseError, match="no variant"):
        planned(directions=[{"variants": ["none"], "names": ["sound_speed"]}])
    with pytest.raises(CaseError, match="not run"):
        planned(known_shortfalls={"re_1000-jitter": "?"})
    assert stability.main(["--case", "none"]) == 2


def test_the_hard_cases_of_the_repository_can_be_read():
    known = stability.directions()
    names = [path.parent.name for path in (ROOT / HARD).glob("*/checks.toml")]
    assert len(names) >= 10
    for name in names:
        assert list(stability.tasks(load_case(name), known))
