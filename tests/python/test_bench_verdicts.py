import math

import pytest

from verification.bench.plan import load_plan
from verification.bench.verdicts import MET, MISSED, SKIPPED, meets, verdicts

PLAN = load_plan(quick=False)


def point(**changes):
    plain = {"arithmetic": "float", "threads": 1, "wall_s": 1.0, "spacing_m": 0.02, "settings": {}}
    return plain | {"errors": {}, "failure": "", "variant": "v", "build": "this"} | changes


def channel_points():
    """Of the rough channel: the default scheme is within 1 % at once, the paper's never."""
    channel = {"case": "rough_channel", "threads": 2}
    return [
        point(**channel, scheme=scheme, spacing_m=spacing, wall_s=wall, step_s=step)
        | {"errors": {"wafer_shear": error}}
        for scheme, spacing, wall, step, error in (
            ("default", 5e-7, 0.3, 1e-4, 0.003),
            ("default", 2.5e-7, 1.4, 3e-4, 0.002),
            ("wang2014", 5e-7, 0.9, 1e-4, 0.04),
            ("wang2014", 2.5e-7, 5.0, 4e-4, 0.02),
        )
    ]


def measured(**changes):
    """Results that meet every target."""
    rates = [
        point(arithmetic=arithmetic, threads=threads, whole_step_rate=rate * threads)
        for arithmetic, rate in (("float", 11e6), ("double", 6e6))
        for threads in (1, 2)
    ]
    rates.append(point(build="avx2", whole_step_rate=7e6))
    sizes = [(0.01, 90.0), (0.001, 100.0), (0.0005, 110.0)]
    rows = [
        {
            "spacing_m": spacing,
            "threads": threads,
            "ns_per_particle_step": cost / threads,
            "bytes_per_particle": 390.0,
        }
        for spacing, cost in sizes
        for threads in (1, 2)
    ]
    sweep = {"arithmetic": "float", "sweep": "forces", "share_of_fma_peak": 0.3, "share_of_port_bound": 0.8}
    runs = {
        "rate": rates,
        "steady": [point(wall_s=40.0, errors={"velocity": 1e-3}) for _ in range(2)],
        "decay": point(wall_s=5.5, errors={"0.5": 0.005, "2": 0.02}, settings={"numerics.acoustic_cfl": 1.0}),
        "equal_error": [
            point(wall_s=0.1, errors={"velocity": 0.03}),
            point(wall_s=0.5, errors={"velocity": 0.018}),
        ],
    }
    sections = {"target_runs": runs, "scaling": {"rows": rows}, "machine_bench": {"pair_sweeps": [sweep]}}
    sections |= {"speed_error": channel_points()}
    return {"quick": False, "peers": None, **sections, **changes}


def by_measure(results):
    return {row["measure"]: row for row in verdicts(results, PLAN)}


def test_all_targets_can_be_met():
    rows = by_measure(measured())
    assert [row["status"] for row in rows.values()] == [MET] * len(PLAN["targets"])
    assert rows["equal_error.peer_over_ours"]["value"] == pytest.approx(43 / 0.5)
    assert "no run of make bench-peers" in rows["equal_error.peer_over_ours"]["note"]
    assert rows["scaling.cost_growth"]["value"] == pytest.approx(110 / 90)
    assert "numerics.acoustic_cfl = 1.0" in rows["decay.seconds"]["note"]


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_meets_nothing(value):
    assert not meets(value, {"at_least": 0.0})
    assert not meets(value, {"at_most": 1.0})
    assert not meets(1.0, {})


def test_missing_numbers_are_missed_not_met():
    results = measured()
    runs = results["target_runs"]
    for row in runs["rate"]:
        row["whole_step_rate"] = None
    runs["steady"][1] |= {"failure": "exit status 3", "errors": {}}
    runs["decay"]["errors"] = {"0.5": None, "2": None}
    for row in runs["equal_error"]:
        row["errors"] = {"velocity": None}
    for row in results["scaling"]["rows"][-2:]:
        row |= {"ns_per_particle_step": None, "bytes_per_particle": None}
    results["machine_bench"]["pair_sweeps"].append({"arithmetic": "float", "sweep": "density"})
    for row in results["speed_error"]:
        row |= {"errors": {}, "step_s": None}
    rows = by_measure(results)
    met = {name for name, row in rows.items() if row["status"] == MET}
    assert met == {"decay.seconds"}
    assert all(row["value"] is None for name, row in rows.items() if name not in met)


def test_a_nan_error_beside_the_steady_runs_spoils_their_time():
    results = measured()
    results["target_runs"]["steady"][0]["errors"]["pressure"] = None
    assert by_measure(results)["steady.seconds"]["status"] == MISSED


def test_sections_that_were_not_run_are_skipped():
    rows = by_measure({"quick": False})
    assert {row["status"] for row in rows.values()} == {SKIPPED}


def test_a_quick_trial_meets_nothing():
    assert {row["status"] for row in by_measure(measured(quick=True)).values()} == {SKIPPED}


def test_the_best_run_of_a_peer_is_the_one_to_beat():
    run = {"code": "PySPH", "case": "taylor_green", "set": {}, "failure": ""}
    runs = [
        run | {"scheme": "tvf", "wall_s": 20.0, "own_errors": {"l1": 0.09}},
        run | {"scheme": "edac", "wall_s": 24.0, "own_errors": {"l1": 0.019}},
        run
        | {
            "scheme": "other flow",
            "wall_s": 99.0,
            "own_errors": {"l1": 0.001},
            "set": {"output.end_time": 1},
        },
        run | {"scheme": "failed", "wall_s": None, "own_errors": {}, "failure": "exit status 1"},
    ]
    row = by_measure(measured(peers={"runs": runs}))["equal_error.peer_over_ours"]
    assert row["value"] == pytest.approx(24 / 0.5)
    assert row["status"] == MISSED
    assert "PySPH edac: 24.0 s" in row["note"]


def test_a_solver_without_a_choice_of_arithmetic_skips_double():
    results = measured()
    rates = [r for r in results["target_runs"]["rate"] if r["arithmetic"] == "float"]
    results["target_runs"]["rate"] = [row | {"arithmetic": "built-in"} for row in rates]
    rows = by_measure(results)
    assert rows["rate.float.2"]["status"] == MET
    assert rows["rate.double.1"]["status"] == SKIPPED
    assert rows["rate.avx2_share"]["value"] == pytest.approx(7 / 11)


def test_the_paper_s_scheme_is_the_yardstick():
    rows = by_measure(measured())
    assert rows["paper.time_to_error"]["value"] == pytest.approx(0.3 / 5.0)
    assert "wang2014 5 s at 2 %" in rows["paper.time_to_error"]["note"]
    assert rows["paper.step_cost"]["value"] == pytest.approx(0.75)


def test_a_default_that_never_comes_within_the_error_meets_nothing():
    points = [p | {"errors": {"wafer_shear": 0.02}} for p in channel_points()]
    assert by_measure(measured(speed_error=points))["paper.time_to_error"]["status"] == MISSED


def test_what_the_ports_allow_stands_beside_the_share_of_the_peak():
    assert "of what the ports allow: forces 80 %" in by_measure(measured())["machine.share_of_peak"]["note"]
