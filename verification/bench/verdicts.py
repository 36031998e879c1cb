"""From the measured sections to the targets of plan.toml: MET, MISSED, or SKIPPED with the reason.

Measures: rate.<arithmetic>.<threads> and rate.avx2_share, steady.seconds, decay.seconds,
decay.energy_error.<time>, equal_error.peer_over_ours, scaling.cost_growth, scaling.memory,
machine.share_of_peak, paper.time_to_error, paper.step_cost. A measure that is NaN or came from a run that
failed never meets its target.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from verification.bench.session import BUILT_IN

MET, MISSED, SKIPPED = "MET", "MISSED", "SKIPPED"


@dataclass(frozen=True)
class Measure:
    value: float
    note: str = ""


def verdicts(results: Mapping[str, Any], plan: Mapping[str, Any]) -> list[dict[str, Any]]:
    """A row for each target of the plan."""
    found = measures(results, plan)
    return [_verdict(target, found.get(target["measure"]), results["quick"]) for target in plan["targets"]]


def _verdict(target: Mapping[str, Any], measure: Measure | None, quick: bool) -> dict[str, Any]:
    value = measure.value if measure else math.nan
    note = measure.note if measure else "not measured: see the notes"
    if quick:
        note = f"quick: not the size that the target is set for{'; ' + note if note else ''}"
    skipped = quick or measure is None
    status = SKIPPED if skipped else MET if meets(value, target) else MISSED
    limits = {key: target[key] for key in ("at_least", "at_most") if key in target}
    known = {"value": value if math.isfinite(value) else None, "unit": target["unit"]}
    return (
        {"name": target["name"], "measure": target["measure"]}
        | limits
        | known
        | {"status": status, "note": note}
    )


def meets(value: float, target: Mapping[str, Any]) -> bool:
    """Written so that NaN meets nothing, and neither does a target without a limit."""
    if not math.isfinite(value) or not ("at_least" in target or "at_most" in target):
        return False
    return value >= target.get("at_least", -math.inf) and value <= target.get("at_most", math.inf)


def measures(results: Mapping[str, Any], plan: Mapping[str, Any]) -> dict[str, Measure]:
    """Everything that the sections at hand say; a section that was not run adds nothing."""
    found: dict[str, Measure] = {}
    if runs := results.get("target_runs"):
        found |= _rates(runs["rate"])
        found["steady.seconds"] = _steady(runs["steady"])
        found |= _decay(runs["decay"])
        found["equal_error.peer_over_ours"] = _equal_error(
            runs["equal_error"], plan["target_runs"]["equal_error"], results.get("peers")
        )
    if scaling := results.get("scaling"):
        found |= _scaling(scaling["rows"])
    if points := results.get("speed_error"):
        found |= _against_paper(points, plan["speed_error"]["against_paper"])
    found |= _share_of_peak(results.get("machine_bench"))
    return found


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _rates(rows: Sequence[Mapping[str, Any]]) -> dict[str, Measure]:
    found = {}
    for row in rows:
        if row["build"] == "this":
            name = "float" if row["arithmetic"] == BUILT_IN else row["arithmetic"]
            note = "the solver has no choice of pair arithmetic" if row["arithmetic"] == BUILT_IN else ""
            found[f"rate.{name}.{row['threads']}"] = Measure(_number(row["whole_step_rate"]), note)
    for row in rows:
        if row["build"] == "avx2":
            rate = _number(row["whole_step_rate"])
            share = rate / found[f"rate.float.{row['threads']}"].value
            found["rate.avx2_share"] = Measure(share, f"{rate:.3g} particle-steps/s with AVX2")
    return found


def _errors(row: Mapping[str, Any]) -> str:
    if row["failure"]:
        return f"FAILED: {row['failure']}"
    return ", ".join(f"{name} {100 * _number(value):.2g} %" for name, value in row["errors"].items())


def _steady(rows: Sequence[Mapping[str, Any]]) -> Measure:
    note = "; ".join(f"{row['variant']}: {_number(row['wall_s']):.1f} s, {_errors(row)}" for row in rows)
    sound = rows and all(not row["failure"] and None not in row["errors"].values() for row in rows)
    return Measure(sum(_number(row["wall_s"]) for row in rows) if sound else math.nan, note)


def _decay(row: Mapping[str, Any]) -> dict[str, Measure]:
    settings = ", ".join(f"{key} = {value}" for key, value in row["settings"].items())
    note = f"FAILED: {row['failure']}" if row["failure"] else settings
    found = {"decay.seconds": Measure(math.nan if row["failure"] else _number(row["wall_s"]), note)}
    for time, value in row["errors"].items():
        found[f"decay.energy_error.{time}"] = Measure(_number(value))
    return found


def best_peer(peers: Mapping[str, Any] | None, case: str) -> Mapping[str, Any] | None:
    """The peer's run of the case as it is, not of another flow, with the lowest error by its own measure."""
    everything = peers["runs"] if peers else []
    runs = [run for run in everything if run["case"] == case and not run["set"] and not run["failure"]]
    runs = [run for run in runs if run["own_errors"].get("l1") is not None]
    return min(runs, key=lambda run: run["own_errors"]["l1"], default=None)


def _equal_error(
    rows: Sequence[Mapping[str, Any]], plan: Mapping[str, Any], peers: Mapping[str, Any] | None
) -> Measure:
    within = [
        row
        for row in rows
        if not row["failure"] and _number(row["errors"].get(plan["quantity"])) <= plan["error"]
    ]
    if peer := best_peer(peers, plan["peer_case"]):
        seconds = _number(peer["wall_s"])
        source = f"{peer['code']} {peer['scheme']}: {seconds:.1f} s at {100 * peer['own_errors']['l1']:.2g} %"
    else:
        seconds = plan["literature_s"]
        source = f"no run of make bench-peers here: {seconds:g} s, PySPH as measured earlier"
    if not within:
        return Measure(math.nan, f"no run of ours is within {100 * plan['error']:g} %; {source}")
    ours = min(within, key=lambda row: row["wall_s"])
    error = 100 * ours["errors"][plan["quantity"]]
    settings = "".join(f", {key} = {value}" for key, value in ours["settings"].items())
    note = (
        f"ours: {ours['wall_s']:.2f} s at {error:.2g} %, spacing {ours['spacing_m']:g} m{settings}; {source}"
    )
    return Measure(seconds / ours["wall_s"], note)


def _scaling(rows: Sequence[Mapping[str, Any]]) -> dict[str, Measure]:
    growth, notes = [], []
    for threads in sorted({row["threads"] for row in rows}):
        own = [row for row in rows if row["threads"] == threads]
        own.sort(key=lambda row: -row["spacing_m"])
        cost = [_number(row["ns_per_particle_step"]) for row in own]
        growth.append(cost[-1] / cost[0])
        notes.append(f"{threads} thread(s): {cost[0]:.1f} to {cost[-1]:.1f} ns")
    finest = min(row["spacing_m"] for row in rows)
    memory = [_number(row["bytes_per_particle"]) for row in rows if row["spacing_m"] == finest]
    return {
        "scaling.cost_growth": Measure(_extreme(max, growth), "the larger of both; " + ", ".join(notes)),
        "scaling.memory": Measure(_extreme(max, memory), "peak of the process, less that of 1e3 particles"),
    }


def _against_paper(points: Sequence[Mapping[str, Any]], plan: Mapping[str, Any]) -> dict[str, Measure]:
    """The default scheme's time over that of the paper's, to an error and for a step; of the case's variants
    the worst. Where the paper's scheme never comes within the error, its longest run counts: a lower bound.
    """
    same = {key: plan[key] for key in ("case", "threads", "arithmetic")}
    points = [p for p in points if not p["failure"] and all(p[key] == same[key] for key in same)]
    times, steps, notes = [], [], []
    for variant in sorted({p["variant"] for p in points}):
        default, paper = (
            sorted(
                (p for p in points if p["variant"] == variant and p["scheme"] == scheme),
                key=lambda p: p["wall_s"],
            )
            for scheme in ("default", "wang2014")
        )
        if not default or not paper:
            return {}
        first, other = (
            next((p for p in own if _number(p["errors"].get(plan["quantity"])) <= plan["error"]), None)
            for own in (default, paper)
        )
        seconds = first["wall_s"] if first else math.nan
        bound = other or paper[-1]
        times.append(seconds / bound["wall_s"])
        steps.append(_number(default[-1]["step_s"]) / _number(paper[-1]["step_s"]))
        reached = f"{bound['wall_s']:.3g} s at {100 * _number(bound['errors'].get(plan['quantity'])):.2g} %"
        notes.append(f"{variant}: {seconds:.2g} s, wang2014 {reached}")
    return {
        "paper.time_to_error": Measure(_extreme(max, times), "; ".join(notes)),
        "paper.step_cost": Measure(_extreme(max, steps), "at the finest spacing of both"),
    }


def _extreme(which: Callable[[Sequence[float]], float], values: Sequence[float]) -> float:
    """The largest or smallest; NaN if any is NaN, which max() and min() would lose."""
    return which(values) if values and all(map(math.isfinite, values)) else math.nan


def _share_of_peak(machine_bench: Any) -> dict[str, Measure]:
    """The lowest of the float pair sweeps; nothing when `slurry bench` was not run or does not say. The note
    has their shares of what the processor's ports allow, too: they are why the peak is out of reach.
    """
    sweeps = machine_bench.get("pair_sweeps", []) if isinstance(machine_bench, Mapping) else []
    sweeps = [sweep for sweep in sweeps if sweep.get("arithmetic") == "float"]
    if not sweeps:
        return {}
    peak, ports = (
        {str(sweep.get("sweep")): _number(sweep.get(key)) for sweep in sweeps}
        for key in ("share_of_fma_peak", "share_of_port_bound")
    )
    listed = [
        ", ".join(f"{name} {100 * share:.3g} %" for name, share in shares.items()) for shares in (peak, ports)
    ]
    note = f"the lowest of {listed[0]}; of what the ports allow: {listed[1]}"
    return {"machine.share_of_peak": Measure(_extreme(min, list(peak.values())), note)}
