"""The gate on instruction counts, with stand-ins for build and valgrind."""

import json
import math

import pytest

from verification import counts
from verification.compare import DataError

COMPILER = "g++ 12, glibc 2.36"
STEP_COST = 2000.0  # instructions for each particle and step
START_COST = 5_000_000
LISTS = {
    "list_evaluated": 36e3,
    "list_useful": 27e3,
    "list_rebuilds": 10.0,
    "bytes_per_particle": 400.0,
}
STORED = {
    "instructions_per_particle_step": STEP_COST,
    "evaluated_per_useful_pair": 36 / 27,
    "steps_per_list": counts.LONG / 10,
    "bytes_per_particle": 400.0,
}
CASES = [scene.case for scene in counts.SCENES]


def run_of(steps, step_cost=STEP_COST, **lists):
    attributes = {"fluid_particles": 100.0, "dummy_particles": 60.0, "steps": float(steps)}
    return counts.Run(START_COST + int(160 * steps * step_cost), attributes | lists)


@pytest.fixture
def gate(tmp_path, monkeypatch):
    """gate(*words): the command line's exit status; `gate.run` counts, `gate.stored` is counts.json."""

    class Gate:
        stored = tmp_path / "counts.json"
        run = staticmethod(lambda scene, steps, repetition: run_of(steps, **LISTS))
        watchdog_share = 0.004  # of a run's steps

        def __call__(self, *words):
            return counts.main(["--stored", str(self.stored), "--out", str(tmp_path), "--jobs", "2", *words])

        def store(self, compiler=COMPILER, **changes):
            cases = dict.fromkeys(CASES, STORED | changes)
            self.stored.write_text(json.dumps({"made_with": compiler, "cases": cases}))

    made = Gate()

    def count(solver, scene, steps, out, tool):
        run = made.run(scene.case, steps, int(out.name.split("_")[1]))
        if tool == counts.WATCHDOG:
            return counts.Run(made.watchdog_share * (run.instructions - START_COST), run.attributes)
        return run

    monkeypatch.setattr(counts, "build", lambda folder, jobs: folder / "slurry")
    monkeypatch.setattr(counts, "made_with", lambda folder: COMPILER)
    monkeypatch.setattr(counts, "count", count)
    return made


def test_unchanged_counts_pass_and_the_start_cancels(gate, capsys):
    gate.store()
    assert gate() == 0
    out = capsys.readouterr().out
    assert "2000, stored 2000 (+0.00 %)" in out
    assert out.splitlines()[-1] == "18 passed, 0 failed"


@pytest.mark.parametrize(
    ("factor", "status"), [(1.03, 1), (1.021, 1), (1.019, 0), (0.99, 0), (0.5, 0), (0, 1), (-1, 1)]
)
def test_a_growth_of_instructions_by_more_than_two_percent_fails(gate, factor, status):
    gate.store()
    gate.run = lambda case, steps, repetition: run_of(steps, factor * STEP_COST, **LISTS)
    assert gate() == status


@pytest.mark.parametrize("stored", [math.nan, math.inf, 0.0])
def test_a_stored_count_that_is_none_fails(gate, stored):
    gate.store(instructions_per_particle_step=stored)
    assert gate() == 1


@pytest.mark.parametrize(("share", "status"), [(0.0051, 1), (0.0049, 0), (0.0, 1), (math.nan, 1)])
def test_a_watchdog_that_takes_over_half_a_percent_or_is_not_found_fails(gate, share, status):
    gate.store()
    gate.watchdog_share = share
    assert gate() == status


def test_a_count_that_has_fallen_is_told(gate, capsys):
    gate.store(instructions_per_particle_step=1.03 * STEP_COST)
    assert gate() == 0
    assert capsys.readouterr().out.count("better: store it with --accept") == len(CASES)


@pytest.mark.parametrize(
    ("figure", "factor", "status"),
    [
        ("bytes_per_particle", 0.97, 1),
        ("bytes_per_particle", 1.03, 0),
        ("steps_per_list", 1.03, 1),
        ("steps_per_list", 0.97, 0),
        ("steps_per_list", math.nan, 1),
        ("bytes_per_particle", 0.0, 1),
    ],
)
def test_the_lists_figures_are_held_against_the_stored_ones(gate, figure, factor, status):
    gate.store(**{figure: STORED[figure] * factor})
    assert gate() == status


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"list_evaluated": 40e3}, "at most 1.45"),
        ({"list_useful": 0.0}, "not a positive number"),
        ({"list_evaluated": math.nan}, "not a positive number"),
        ({"bytes_per_particle": math.nan}, "not a positive number"),
        ({"list_rebuilds": 0.0}, "not a positive number"),
    ],
)
@pytest.mark.parametrize("compiler", [COMPILER, "another"])
def test_limits_and_numbers_hold_with_any_compiler(gate, capsys, compiler, changes, reason):
    gate.store(compiler)
    gate.run = lambda case, steps, repetition: run_of(steps, **LISTS | changes)
    assert gate() == 1
    assert reason in capsys.readouterr().out


def test_another_compiler_is_told_and_not_compared(gate, capsys):
    gate.store("clang 14")
    gate.run = lambda case, steps, repetition: run_of(steps, 3 * STEP_COST, **LISTS)
    assert gate() == 0
    out = capsys.readouterr().out
    assert f"not comparable: compiled with {COMPILER}, stored for clang 14" in out
    assert "not checked: rough_channel instructions_per_particle_step: 6000, not comparable" in out


@pytest.mark.parametrize("name", LISTS)
def test_an_attribute_that_was_there_must_not_go(gate, capsys, name):
    gate.store()
    gate.run = lambda case, steps, repetition: run_of(
        steps, **{key: value for key, value in LISTS.items() if key != name}
    )
    assert gate() == 1
    assert ": missing" in capsys.readouterr().out


def test_attributes_that_were_never_there_are_not_checked(gate, capsys):
    gate.stored.write_text(
        json.dumps(
            {
                "made_with": COMPILER,
                "cases": {c: {"instructions_per_particle_step": STEP_COST} for c in CASES},
            }
        )
    )
    gate.run = lambda case, steps, repetition: run_of(steps)
    assert gate() == 0
    assert capsys.readouterr().out.count("not checked: ") == 3 * len(CASES)


@pytest.mark.parametrize("second", [1.01 * STEP_COST, math.inf])
def test_a_count_that_does_not_repeat_fails(gate, capsys, second):
    gate.store()

    def run(case, steps, repetition):
        made = run_of(steps, **LISTS)
        cost = second if repetition else STEP_COST
        return counts.Run(START_COST + 160 * steps * cost, made.attributes)

    gate.run = run
    assert gate() == 1
    assert "FAILED: rough_channel repeats" in capsys.readouterr().out


@pytest.mark.parametrize(
    "error", [counts.CountError("exit status 3: unstable"), DataError("cannot be read"), KeyError("steps")]
)
def test_a_run_without_count_fails(gate, capsys, error):
    gate.store()

    def run(case, steps, repetition):
        if case == "rough_channel":
            raise error
        return run_of(steps, **LISTS)

    gate.run = run
    assert gate() == 1
    assert capsys.readouterr().out.splitlines()[-1] == "12 passed, 1 failed"


def test_nothing_stored_fails_until_it_is_accepted(gate, capsys):
    assert gate() == 1
    assert "nothing is stored" in capsys.readouterr().out
    assert gate("--accept") == 0
    assert json.loads(gate.stored.read_text())["made_with"] == COMPILER
    assert gate() == 0
    assert [path.name for path in gate.stored.parent.iterdir()] == ["counts.json"]


def test_what_breaks_a_limit_is_not_accepted(gate, capsys):
    gate.store()
    before = gate.stored.read_text()
    gate.run = lambda case, steps, repetition: run_of(steps, **LISTS | {"list_evaluated": 40e3})
    assert gate("--accept") == 2
    assert "not stored" in capsys.readouterr().err
    assert gate.stored.read_text() == before


def test_what_valgrind_prints():
    assert counts.parse_instructions("==7== \n==7== I   refs:      62,712,872\n") == 62712872
    with pytest.raises(counts.CountError, match="no number"):
        counts.parse_instructions("==7== Valgrind is tired")


def test_a_build_that_fails_ends_with_status_2(monkeypatch, tmp_path, capsys):
    def build(folder, jobs):
        raise counts.CountError("this failed: cmake")

    monkeypatch.setattr(counts, "build", build)
    assert counts.main(["--build", str(tmp_path), "--stored", str(tmp_path / "none")]) == 2
    assert "cmake" in capsys.readouterr().err


def test_scenes_are_as_the_settings_take_them():
    for scene in counts.SCENES:
        text = (counts.ROOT / scene.case / "scene.toml").read_text()
        assert f"sound_speed = {scene.sound_speed}" in text
    assert isinstance(counts.SHORT, int) and counts.SHORT < counts.LONG
