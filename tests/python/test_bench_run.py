import json
import sys

import pytest
from bench_fakes import MANUAL, FakeBench
from verification_fakes import load

from verification.bench import __main__ as bench
from verification.bench import ablation, speed_error
from verification.bench.plan import load_plan
from verification.bench.session import default_name, scene_keys
from verification.case import CaseError


@pytest.fixture
def solver(monkeypatch):
    return FakeBench().install(monkeypatch)


def run(tmp_path, *arguments):
    status = bench.main(["--quick", "--solver", sys.executable, "--out", str(tmp_path), *arguments], load)
    path = tmp_path / "speed_error.json"
    return status, json.loads(path.read_text()) if path.exists() else None


def test_a_quick_bench_writes_every_section(solver, tmp_path, capsys):
    status, results = run(tmp_path)
    assert status == 0
    assert results["failures"] == []
    assert {p["arithmetic"] for p in results["speed_error"]} == {"float", "double"}
    assert {p["threads"] for p in results["speed_error"]} == {1, 2}
    assert {p["scheme"] for p in results["speed_error"]} == {"default", "wang2014"}
    point = results["speed_error"][0]
    assert point["case"] == "couette"
    assert point["wall_s"] == 2.0
    assert point["step_s"] == pytest.approx(0.1)  # (2.0 - 0.5 - 0.5) s in 10 steps
    assert point["particle_steps_per_s"] == 1e6
    assert point["list_rebuilds"] == 3
    assert point["errors"]["velocity at 5e-06 s"] == pytest.approx(4e-3, rel=0.5)
    assert results["scaling"]["rows"][0]["ns_per_particle_step"] > 0
    assert results["target_runs"]["rate"][0]["whole_step_rate"] > 0
    assert (tmp_path / "report.html").exists()
    out = capsys.readouterr().out
    assert out.count("SKIPPED: ") == len(results["targets"])
    assert "MET: " not in out
    assert not list(tmp_path.glob(".*"))  # nothing of the runs is left


def test_the_report_is_made_again_without_a_run(solver, tmp_path, capsys):
    first = run(tmp_path, "--only", "speed_error")
    (tmp_path / "report.html").unlink()
    calls = solver.calls
    assert run(tmp_path, "--report-only") == first
    assert solver.calls == calls
    assert (tmp_path / "report.html").exists()
    (tmp_path / "speed_error.json").write_text("{")
    assert bench.main(["--report-only", "--out", str(tmp_path)]) == 2
    assert "bench: " in capsys.readouterr().err


def test_what_the_solver_lacks_is_left_out_with_a_note(solver, tmp_path):
    solver.manual = "\n".join(
        line for line in MANUAL.splitlines() if "pair_arith" not in line and "kernel" not in line
    )
    status, results = run(tmp_path, "--only", "speed_error", "--only", "ablation", "--only", "machine_bench")
    assert status == 0
    assert {p["arithmetic"] for p in results["speed_error"]} == {"built-in"}
    assert not any("pair_arithmetic" in part for command in solver.commands for part in command)
    notes = " ".join(results["notes"])
    for missing in (
        "numerics.pair_arithmetic",
        "numerics.kernel",
        "numerics.particle_volume",
        "command `bench`",
    ):
        assert missing in notes
    assert "load average was 2.0" in notes
    assert "scaling" not in results


def test_a_run_that_fails_is_reported_and_the_rest_goes_on(solver, tmp_path, capsys):
    solver.broken = 'pair_arithmetic="double"'
    status, results = run(tmp_path, "--only", "speed_error")
    assert status == 1
    failed = [p for p in results["speed_error"] if p["failure"]]
    assert {p["arithmetic"] for p in failed} == {"double"}
    assert len(failed) == len(results["speed_error"]) / 2 == len(results["failures"])
    assert failed[0]["wall_s"] is None
    assert "a velocity is not finite" in capsys.readouterr().out


def test_nan_errors_become_null_and_failures(solver, tmp_path):
    solver.fault = "nan"
    status, results = run(tmp_path, "--only", "speed_error")
    assert status == 1
    assert results["speed_error"][0]["errors"]["velocity at 0.0001 s"] is None
    assert any("not finite" in failure for failure in results["failures"])


def test_errors_that_depend_on_the_threads_fail(solver, tmp_path):
    solver.by_threads = 1e-15
    status, results = run(tmp_path, "--only", "speed_error")
    assert status == 1
    assert any("depends on the threads" in failure for failure in results["failures"])


def test_short_runs_are_repeated_and_the_median_counts(solver, tmp_path, monkeypatch):
    walls = iter([3.0, 1.0, 2.0])
    plan = load_plan(True) | {"repetitions": 3}
    session = bench.Session(sys.executable, tmp_path, plan, None)
    monkeypatch.setattr("verification.bench.session.execute", lambda *rest: bench_outcome(next(walls)))
    measured = session.measure(session.job("couette", "couette", 1e-6))
    assert (measured.wall, measured.repetitions) == (2.0, 3)


def bench_outcome(wall):
    class Outcome:
        failure = ""
        attributes = {"wall_seconds": wall, "steps": 10.0}  # noqa: RUF012

    return Outcome()


def test_a_section_that_breaks_does_not_lose_the_others(solver, tmp_path, monkeypatch):
    monkeypatch.setitem(bench.SECTIONS, "speed_error", lambda session: {}["absent"])
    status, results = run(tmp_path, "--only", "speed_error", "--only", "ablation")
    assert status == 1
    assert results["failures"] == ["speed_error: KeyError: 'absent'"]
    assert results["ablation"]


def test_an_interrupted_bench_leaves_no_results(solver, tmp_path, monkeypatch):
    (tmp_path / "speed_error.json").write_text("{}")

    def interrupted(session):
        raise KeyboardInterrupt

    monkeypatch.setitem(bench.SECTIONS, "speed_error", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, "--only", "speed_error")
    assert not (tmp_path / "speed_error.json").exists()


def test_without_a_solver_it_does_not_start(tmp_path, capsys):
    assert bench.main(["--solver", str(tmp_path / "none"), "--out", str(tmp_path)]) == 2
    assert "make build" in capsys.readouterr().err


def test_manual_is_read():
    keys = scene_keys(MANUAL)
    assert keys["numerics.kernel"] == ("quintic", "wendland_c2", "gaussian")
    assert keys["numerics.acoustic_cfl"] == ()
    assert "walls.name" in keys
    assert default_name(MANUAL, "numerics.kernel") == "quintic"


def test_ablation_spells_out_kernels_and_compares(solver, tmp_path):
    solver.broken = "background_pressure_ratio"
    status, results = run(tmp_path, "--only", "ablation")
    assert status == 0  # that the solver stops without it is an answer
    assert any("background_pressure_ratio" in note for note in results["notes"])
    rows = {row["name"]: row for row in results["ablation"]}
    assert {"default scheme", "kernel wendland_c2", "kernel gaussian", "double arithmetic"} <= rows.keys()
    assert "kernel quintic" not in rows
    assert rows["double arithmetic"]["arithmetic"] == "double"
    assert rows["kernel gaussian"]["relative_step_time"] == 1
    assert rows["kernel gaussian"]["better"] == "equal"
    assert rows["without transport velocity"]["better"] == "default: this one does not run"


def test_the_default_scheme_of_the_ablation_must_run(solver, tmp_path):
    solver.broken = "--threads"
    status, results = run(tmp_path, "--only", "ablation")
    assert status == 1
    assert len(results["failures"]) == 1
    assert "default" in results["failures"][0]


@pytest.mark.parametrize(
    ("step", "errors", "better"),
    [
        (0.5, (1e-2, 1e-2), "this"),
        (1.0, (2e-2, 1e-2), "default"),
        (1.01, (1e-2, 1e-2), "equal"),
        (0.5, (2e-2, 5e-3), "this is faster; errors: 1 lower, 1 higher of 2"),
        (2.0, (1e-2, 5e-3), "default is faster; errors: 1 lower, 0 higher of 2"),
        (1.0, (None, 1e-2), "unknown"),
    ],
)
def test_who_is_better(step, errors, better):
    base = {"step_s": 1.0, "errors": {"a": 1e-2, "b": 1e-2}, "failure": ""}
    row = {"step_s": step, "errors": dict(zip("ab", errors, strict=True)), "failure": ""}
    assert ablation.judge(row, base, 0.03)["better"] == better


def test_thread_dependence_sees_the_last_bit():
    point = {
        "case": "c",
        "variant": "v",
        "scheme": "s",
        "arithmetic": "float",
        "spacing_m": 1.0,
        "failure": "",
    }
    same = [point | {"threads": n, "errors": {"velocity": 0.1}} for n in (1, 2)]
    assert speed_error.thread_dependence(same) == []
    same[1]["errors"]["velocity"] = 0.1 + 2e-17
    assert len(speed_error.thread_dependence(same)) == 1
    same[1]["failure"] = "stopped"
    assert speed_error.thread_dependence(same) == []


def test_quick_replaces_only_what_the_plan_has(tmp_path):
    plan = tmp_path / "plan.toml"
    plan.write_text("[a]\nb = 1\nc = 2\n[quick.a]\nb = 3\n")
    assert load_plan(True, plan) == {"a": {"b": 3, "c": 2}}
    assert load_plan(False, plan) == {"a": {"b": 1, "c": 2}}
    plan.write_text("[a]\nb = 1\n[quick.a]\nd = 3\n")
    with pytest.raises(CaseError, match="d, which the plan does not have"):
        load_plan(True, plan)
