import argparse
import itertools
import json
import subprocess
import sys
from pathlib import Path

import pytest
from verification_fakes import ERROR, FakeReference, FakeSolver, load

from verification import baseline, curves, execute, run
from verification.case import LEVELS, SCHEMES, CaseError, load_case, load_cases, toml_value
from verification.compare import DataError
from verification.measure import Result

FLOWS = ("couette", "poiseuille", "rough_channel", "taylor_green")  # what the fake solver can do
DISCS = (
    "disc_added_mass",
    "disc_array_drag",
    "disc_conservation",
    "disc_flight",
    "disc_near_wall",
    "disc_pair",
    "disc_pair_ensemble",
    "disc_rotating",
    "disc_settling",
    "disc_still",
)

POLISHING = (
    "abrasive_free",
    "abrasives",
    "gaussian_asperity",
    "rough_pad",
    "rough_pad_profile",
    "single_abrasive",
    "wafer_feature",
)
SWEEPS = ("abrasives", "disc_added_mass", "gaussian_asperity")  # of which the gate runs some points only


@pytest.fixture
def solver(monkeypatch):
    fake = FakeSolver()
    monkeypatch.setattr(execute, "call", fake.call)
    return fake


def verify(tmp_path, *arguments, load=load):
    options = ["--solver", sys.executable, "--out", str(tmp_path), "--no-report", *arguments]
    status = run.main(options if "--baseline" in arguments else [*options, "--no-baseline"], load)
    return status, json.loads((tmp_path / "results.json").read_text())


def checks_of(results):
    return {c["quantity"]: c for case in results["cases"] if case["finest"] for c in case["checks"]}


def test_a_gate_run_of_everything_passes(solver, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(run, "load_cases", lambda: [load_case(name) for name in FLOWS])
    status, results = verify(tmp_path)
    assert status == 0
    assert results["passed"]
    assert results["complete"]
    assert solver.calls == len(results["cases"]) == 30
    shear = next(c for c in results["cases"] if c["case"] == "rough_channel" and c["finest"])
    for key in (
        "variant",
        "spacing_m",
        "fluid_particles",
        "steps",
        "threads",
        "wall_s",
        "particle_steps_per_s",
    ):
        assert key in shear
    velocity = shear["checks"][0]
    assert velocity["value"] == pytest.approx(ERROR / 9)
    assert velocity["order"] == pytest.approx(2)
    assert velocity["order_band"] == [0.8, 3.0]
    assert capsys.readouterr().out.splitlines()[-1] == "40 passed, 0 failed"


def test_no_order_is_asked_of_errors_below_the_floor(solver, tmp_path):
    # Four times as large at the coarsest spacing: below and above 5e-5.
    for error, band in ((1e-5, None), (2e-5, [0.8, 3.0])):
        solver.error = error
        status, results = verify(tmp_path, "--case", "couette", "--scheme", "default")
        assert status == 0
        assert checks_of(results)["velocity at 0.0001 s"]["order_band"] == band


def test_coarse_spacings_carry_no_tolerance(solver, tmp_path):
    solver.error = 0.03  # at s = 1; the finest of Couette
    status, results = verify(tmp_path, "--case", "couette", "--scheme", "default")
    assert status == 1
    coarse = [c for case in results["cases"] if not case["finest"] for c in case["checks"]]
    assert all(c["tolerance"] is None and c["passed"] and c["value"] > 0.005 for c in coarse)
    assert "above tolerance" in checks_of(results)["velocity at 5e-06 s"]["reason"]


@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        ("nan", "velocity_x of the particles holds 1 values that are not finite"),
        ("short", "is at 9e-05 s, wanted 0.0001 s"),
        ("lost", "holds 399 of 400 fluid particles"),
        ("no_file", "result.h5 cannot be read"),
        (
            "exit status 3: step 12: a velocity is not finite",
            "exit status 3: step 12: a velocity is not finite",
        ),
    ],
)
def test_a_bad_result_fails_with_its_reason(solver, tmp_path, fault, reason, capsys):
    solver.fault = fault
    status, results = verify(tmp_path, "--case", "couette", "--scheme", "default")
    assert status == 1
    check = checks_of(results)["velocity at 0.0001 s"]
    assert (check["passed"], check["value"]) == (False, None)
    assert reason in check["reason"]
    assert reason in capsys.readouterr().out


@pytest.mark.parametrize(
    ("fault", "quantity", "reason"),
    [
        ("no_probe", "wafer_shear", "no probes/wafer"),
        ("backwards", "kinetic_energy_steady", "do not increase"),
        ("short", "wafer_pressure", "the last sample of probe wafer is at"),
        ("short", "kinetic_energy_steady", "the last sample of series kinetic_energy is at"),
    ],
)
def test_bad_probes_and_series(solver, tmp_path, fault, quantity, reason):
    solver.fault = fault
    arguments = ("--case", "rough_channel", "--scheme", "default", "--spacings", "2.5e-7")
    status, results = verify(tmp_path, *arguments)
    assert status == 1
    assert reason in checks_of(results)[quantity]["reason"]


def test_one_variant_alone_cannot_be_compared_with_the_other(solver, tmp_path):
    arguments = ("--case", "rough_channel", "--variant", "top_wall_moves", "--spacings", "2.5e-7")
    assert (
        "no run of bottom_wall_moves"
        in checks_of(verify(tmp_path, *arguments)[1])["wafer_shear_of_variants"]["reason"]
    )


def test_a_broken_reference_fails_its_checks_only(solver, tmp_path):
    def broken(name, *rest):
        if name == "taylor_green":
            raise ValueError("file.h5: truncated")
        return FakeReference()

    status, results = verify(tmp_path, "--case", "taylor_green", "--case", "couette", load=broken)
    assert status == 1
    assert "ValueError: file.h5: truncated" in checks_of(results)["velocity"]["reason"]
    assert all(c["passed"] for case in results["cases"] if case["case"] == "couette" for c in case["checks"])


def test_settings_for_the_solver_alone(solver, tmp_path):
    arguments = ("--case", "couette", "--spacings", "5e-7", "--solver-set", "fluid.dynamic_viscosity=2e-3")
    status, results = verify(tmp_path, *arguments)
    assert status == 1
    assert not results["complete"]


def test_reuse_keeps_identical_runs_only(solver, tmp_path):
    arguments = ("--case", "couette", "--scheme", "default", "--spacings", "5e-7")
    for extra, calls in (
        ((), 1),
        ((), 2),
        (("--reuse",), 2),
        (("--reuse", "--solver-set", "start.seed=2"), 3),
    ):
        verify(tmp_path, *arguments, *extra)
        assert solver.calls == calls


def test_an_earlier_result_never_stands_in_for_a_failed_run(solver, tmp_path):
    arguments = ("--case", "couette", "--scheme", "default", "--spacings", "5e-7")
    assert verify(tmp_path, *arguments)[0] == 0
    solver.fault = "no_file"
    assert verify(tmp_path, *arguments)[0] == 1


@pytest.mark.parametrize(
    "arguments", [("--case", "no_such"), ("--solver", "no_such"), ("--solver", "pyproject.toml")]
)
def test_what_cannot_start_says_why_in_one_line(tmp_path, arguments, capsys):
    (tmp_path / "results.json").write_text("{}")
    assert run.main(["--solver", sys.executable, "--out", str(tmp_path), *arguments], load) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_a_real_process_reports_its_exit_status_and_last_line():
    code = "import sys; print('first\\nlast', file=sys.stderr); sys.exit(3)"
    assert execute.call([sys.executable, "-c", code], 30) == "exit status 3: last"
    assert execute.call([sys.executable, "-c", ""], 30) == ""
    assert "did not end within" in execute.call([sys.executable, "-c", "import time; time.sleep(30)"], 0.2)
    assert "could not be started" in execute.call(["/no/such/solver"], 1)


def test_the_regression_gate_is_part_of_the_verdict(solver, tmp_path, monkeypatch, capsys):
    stored = tmp_path / "baseline.json"
    key = "couette/default/couette/5e-07/velocity at 5e-06 s"
    monkeypatch.setattr(baseline, "load", lambda: json.loads(stored.read_text()))
    stored.write_text(json.dumps({"gate": {key: 1e-6}}))
    arguments = ["--solver", sys.executable, "--out", str(tmp_path), "--no-report", "--case", "couette"]
    assert run.main(arguments, load) == 1
    output = capsys.readouterr().out
    assert f"REGRESSION: {key}" in output
    assert output.splitlines()[-1] == "6 passed, 1 failed"


def test_known_shortfalls_are_shown_but_do_not_decide(solver, tmp_path, monkeypatch, capsys):
    case = load_case("couette")
    for entry in case.data["checks"]:
        entry["known_shortfall"] = {"default": "start-up is singular"}
    monkeypatch.setattr(run, "load_cases", lambda: [case])
    solver.error = 0.03
    status, results = verify(tmp_path, "--scheme", "default")
    assert (status, results["passed"]) == (1, False)  # nothing passed: nothing was verified
    check = checks_of(results)["velocity at 5e-06 s"]
    assert (check["passed"], check["known_shortfall"], check["note"]) == (False, True, "start-up is singular")
    output = capsys.readouterr().out.splitlines()
    assert output[0].startswith("KNOWN SHORTFALL: couette default")
    assert output[-1] == "0 passed, 0 failed"
    assert (
        verify(tmp_path, "--scheme", "wang2014")[1]["passed"] is False
    )  # marked for the default scheme only
    solver.fault = "nan"
    capsys.readouterr()
    verify(tmp_path, "--scheme", "default")
    assert capsys.readouterr().out.splitlines()[-1] == "0 passed, 9 failed"


def test_every_case_is_complete():
    cases = [case for case in load_cases() if "include" not in case.data]  # the hard ones have their own test
    assert [case.name for case in cases] == sorted([*FLOWS, *DISCS, *POLISHING])
    for case in cases:
        assert (case.scene_path.parent / "README.md").exists()
        assert case.schemes == (SCHEMES if case.name in FLOWS else ("default",))
        for level, variant in itertools.product(LEVELS, case.variants):
            too_long = level == "gate" and (case.name == "disc_pair_ensemble" or variant.name == "full")
            fewest = 0 if too_long or case.name in SWEEPS else 1
            assert len(case.spacings("default", level, variant.name)) >= (3 if case.name in FLOWS else fewest)
            assert case.checks("default", level, variant.name)
            for check in case.checks("default", level, variant.name):
                if check.data:
                    curves.within(check.data, check.window)


def test_tolerances_are_those_of_the_issue():
    checks = {
        c.quantity: c.tolerance
        for c in load_case("rough_channel").checks("default", "paper", "top_wall_moves")
    }
    assert checks["velocity"] <= 0.001
    assert checks["pressure"] == 0.003
    assert checks["wafer_pressure"] == 0.004
    assert checks["wafer_shear"] <= 0.004


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ('kind = "exact"', 'kind = "regression"', "kind regression"),
        ('metric = "relative_peak"', 'metric = "max"', "metric max"),
        ("gate = 0.002, ", "", "no tolerance for default, gate"),
        ("gate = 0.002", "gate = nan", "no tolerance"),
        ("gate = [1e-6, 7.142857e-7, 5e-7]", "gate = [1e-6, 5e-7]", "three spacings"),
        ("gate = [1e-6, 7.142857e-7, 5e-7]", "gate = [5e-7, 7e-7, 1e-6]", "coarse to fine"),
        ('field = "velocity"', 'feild = "velocity"', "unknown"),
        ("why =", "wy =", "missing"),
    ],
)
def test_a_misspelt_case_is_refused(tmp_path, old, new, reason):
    text = (Path(run.ROOT) / "couette" / "checks.toml").read_text()
    assert old in text
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / "checks.toml").write_text(text.replace(old, new))
    with pytest.raises(CaseError, match=reason):
        load_case("bad", tmp_path)


def test_settings_are_written_as_toml():
    assert [toml_value(v) for v in ([0.0, -1], True, 'a"b', 5e-7)] == [
        "[0.0, -1]",
        "true",
        '"a\\"b"',
        "5e-07",
    ]
    case = load_case("rough_channel")
    settings = execute.Run(case, "wang2014", case.variants[1], 5e-7, True).settings()
    assert 'scene.scheme="wang2014"' in settings
    assert "walls.pad.velocity=[-1.0, 0.0]" in settings


def test_a_truncated_result_is_refused(solver, tmp_path):
    verify(tmp_path, "--case", "couette", "--scheme", "default", "--spacings", "5e-7")
    path = next(tmp_path.rglob("result.h5"))
    path.write_bytes(path.read_bytes()[:3000])
    with pytest.raises(DataError, match="cannot be read"):
        Result(path, 1e-4).particles()


def test_help_is_a_command_line():
    command = [sys.executable, "-m", "verification.run", "--help"]
    text = subprocess.run(command, capture_output=True, text=True, cwd=run.REPOSITORY, check=True).stdout
    assert "--level" in text
    assert isinstance(run.parse([]), argparse.Namespace)
