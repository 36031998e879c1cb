"""Which runs the workflow makes of a case, and that a run needs only its name."""

import json

import pytest
from verification_fakes import FakeSolver

from verification import run_one, workflow
from verification.case import CaseError, load_case
from verification.run_one import member
from verification.workflow import done_file, expected_seconds, runs_of, split

SCENE = """
[domain]
lower = [0.0, 0.0]
upper = [2e-5, 1e-5]
periodic = "x"
[fluid]
density = 1000.0
dynamic_viscosity = 1e-3
[numerics]
particle_spacing = 5e-7
sound_speed = 10.0
[start]
seed = 1
[output]
end_time = 1e-5
"""
CHECKS = """
schemes = ["default"]
[spacings]
gate = { sweep_1 = [1e-6, 5e-7], sweep_2 = [5e-7] }
paper = [2e-7]
[[variants]]
name = "sweep_1"
[[variants]]
name = "sweep_2"
[[checks]]
quantity = "energy"
at = "series"
field = "kinetic_energy"
from = 5e-6
metric = "largest_deviation"
tolerance = 0.1
kind = "exact"
why = "test"
"""
ENSEMBLE = """
[ensemble]
seed = "start.seed"
variants = ["sweep_2"]
seeds = { gate = [1, 2], paper = [1, 2, 3] }
spacings = { gate = [5e-7], paper = [2e-7] }
"""


@pytest.fixture
def case(tmp_path, request):
    folder = tmp_path / "trial"
    folder.mkdir()
    (folder / "scene.toml").write_text(SCENE)
    (folder / "checks.toml").write_text(CHECKS + getattr(request, "param", ENSEMBLE))
    return load_case("trial", tmp_path)


def names(runs):
    return [(run.variant.name, run.spacing) for run in runs]


@pytest.mark.parametrize("case", [""], indirect=True)
def test_a_sweep_runs_every_variant_at_every_spacing(case):
    assert names(runs_of(case, "gate")) == [("sweep_1", 1e-6), ("sweep_1", 5e-7), ("sweep_2", 5e-7)]
    assert [run.finest for run in runs_of(case, "gate")] == [False, True, True]


def test_an_ensemble_adds_its_members(case):
    assert names(runs_of(case, "gate"))[3:] == [("sweep_2_seed_1", 5e-7), ("sweep_2_seed_2", 5e-7)]
    assert len(runs_of(case, "paper")) == 2 + 3


@pytest.mark.parametrize("case", ['[ensemble]\nseed = "start.seed"\nvariants = ["sweep_1"]\n'], indirect=True)
def test_an_ensemble_without_seeds_is_refused(case):
    with pytest.raises(CaseError, match="needs spacings and seeds for gate"):
        runs_of(case, "gate")


def test_members_of_different_variants_never_share_a_seed():
    abrasives = load_case("abrasives")
    seeds = [
        member(abrasives, name, seed).set["discs.abrasive.seed"]
        for name in abrasives.data["ensemble"]["variants"]
        for seed in abrasives.data["ensemble"]["seeds"]["paper"]
    ]
    assert len(set(seeds)) == len(seeds) == 64


@pytest.mark.parametrize("asked", [("sweep_3", None), ("sweep_1", 1)])
def test_what_a_case_does_not_have_is_refused(case, asked):
    with pytest.raises(CaseError):
        member(case, *asked)


@pytest.mark.parametrize("name", ["count_04_seed_12", "sigma_02"])
def test_the_name_of_a_member_holds_its_seed(name):
    assert split(name) == {"count_04_seed_12": ("count_04", 12), "sigma_02": ("sigma_02", None)}[name]


def test_every_run_of_the_workflow_is_a_case_that_is_there():
    assert workflow.main([]) == 0
    assert workflow.main(["no_such_case"]) == 2


def test_duration_counts_only_what_is_not_there(case, tmp_path):
    runs = runs_of(case, "gate")
    for run in runs[:2]:
        done_file(run, tmp_path).parent.mkdir(parents=True)
        seconds = 3e-6 * run.expected_work()
        done_file(run, tmp_path).write_text(json.dumps({"wall_seconds": seconds, "threads": 1}))
    work = sum(run.expected_work() for run in runs[2:])
    assert expected_seconds(runs, tmp_path) == pytest.approx(3e-6 * work)


def test_a_run_by_its_name_and_not_twice(case, tmp_path, monkeypatch):
    solver = FakeSolver()
    monkeypatch.setattr("verification.execute.call", solver.call)
    monkeypatch.setattr(run_one, "load_case", lambda name: case)
    (tmp_path / "slurry").write_text("a solver")
    command = ["trial", "sweep_2", "--seed", "2", "--spacing", "5e-7"]
    command += ["--solver", str(tmp_path / "slurry"), "--out", str(tmp_path)]
    done = tmp_path / "runs/trial/default/sweep_2_seed_2/5e-07/run.json"
    assert run_one.main(command) == 0
    assert json.loads(done.read_text())["steps"] == 10
    done.unlink()  # as Snakemake does before it makes an output again
    assert run_one.main(command) == 0
    assert (done.exists(), solver.calls) == (True, 1)
    (tmp_path / "slurry").write_text("another solver")
    assert run_one.main(command) == 0
    assert solver.calls == 2


def test_a_run_that_goes_wrong_is_not_done(case, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("verification.execute.call", FakeSolver("exit status 3: it blew up").call)
    monkeypatch.setattr(run_one, "load_case", lambda name: case)
    (tmp_path / "slurry").write_text("a solver")
    command = ["trial", "sweep_1", "--spacing", "5e-7", "--solver", str(tmp_path / "slurry")]
    assert run_one.main([*command, "--out", str(tmp_path)]) == 3
    assert "it blew up" in capsys.readouterr().err
    assert not list(tmp_path.rglob("run.json"))


def test_a_seed_of_a_case_without_ensemble_is_refused(capsys):
    assert run_one.main(["couette", "couette", "--spacing", "5e-7", "--seed", "1"]) == 2
    assert "[ensemble]" in capsys.readouterr().err
