"""The report: report.md, and report.html with the figures inside, from results.json and the runs beside it.

`python -m verification.report` makes it again; `--readme README.md` writes the table of results between the
markers of that file, `--picture FILE` copies the main figure.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib

from verification import abrasive_figures, asperity_figures, baseline, disc_figures, feature_figures, figures
from verification.case import ROOT, CaseError, Variant, load_case
from verification.compare import DataError
from verification.figures import STYLE, Data
from verification.gallery import cards, title
from verification.page import Block, Picture, Table, to_html, to_markdown
from verification.results import standing, summary

MARKERS = ("<!-- results:begin -->", "<!-- results:end -->")
MAIN_FIGURE = "rough_channel_wafer"
FIGURE_FILES = (figures, disc_figures, asperity_figures, feature_figures, abrasive_figures)
FIGURES = {name: draw for file in FIGURE_FILES for name, draw in file.FIGURES.items()}
CAPTIONS = {name: caption for file in FIGURE_FILES for name, caption in file.CAPTIONS.items()}


def percent(value: float | None) -> str:
    return "none" if value is None else f"{100 * value:.3g} %"


def amount(value: float | None, check: dict[str, Any]) -> str:
    """A relative error as percentage, an absolute one with its unit."""
    return f"{value:.3g} {check['unit']}" if check["unit"] and value is not None else percent(value)


def _verdict(check: dict[str, Any]) -> tuple[str, str]:
    if check["reported"]:
        return ("", "reported: within") if check["passed"] else ("known", "reported: not within")
    verdicts = {
        "passed": ("", "passed"),
        "known": ("known", "known shortfall"),
        "failed": ("failed", "FAILED"),
    }
    return verdicts[standing(check)]


def _order(check: dict[str, Any]) -> str:
    order = "none" if check["order"] is None else f"{check['order']:.2f}"
    if check["order_band"]:
        return f"{order} in [{check['order_band'][0]:g}, {check['order_band'][1]:g}]"
    return "" if check["order"] is None else order


def _all(results: dict[str, Any]) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    return [(case, check) for case in results["cases"] for check in case["checks"]]


def _run(case: dict[str, Any]) -> tuple[str, str, str, str]:
    name = case["case"] if case["case"] == case["variant"] else f"{case['case']}, {case['variant']}"
    return name, case["scheme"], f"{case['spacing_m']:g}", str(case["fluid_particles"])


RUN_HEAD = ("case", "scheme", "spacing (m)", "particles")


def verification_table(results: dict[str, Any]) -> Table:
    rows = []
    for case, check in _all(results):
        if case["finest"]:
            style, verdict = _verdict(check)
            numbers = (amount(check["value"], check), amount(check["tolerance"], check))
            cells = (check["quantity"], check["metric"], *numbers)
            rows.append((style, (*_run(case), *cells, _order(check), check["kind"], verdict)))
    return Table((*RUN_HEAD, "quantity", "metric", "error", "tolerance", "order", "kind", "verdict"), rows)


def failure_table(results: dict[str, Any]) -> Table:
    rows = [
        (_verdict(check)[0], (*_run(case), check["quantity"], check["reason"], check["note"]))
        for case, check in _all(results)
        if not check["passed"]
    ]
    return Table((*RUN_HEAD, "quantity", "reason", "known shortfall"), rows)


def definition_table(results: dict[str, Any]) -> Table:
    rows: dict[tuple[str, str], tuple[str, ...]] = {}
    for case, check in _all(results):
        row = tuple(check[key] for key in ("quantity", "metric", "scale", "source", "why"))
        rows.setdefault((case["case"], check["quantity"]), (case["case"], *row))
    head = ("case", "quantity", "metric", "scale", "held against", "why this tolerance")
    return Table(head, [("", row) for row in rows.values()])


def run_table(results: dict[str, Any]) -> Table:
    rows = []
    for case in results["cases"]:
        errors = ", ".join(f"{check['quantity']} {amount(check['value'], check)}" for check in case["checks"])
        speed = (f"{case['wall_s']:.1f}", f"{case['particle_steps_per_s']:.3g}")
        cells = (*_run(case), str(case["steps"]), str(case["threads"]), *speed, errors)
        rows.append(("" if case["passed"] else "failed", cells))
    return Table((*RUN_HEAD, "steps", "threads", "wall (s)", "particle-steps/s", "errors"), rows)


def baseline_table(results: dict[str, Any]) -> Table:
    rows = []
    for row in results["baseline"]:
        style = "failed" if row in baseline.failures(results) else ""
        rows.append(
            (style, (row["key"], *(amount(row[k], row) for k in ("accepted", "value")), row["status"]))
        )
    return Table(("check", "accepted", "now", "status"), rows)


def blocks(results: dict[str, Any], pictures: Sequence[Picture], notes: Sequence[str]) -> list[Block]:
    machine = results["machine"]
    content: list[Block] = [
        f"Level {results['level']}, commit {results['commit']}, {results['generated']}, "
        f"{machine['processor']} ({machine['cores']} cores), {machine['system']}.",
        cards(results, pictures),
        "# Verification",
        "A check passes only if its error at the finest spacing is finite and at most its tolerance, and the "
        "observed order over the spacings lies in its band where one is stated.",
        verification_table(results),
    ]
    if (failures := failure_table(results)).rows:
        content += ["# What fails, and why", failures]
    content.append("# Figures")
    for case in dict.fromkeys(picture.case for picture in pictures):
        content += [f"## {title(case)}", *(picture for picture in pictures if picture.case == case)]
    content += notes
    content += ["# What the checks are", definition_table(results), "# Runs", run_table(results)]
    if "baseline" in results:
        changes = " ".join(baseline.lines(results)) or "Nothing has changed."
        content += [
            "# Regression gate",
            f"Our own earlier results: no verification. {changes}",
            baseline_table(results),
        ]
    return content


def headline(results: dict[str, Any]) -> str:
    found = [standing(check) for case, check in _all(results) if case["finest"]]
    passed, failed = summary(results)
    verdict = "PASSED" if results["passed"] else "FAILED"
    others = {"known": "known shortfalls", "reported": "only reported"}
    more = "".join(f", {found.count(style)} {name}" for style, name in others.items() if style in found)
    return f"{verdict}: {passed} checks passed, {failed} failed{more}"


def draw(results: dict[str, Any], out: Path, references: Any) -> tuple[list[Picture], list[str]]:
    """Every figure of every case in the results; one that cannot be drawn becomes a note that says why."""
    pictures, notes = [], []
    folder = out / "figures"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in dict.fromkeys(case["case"] for case in results["cases"]):
        case = load_case(name)

        def reference(variant: Variant, reference: str = "", case: Any = case) -> Any:
            return references.of(case, variant, reference)

        data = Data(case, [e for e in results["cases"] if e["case"] == name], out, reference)
        for kind in (*case.figures, "convergence", "cost"):
            try:
                with matplotlib.rc_context(STYLE):
                    path = folder / f"{name}_{kind}.png"
                    FIGURES[kind](data).savefig(path)
                caption = f"{name.replace('_', ' ')}: {CAPTIONS[kind]}"
                pictures.append(Picture(f"{name}_{kind}", path, caption, name))
            except (DataError, ValueError) as error:  # the check of the same data has failed and says so
                notes.append(f"No figure {kind} of {name}: {error}")
    return pictures, notes


def write(out: Path, references: Any) -> list[Picture]:
    """Writes report.md, report.html and figures/ beside out/results.json."""
    results = json.loads((out / "results.json").read_text())
    pictures, notes = draw(results, out, references)
    content, title = blocks(results, pictures, notes), headline(results)
    (out / "report.md").write_text(to_markdown(title, content, out))
    (out / "report.html").write_text(to_html(title, results["passed"], content))
    return pictures


def write_readme(readme: Path, results: dict[str, Any]) -> None:
    """Replaces what is between the markers of a Markdown file by the table of results: of the default scheme,
    without the hard cases, which are many rows of what a reader expects.
    """
    text = readme.read_text()
    if any(text.count(marker) != 1 for marker in MARKERS) or text.index(MARKERS[0]) > text.index(MARKERS[1]):
        raise CaseError(
            f"{readme}: needs the lines {MARKERS[0]} and {MARKERS[1]}, once each and in this order"
        )
    before, rest = text.split(MARKERS[0])
    hard = {path.name for path in (ROOT / "stability").iterdir()}
    chosen = [c for c in results["cases"] if c["scheme"] == "default" and c["case"] not in hard]
    table = verification_table(results | {"cases": chosen}).markdown()
    title = f"Level {results['level']}: {headline(results)}. Here the default scheme; the report has all."
    readme.write_text(f"{before}{MARKERS[0]}\n{title}\n\n{table}{MARKERS[1]}{rest.split(MARKERS[1])[1]}")


def main(argv: Sequence[str] | None = None, references: Callable[[], Any] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.report", description="Makes the report again."
    )
    parser.add_argument(
        "--out", type=Path, default=ROOT.parent / "build" / "verify", help="where results.json is"
    )
    parser.add_argument("--readme", type=Path, help="write the table of results into this file as well")
    parser.add_argument("--picture", type=Path, help="copy the main figure to this file")
    options = parser.parse_args(argv)
    if references is None:
        from verification.run import References as references  # run imports report
    try:
        pictures = write(options.out, references())
        if options.readme:
            write_readme(options.readme, json.loads((options.out / "results.json").read_text()))
        if options.picture:
            main_figure = next((p for p in pictures if p.name == MAIN_FIGURE), None)
            if main_figure is None:
                raise CaseError(f"there is no figure {MAIN_FIGURE} in {options.out}")
            options.picture.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(main_figure.path, options.picture)
    except (CaseError, OSError, ValueError) as error:
        print(f"report: {error}", file=sys.stderr)
        return 2
    print(options.out / "report.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
