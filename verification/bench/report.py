"""speed_error.json, and the report of it: report.md, and report.html with the figures inside.

A run of make bench-peers beside it (peers.json) is shown with it, whichever came first.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure

from verification.bench import figures
from verification.bench.files import write_figure, write_json, write_whole
from verification.bench.plan import load_plan
from verification.bench.verdicts import MET, MISSED, SKIPPED, verdicts
from verification.figures import STYLE
from verification.markers import replace_between
from verification.page import Block, Picture, Table, to_html, to_markdown

RESULTS = "speed_error.json"
PEERS = "peers.json"
HEADING = "Speed and error"
PAGE_CASES = ("rough_channel", "taylor_green")  # whose points the page shows


def write(out: Path, results: dict[str, Any]) -> None:
    """Adds peers and verdicts to the results (in place) and writes the JSON, the figures and the report."""
    write_json(out / RESULTS, results)  # first of all: hours of runs are in it
    peers = out / PEERS
    results["peers"] = json.loads(peers.read_text()) if peers.exists() else None
    results["targets"] = verdicts(results, load_plan(results["quick"]))
    write_json(out / RESULTS, results)
    pictures, notes = draw(results, out / "figures")
    content, title = blocks(results, pictures, notes), headline(results)
    passed = not results["failures"] and all(row["status"] == MET for row in results["targets"])
    write_whole(out / "report.md", to_markdown(title, content, out, HEADING))
    write_whole(out / "report.html", to_html(title, passed, content, HEADING))


def write_page(page: Path, results: Mapping[str, Any]) -> None:
    """Writes the parts of a page that the bench makes (see its markers): where it ran and the targets, and
    the points of PAGE_CASES on one thread and the runs of another code, which stay where they were not
    measured. Raises ValueError without the markers.
    """
    table = target_table(results).markdown()
    replace_between(page, "targets", f"{where(results)}: {headline(results)}.\n\n{table}")
    if "speed_error" in results:
        points = [p for p in results["speed_error"] if p["case"] in PAGE_CASES and p["threads"] == 1]
        replace_between(page, "points", point_table(points).markdown())
    if results.get("peers"):
        write_peers(page, results["peers"])


def write_peers(page: Path, peers: Mapping[str, Any]) -> None:
    """Writes another code's runs and ours beside them into a page; ValueError without the markers."""
    version = f"PySPH {peers['pysph']['version']}, {peers['pysph']['compiler_flags']}"
    text = f"{where(peers)}; {version}. {peers['description']}\n\n{peer_table(peers).markdown()}"
    replace_between(page, "peers", text)


def where(results: Mapping[str, Any]) -> str:
    """The machine and the day; with `slurry bench`, what the machine can do at most, whatever its name."""
    machine, bench = results["machine"], results.get("machine_bench") or {}
    peak = bench.get("fma_peak_gflops", {}).get("float", {}).get("one_core")
    facts = [machine["processor"], f"{machine['cores']} cores"]
    facts += [f"{number(peak)} Gflop/s of fused multiply-adds in float on one core"] if peak else []
    return ", ".join([*facts, results["generated"][:10]])


def headline(results: Mapping[str, Any]) -> str:
    counts = {
        status: sum(t["status"] == status for t in results["targets"]) for status in (MET, MISSED, SKIPPED)
    }
    text = f"{counts[MET]} targets met, {counts[MISSED]} missed, {counts[SKIPPED]} skipped"
    if results["failures"]:
        text += f"; {len(results['failures'])} FAILED"
    return ("Quick trial: " if results["quick"] else "") + text


def number(value: float | None, unit: str = "") -> str:
    return "none" if value is None else f"{value:.3g}{' ' + unit if unit else ''}"


def percent(value: float | None) -> str:
    return "none" if value is None else f"{100 * value:.3g} %"


def limit(target: Mapping[str, Any]) -> str:
    parts = [f"at least {target['at_least']:.3g}"] if "at_least" in target else []
    parts += [f"at most {target['at_most']:.3g}"] if "at_most" in target else []
    return f"{' and '.join(parts)} {target['unit']}"


def print_targets(results: Mapping[str, Any]) -> None:
    for row in results["targets"]:
        note = f" ({row['note']})" if row["note"] else ""
        print(
            f"{row['status']}: {row['name']}: {number(row['value'], row['unit'])}, target {limit(row)}{note}"
        )
    print(headline(results))


def target_table(results: Mapping[str, Any]) -> Table:
    styles = {MET: "", MISSED: "failed", SKIPPED: "known"}
    rows = [
        (styles[t["status"]], (t["name"], number(t["value"], t["unit"]), limit(t), t["status"], t["note"]))
        for t in results["targets"]
    ]
    return Table(("target", "measured", "wanted", "verdict", "how"), rows)


def errors(point: Mapping[str, Any]) -> str:
    return point["failure"] or ", ".join(
        f"{name} {percent(value)}" for name, value in point["errors"].items()
    )


def point_table(points: list[dict[str, Any]]) -> Table:
    head = ("case", "scheme", "arithmetic", "threads", "spacing (m)", "fluid particles", "steps", "wall (s)")
    rows = []
    for p in points:
        case = p["case"] if p["case"] == p["variant"] else f"{p['case']}, {p['variant']}"
        cells = (
            case,
            p["scheme"],
            p["arithmetic"],
            str(p["threads"]),
            f"{p['spacing_m']:g}",
            str(p["fluid_particles"]),
        )
        speed = (str(p["steps"]), number(p["wall_s"]), number(p["particle_steps_per_s"]))
        rows.append(("failed" if p["failure"] else "", (*cells, *speed, errors(p))))
    return Table((*head, "particle-steps/s", "errors"), rows)


def ablation_tables(rows: list[dict[str, Any]]) -> list[Table]:
    """A table for each case: its errors have columns of their own."""
    tables = []
    for case in dict.fromkeys(row["case"] for row in rows):
        own = [row for row in rows if row["case"] == case]
        quantities = list(dict.fromkeys(name for row in own for name in row["errors"]))
        head = (f"{case}, {own[0]['spacing_m']:g} m", "time per step (ms)", "over the default's", *quantities)
        lines = []
        for row in own:
            step = None if row["step_s"] is None else 1e3 * row["step_s"]
            cells = [row["name"], number(step), number(row["relative_step_time"])]
            cells += [percent(row["errors"].get(name)) for name in quantities]
            style = "failed" if row["failure"] else ""
            lines.append((style, (*cells, row["failure"] or row["better"])))
        tables.append(Table((*head, "better"), lines))
    return tables


def scaling_table(rows: list[dict[str, Any]]) -> Table:
    head = (
        "particles",
        "threads",
        "steps",
        "ns per particle-step",
        "peak memory (bytes)",
        "bytes per particle",
    )
    keys = (
        "particles",
        "threads",
        "steps",
        "ns_per_particle_step",
        "peak_memory_bytes",
        "bytes_per_particle",
    )
    lines = [
        (
            "failed" if row["failure"] else "",
            [number(row[key]) if key[0] in "nb" else str(row[key]) for key in keys],
        )
        for row in rows
    ]
    return Table(head, lines)


def peer_table(peers: Mapping[str, Any]) -> Table:
    head = (
        "code",
        "case",
        "scheme",
        "arithmetic",
        "fluid particles",
        "steps",
        "wall (s)",
        "errors",
        "its own errors",
    )
    rows = []
    for run in [*peers["runs"], *peers["ours"]]:
        own = ", ".join(f"{name} {percent(value)}" for name, value in run["own_errors"].items())
        cells = (
            run["code"],
            run["case"],
            run["scheme"],
            run["arithmetic"],
            str(run["fluid_particles"]),
            str(run["steps"]),
        )
        rows.append(("failed" if run["failure"] else "", (*cells, number(run["wall_s"]), errors(run), own)))
    return Table(head, rows)


def blocks(results: Mapping[str, Any], pictures: list[Picture], undrawn: list[str]) -> list[Block]:
    machine = results["machine"]
    content: list[Block] = [
        f"Commit {results['commit']}, {results['generated']}, {machine['processor']} "
        f"({machine['cores']} cores), {machine['system']}. "
        f"Load average at the start: {results['load_average_at_start']:.2f}.",
        *[f"FAILED: {failure}" for failure in results["failures"]],
        *[f"Note: {note}." for note in results["notes"]],
        "# Targets",
        target_table(results),
    ]
    by_name = {picture.name.split("-")[0]: [] for picture in pictures}
    for picture in pictures:
        by_name[picture.name.split("-")[0]].append(picture)
    if results.get("speed_error"):
        content += [
            "# Error against wall time",
            "Errors are those of `make verify`, against exact or finite-element solutions. The wall time is "
            "the solver's own, start and output included; of short runs the median counts.",
            *by_name.get("error", []),
            point_table(results["speed_error"]),
        ]
    if peers := results["peers"]:
        content += [
            "# Beside another code",
            f"{peers['description']} Measured {peers['generated']}, commit {peers['commit']}.",
            peer_table(peers),
        ]
    if results.get("ablation"):
        content += [
            "# What each part costs and brings",
            "One part of the default scheme changed at a time, one thread. The time of a step leaves out "
            "start, output and checks. Better: where time and all errors speak for one side, that side.",
            *ablation_tables(results["ablation"]),
        ]
    if results.get("scaling"):
        content += ["# Size", *by_name.get("scaling", []), scaling_table(results["scaling"]["rows"])]
    if by_name.get("search"):
        content += ["# Neighbour searches", *by_name["search"]]
    return content + undrawn


def draw(results: Mapping[str, Any], folder: Path) -> tuple[list[Picture], list[str]]:
    """A figure for all that was measured; one that cannot be drawn becomes a note."""
    shutil.rmtree(folder, ignore_errors=True)
    wanted: list[tuple[str, str, Callable[[], Figure]]] = []
    for case, variant in dict.fromkeys((p["case"], p["variant"]) for p in results.get("speed_error") or []):
        caption = f"Error against wall time: {case.replace('_', ' ')}, {variant.replace('_', ' ')}."
        wanted.append(
            (
                f"error-{case}-{variant}",
                caption,
                lambda case=case, variant=variant: figures.error_against_time(results, case, variant),
            )
        )
    if results.get("scaling"):
        caption = "Cost of a particle-step and memory of a particle against the number of particles."
        wanted.append(("scaling", caption, lambda: figures.scaling(results)))
    if results.get("machine_bench"):
        wanted.append(("search", "Neighbour searches: time per point.", lambda: figures.search(results)))
    pictures, notes = [], []
    for name, caption, make in wanted:
        try:
            with matplotlib.rc_context(STYLE):
                write_figure(folder / f"{name}.png", make())
            pictures.append(Picture(name, folder / f"{name}.png", caption))
        except (ValueError, KeyError) as error:  # the numbers stand in the tables all the same
            notes.append(f"No figure {name}: {type(error).__name__}: {error}.")
    return pictures, notes
