import json

import pytest

from verification import baseline

KEY = "case/default/variant/1e-06/velocity"


def results(value, tolerance=0.01, complete=True, passed=True, known=False):
    check = {"quantity": "velocity", "value": value, "tolerance_at_finest": tolerance, "passed": passed}
    case = {"case": "case", "scheme": "default", "variant": "variant", "spacing_m": 1e-6}
    cases = [case | {"checks": [check | {"known_shortfall": known}]}]
    return {"level": "gate", "complete": complete, "cases": cases}


@pytest.mark.parametrize(
    ("accepted", "value", "status"),
    [
        (0.005, 0.0054, "unchanged"),
        (0.005, 0.0056, "regression"),  # still inside the tolerance
        (0.005, 0.0046, "unchanged"),
        (0.005, 0.004, "improved"),
        (0.0001, 0.00029, "unchanged"),  # below the floor of 2 % of the tolerance
        (0.0001, 0.00031, "regression"),
        (0.0, 0.00019, "unchanged"),
        (0.0, 0.00021, "regression"),
        (None, 0.005, "new"),
        (0.005, None, "missing"),
    ],
)
def test_status(accepted, value, status):
    before = {} if accepted is None else {"gate": {KEY: accepted}}
    run = results(value)
    run["baseline"] = baseline.compare(run, before)
    assert [row["status"] for row in run["baseline"]] == [status]
    assert bool(baseline.failures(run)) is (status in ("regression", "missing"))
    assert bool(baseline.lines(run)) is (status != "unchanged")


@pytest.mark.parametrize(("complete", "missing"), [(True, 1), (False, 0)])
def test_an_accepted_value_must_not_vanish_from_a_complete_run(complete, missing):
    before = {"gate": {KEY: 0.005, "case/default/variant/1e-06/gone": 0.1}, "paper": {"other": 1.0}}
    run = results(0.005, complete=complete)
    run["baseline"] = baseline.compare(run, before)
    assert len(baseline.failures(run)) == missing


def test_accept_replaces_the_level_of_a_complete_run_and_adds_to_it_otherwise():
    before = {"gate": {"old": 1.0}, "paper": {"other": 1.0}}
    assert baseline.accept(results(0.00512345), before) == {"gate": {KEY: 0.005123}, "paper": {"other": 1.0}}
    assert baseline.accept(results(0.005, complete=False), before)["gate"] == {KEY: 0.005, "old": 1.0}
    assert before["gate"] == {"old": 1.0}


def test_only_a_passing_run_or_a_known_shortfall_is_accepted():
    with pytest.raises(ValueError, match="1 checks fail"):
        baseline.accept(results(0.02, passed=False), {})
    assert baseline.accept(results(0.02, passed=False, known=True), {}) == {"gate": {KEY: 0.02}}


def test_command_line(tmp_path, capsys):
    (tmp_path / "results.json").write_text(json.dumps(results(0.005)))
    options = ["--results", str(tmp_path / "results.json"), "--baseline", str(tmp_path / "baseline.json")]
    assert baseline.main(options) == 0
    assert not (tmp_path / "baseline.json").exists()
    assert baseline.main([*options, "--accept"]) == 0
    assert json.loads((tmp_path / "baseline.json").read_text()) == {"gate": {KEY: 0.005}}
    assert baseline.main([*options, "--accept"]) == 0
    assert "nothing has changed" in capsys.readouterr().out
    assert baseline.main(["--results", str(tmp_path / "none.json")]) == 2


def test_another_processor_scatters_more_but_not_without_limit():
    accepted = {"processor": "this one", "gate": {KEY: 0.005}}
    for processor, error, status in (
        ("this one", 0.0060, "regression"),
        ("another", 0.0060, "unchanged"),
        ("another", 0.0080, "regression"),
    ):
        found = results(error) | {"machine": {"processor": processor}}
        assert [row["status"] for row in baseline.compare(found, accepted)] == [status]
