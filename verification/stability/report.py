"""The map of margins: stability.json, report.md, report.html and a figure, from the answers of all tasks."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from verification.page import Block, Picture, Table, to_html, to_markdown
from verification.stability.margins import RESOLUTION, TARGET
from verification.stability.trial import BROKE, REFUSED, STOPPED, SURVIVED, WRONG

DEFAULTS = "defaults"
MARKS = {STOPPED: "stop", REFUSED: "refused", WRONG: "wrong", BROKE: "broke"}
BEYOND = {
    STOPPED: "the watchdog stops the run (exit status 3)",
    REFUSED: "the scene is refused (exit status 2)",
    WRONG: "the run ends, and its answer is wrong: nothing has said so",
    BROKE: "the run breaks otherwise",
}
COLOURS = ("#d7301f", "#fdae61", "#d9f0a3", "#41ab5d")  # below 1, below the target, above, no limit found
Answer = dict[str, Any]


def beyond(answer: Answer) -> dict[str, Any] | None:
    """The trial nearest beyond the limit; None where no limit was found."""
    broken = answer["broken_at"]
    worse = [t for t in answer["trials"] if t["end"] != SURVIVED and broken and t["factor"] >= broken]
    return min(worse, key=lambda trial: trial["factor"], default=None)


def standing(answer: Answer) -> str:
    return "" if answer["met"] else "known" if answer["known_shortfall"] else "failed"


def in_words(answer: Answer) -> str:
    trial = beyond(answer)
    if answer["direction"] == DEFAULTS:
        return "survived" if answer["met"] else f"{trial['end']}: {trial['reason']}" if trial else "failed"
    margin = f"{answer['margin']:.2f}" if answer["margin"] else "none"
    return f"margin {margin}, then {trial['end']}" if trial else f"margin at least {margin}"


def _number(value: Any) -> str:
    return f"[{', '.join(f'{v:.3g}' for v in value)}]" if isinstance(value, list) else f"{value:.3g}"


def _values(answer: Answer) -> str:
    """The first scaled key at the default, at the limit and beyond it."""
    key = next(iter(answer["trials"][0]["values"]))
    trial = beyond(answer)
    good = max((t for t in answer["trials"] if t["end"] == SURVIVED), key=lambda t: t["factor"], default=None)
    cells = [answer["trials"][0], good, trial]
    texts = [_number(t["values"][key]) if t and t["values"] else "none" for t in cells]
    return f"{key}: {texts[0]} → {texts[1]}, not {texts[2]}"


def defaults_table(answers: Sequence[Answer]) -> Table:
    rows = []
    for answer in [a for a in answers if a["direction"] == DEFAULTS]:
        trial = answer["trials"][0]
        how = trial["end"] + (f": {trial['reason']}" if trial["reason"] else "")
        cells = [answer["case"], answer["variant"], how, answer["known_shortfall"]]
        rows.append((standing(answer), cells))
    return Table(["case", "variant", "with the defaults", "known shortfall"], rows)


def margins_table(answers: Sequence[Answer]) -> Table:
    rows = []
    for answer in [a for a in answers if a["direction"] != DEFAULTS]:
        trial = beyond(answer)
        found = f"{answer['margin']:.2f}" + ("" if trial else " or more")
        how = f"{trial['end']}: {trial['reason']}" if trial else "no limit found"
        place = f"{answer['case']}, {answer['variant']}"
        cells = [place, answer["meaning"], found, _values(answer), how, answer["known_shortfall"]]
        rows.append((standing(answer), cells))
    head = ["case", "direction", "margin", "default → last good, first bad", "beyond", "known shortfall"]
    return Table(head, rows)


def page(answers: Sequence[Answer]) -> str:
    """The margins for the README of the hard cases, Markdown: a row for each variant."""
    rows = []
    for case, variant in dict.fromkeys((a["case"], a["variant"]) for a in answers):
        mine = [a for a in answers if (a["case"], a["variant"]) == (case, variant)]
        defaults = [in_words(a) for a in mine if a["direction"] == DEFAULTS]
        pushed = [a for a in mine if a["direction"] != DEFAULTS]
        short, enough = (
            ", ".join(_brief(a) for a in pushed if a["met"] == met).replace("_", " ") for met in (False, True)
        )
        rows.append(("", (f"`{case}`, {variant.replace('_', ' ')}", "; ".join(defaults), short, enough)))
    head = ("case", "with the defaults", f"margin below {TARGET:g}", f"margin of {TARGET:g} or more")
    said = f"{headline(answers)}. A + says that no limit was found up to there."
    return f"{said}\n\n{Table(head, rows).markdown().strip()}"


def _brief(answer: Answer) -> str:
    return f"{answer['direction']} {answer['margin']:.2f}" + ("" if beyond(answer) else "+")


def figure(answers: Sequence[Answer]) -> Figure:
    """Cases down, directions across; a cell's colour says how far the limit is, its text how it ends."""
    rows = list(dict.fromkeys((a["case"], a["variant"]) for a in answers))
    columns = list(dict.fromkeys(a["direction"] for a in answers))
    levels = np.full((len(rows), len(columns)), np.nan)
    plot = Figure(figsize=(2.5 + 0.95 * len(columns), 1.8 + 0.42 * len(rows)), layout="constrained")
    axes = plot.add_subplot()
    for answer in answers:
        row, column = rows.index((answer["case"], answer["variant"])), columns.index(answer["direction"])
        trial, pushed = beyond(answer), answer["direction"] != DEFAULTS
        open_ended = answer["met"] and (trial is None or not pushed)
        levels[row, column] = (answer["margin"] >= 1) + answer["met"] + open_ended
        margin = f"{answer['margin']:.3g}" if pushed else ""
        text = f"{margin}\n{MARKS[trial['end']]}" if trial else f"≥ {margin}" if pushed else "survives"
        axes.text(column, row, text.strip(), ha="center", va="center", fontsize=8)
    norm = BoundaryNorm(np.arange(len(COLOURS) + 1) - 0.5, len(COLOURS))
    image = axes.imshow(levels, cmap=ListedColormap(COLOURS), norm=norm, aspect="auto")
    axes.set_xticks(range(len(columns)), [c.replace("_", "\n") for c in columns], fontsize=8)
    axes.set_yticks(range(len(rows)), [", ".join(row).replace("_", " ") for row in rows], fontsize=8)
    axes.set_xticks(np.arange(len(columns)) + 0.5, minor=True)
    axes.set_yticks(np.arange(len(rows)) + 0.5, minor=True)
    axes.grid(which="minor", color="white", linewidth=2)
    axes.tick_params(which="minor", length=0)
    axes.set_xlabel("direction in which the case is made harder, by a factor")
    bar = plot.colorbar(image, ticks=range(len(COLOURS)), pad=0.01)
    names = ("below 1:\ndefaults fail", f"1 to {TARGET:g}", f"{TARGET:g} or more", "no limit\nfound")
    bar.ax.set_yticklabels(names, fontsize=8)
    axes.set_title("Margins of the defaults: factor to the limit, and what happens beyond it", fontsize=11)
    return plot


def blocks(answers: Sequence[Answer], picture: Picture) -> list[Block]:
    ends = [f"{mark}: {BEYOND[end]}." for end, mark in MARKS.items()]
    explained = (
        f"A margin is the factor from the default to the last value that survives, known to "
        f"{100 * (RESOLUTION - 1):.0f} %; the target is {TARGET:g} in every direction. Below 1 the defaults "
        "fail, and the margin says how far back they do not. What surviving means is stated in each case's "
        "checks. " + " ".join(ends)
    )
    return [
        explained, picture, "# Hard cases with the defaults", defaults_table(answers), "# Margins",
        margins_table(answers),
    ]  # fmt: skip


def headline(answers: Sequence[Answer]) -> str:
    found = [standing(answer) for answer in answers]
    return "{} of {} met, {} known shortfalls, {} failed".format(
        found.count(""), len(found), found.count("known"), found.count("failed")
    )


def write(answers: Sequence[Answer], out: Path) -> None:
    """Writes stability.json, margins.png and the report into `out`."""
    shown = [{key: value for key, value in a.items() if key not in ("scene", "digest")} for a in answers]
    (out / "stability.json").write_text(json.dumps(shown, indent=1, allow_nan=False) + "\n")
    path = out / "margins.png"
    with matplotlib.rc_context({"figure.dpi": 130}):
        figure(answers).savefig(path)
    picture = Picture("margins", path, "Margins of the defaults")
    title, content, name = headline(answers), blocks(answers, picture), "Stability report"
    (out / "report.md").write_text(to_markdown(title, content, out, name))
    passed = all(standing(answer) != "failed" for answer in answers)
    (out / "report.html").write_text(to_html(title, passed, content, name))


def verdict(answers: Sequence[Answer]) -> int:
    """Prints what falls short and the tally; the exit status."""
    marks = {"failed": "FAILED", "known": "KNOWN SHORTFALL"}
    for answer in answers:
        if style := standing(answer):
            note = f" ({answer['known_shortfall']})" if style == "known" else ""
            place = f"{answer['case']} {answer['variant']} {answer['direction']}"
            print(f"{marks[style]}: {place}: {in_words(answer)}{note}")
    print(headline(answers))
    return int(any(standing(answer) == "failed" for answer in answers))
