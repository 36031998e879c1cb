"""What is said of the mutants: the closing line, build/mutations/report.md, and a short page by file."""

from __future__ import annotations

import argparse
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from verification.mutants import FACTORS
from verification.page import Table, to_markdown

TARGET = 0.9
UNEXPLAINED = "not explained"


def tally(answers: Sequence[dict[str, Any]]) -> tuple[str, bool]:
    """The closing line, and whether enough of what was built was caught."""
    outcomes = [answer["outcome"] for answer in answers]
    caught, survived = outcomes.count("caught"), outcomes.count("survived")
    built = caught + survived
    share = f" ({100 * caught / built:.0f} %)" if built else ""
    line = (
        f"{caught} of {built} caught{share}, {survived} survived, {outcomes.count('not built')} do not build"
    )
    return line, built > 0 and caught >= TARGET * built


def explanations(path: Path) -> dict[str, str]:
    """Why mutants may survive, by name."""
    return tomllib.loads(path.read_text())["survivors"] if path.exists() else {}


def _finding(answer: Mapping[str, Any], why: Mapping[str, str]) -> str:
    if answer["outcome"] != "survived":
        return answer["by"]
    reached = f"with NaN: {answer['reached']}" if answer["reached"] else "no check runs it"
    return f"{why.get(answer['name'], UNEXPLAINED)} ({reached})"


def _row(answer: Mapping[str, Any], why: Mapping[str, str]) -> tuple[str, list[str]]:
    mutation = f"{FACTORS[answer['kind']]} on `{answer['expression']}` in `{answer['statement']}`"
    cells = [answer["name"], f"{answer['file']}:{answer['line']}", mutation, answer["outcome"]]
    return "failed" if answer["outcome"] == "survived" else "", [*cells, _finding(answer, why)]


def _by_file(answers: Sequence[Mapping[str, Any]]) -> Table:
    rows = []
    for file in sorted({answer["file"] for answer in answers}):
        of_file = [answer for answer in answers if answer["file"] == file]
        unit = sum(a["outcome"] == "caught" and a["by"].startswith("unit test") for a in of_file)
        caught = sum(a["outcome"] == "caught" for a in of_file)
        survived = sum(a["outcome"] == "survived" for a in of_file)
        rows.append(("", [file, *map(str, (len(of_file), unit, caught - unit, survived))]))
    return Table(["file", "mutants", "caught by unit tests", "by the gate", "survived"], rows)


def write_report(answers: Sequence[dict[str, Any]], asked: int, options: argparse.Namespace) -> None:
    """build/mutations/report.md; after a whole run `options.page`, too."""
    why = explanations(options.explained)
    title = f"{tally(answers)[0]}; {len(answers)} of {asked} mutants run"
    head = ["mutant", "place", "factor", "outcome", "found by, or why it survives"]
    every = Table(head, [_row(answer, why) for answer in answers])
    files = _by_file(answers)
    (options.out / "report.md").write_text(to_markdown(title, [files, every], options.out, "Mutation report"))
    if options.page and len(answers) == asked:
        left = Table(head, [_row(answer, why) for answer in answers if answer["outcome"] == "survived"])
        intro = "Made by `make mutations`: each mutant is a factor of -1, 0 or 1.02 on one expression."
        options.page.write_text(
            to_markdown(
                title, [intro, files, "## Survivors", left], options.page.parent, "Planted by machine"
            )
        )
