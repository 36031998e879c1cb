"""Plants small faults in the physics by machine and tells which check finds each.

Every line of the physics files offers mutants: a sign flipped, a term dropped, a result scaled by 2 %. As
many as asked for are drawn, evenly over files and kinds and always the same ones, built one by one in one
shared build folder, and shown to the unit tests, then to the cheap cases of the gate, until something turns
red. Answers are stored as they come: an interrupted run goes on where it was. The exit status is 0 when at
least 90 % of the mutants that build are caught.
"""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import hashlib
import io
import itertools
import json
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verification import run
from verification.faults import REPOSITORY, Fault, FaultError, build
from verification.page import Table, to_markdown
from verification.results import standing

PHYSICS = tuple(
    f"solver/{name}"
    for name in (
        "terms/advection_tensor.hpp", "terms/background_pressure.hpp", "terms/continuity.hpp",
        "terms/density_diffusion.hpp", "terms/equation_of_state.hpp", "terms/gradient_correction.hpp",
        "terms/pressure_force.hpp", "terms/viscous_force.hpp", "terms/viscous_twist.hpp",
        "terms/wall_extrapolation.hpp", "terms/wall_fit.hpp", "kernels/fitted_quintic.hpp",
        "discs/motion.cpp", "discs/contact.cpp", "time/velocity_verlet.cpp", "time/time_step.hpp",
    )
)  # fmt: skip
# From cheap to dear; the first that turns red ends the search.
CASES = (
    "disc_flight", "couette", "poiseuille", "taylor_green", "still_rough_box", "disc_conservation",
    "disc_rotating", "rough_channel",
)  # fmt: skip
TARGET = 0.9
CAUGHT, SURVIVED, NOT_BUILT = "caught", "survived", "not built"
ASSIGNED = re.compile(r"^(\s*(?:return|[\w\s:<>,.*&\[\]()]*?[\w\])]\s*[-+]?=)\s)(.*[*/(].*);\s*(//.*)?$")
ADDED = re.compile(r"^(\s*[\w.\[\]]+\s[-+]=\s)(.*);\s*(//.*)?$")
SIGN = re.compile(r"(?<=[\w)\]] )[-+](?= [\w(])|(?<= )[-+](?==\s)")
NO_PHYSICS = re.compile(
    r'^\s*(//|#|template|using|static_assert|for |namespace|struct)|"|size_t|bool|<<|throw'
)


@dataclass(frozen=True)
class Mutant:
    file: str
    line: int
    kind: str  # "sign", "drop" or "scale"
    before: str
    after: str

    @property
    def name(self) -> str:
        content = hashlib.sha256(f"{self.before}\0{self.after}".encode()).hexdigest()
        return f"{Path(self.file).stem}-{self.line}-{self.kind}-{content[:6]}"


def mutants_of(file: str, text: str) -> Iterator[Mutant]:
    """All mutants of a file. In templates over packs a factor has to be a pack itself."""
    factor = "P(1.02f)" if re.search(r"template <class P", text) else "1.02"
    for number, line in enumerate(text.splitlines(), 1):
        if NO_PHYSICS.search(line):
            continue
        code = line.split("//")[0]
        for sign in SIGN.finditer(code):
            flipped = "-" if sign[0] == "+" else "+"
            after = line[: sign.start()] + flipped + line[sign.end() :]
            yield Mutant(file, number, "sign", line, after)
        if added := ADDED.match(line):
            yield Mutant(file, number, "drop", line, f"{added[1]}0 * ({added[2]});")
        if assigned := ASSIGNED.match(line):
            yield Mutant(file, number, "scale", line, f"{assigned[1]}{factor} * ({assigned[2]});")


def draw(mutants: Sequence[Mutant], count: int) -> list[Mutant]:
    """The same `count` of them each time, by turns from every file and kind."""
    groups: dict[tuple[str, str], list[Mutant]] = {}
    for mutant in sorted(mutants, key=lambda m: hashlib.sha256(m.name.encode()).hexdigest()):
        groups.setdefault((mutant.kind, mutant.file), []).append(mutant)
    turns = itertools.zip_longest(*(groups[key] for key in sorted(groups)))
    return [mutant for turn in turns for mutant in turn if mutant is not None][:count]


def planted(mutant: Mutant, source: Path) -> Fault:
    """The mutant as a fault of its file: the text that occurs once is the whole file."""
    text = (source / mutant.file).read_text()
    lines = text.splitlines(keepends=True)
    if lines[mutant.line - 1].rstrip("\n") != mutant.before:
        raise FaultError(f"{mutant.file}:{mutant.line} has changed")
    lines[mutant.line - 1] = mutant.after + "\n"
    return Fault(
        mutant.name, "", "default", "gate", 0.0, ("any",), file=mutant.file, find=text, replace="".join(lines)
    )


def red_unit_test(tests: Path, timeout: float) -> str:
    """The first unit test that fails, or how the tests end; "" when all pass."""
    command = [str(tests), "--gtest_fail_fast", "--gtest_brief=1"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False)
    except subprocess.TimeoutExpired:
        return f"unit tests: no end within {timeout:g} s"
    failed = re.search(r"\[  FAILED  \] (\S+?)[,\s]", done.stdout)
    if failed:
        return f"unit test {failed[1]}"
    return f"unit tests: exit status {done.returncode}" if done.returncode else ""


def red_check(solver: Path, out: Path, case: str, timeout: float) -> str:
    """The first red check of a case at the gate, default scheme; "" when all are green."""
    arguments = ["--case", case, "--scheme", "default", "--solver", str(solver), "--out", str(out)]
    arguments += ["--threads", "1", "--timeout", str(timeout), "--no-baseline", "--no-report"]
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        status = run.main(arguments)
    if status not in (0, 1):
        raise FaultError(f"the verification of {case} could not start")
    cases = json.loads((out / "results.json").read_text())["cases"]
    red = [(c, check) for c in cases for check in c["checks"] if standing(check) == "failed"]
    return f"{case}: {red[0][1]['quantity']}: {red[0][1]['reason']}" if red else ""


def examine(solver: Path, out: Path, options: argparse.Namespace) -> str:
    """What catches this build; "" when nothing does."""
    if found := red_unit_test(solver.parent / "slurry_tests", options.timeout):
        return found
    return next(filter(None, (red_check(solver, out, case, options.timeout) for case in CASES)), "")


def judge(mutant: Mutant, options: argparse.Namespace) -> dict[str, Any]:
    """The stored answer for a mutant, or a new one, stored whole or not at all."""
    stored = options.out / "answers" / f"{mutant.name}.json"
    if stored.exists():
        return json.loads(stored.read_text())
    fault = planted(mutant, options.source)
    try:
        targets = ("slurry", "slurry_tests")
        flags = ("-DSLURRY_WERROR=OFF", *options.cmake_flag)  # what is no longer used is no answer
        solver = build(fault, options.out, options.source, targets, flags)
        caught = examine(solver, options.out / "runs", options)
        found = {"outcome": CAUGHT if caught else SURVIVED, "by": caught}
    except FaultError as error:
        if not str(error).startswith("does not build"):
            raise
        found = {"outcome": NOT_BUILT, "by": str(error)}
    answer = dataclasses.asdict(mutant) | found
    partial = stored.with_suffix(".part")
    partial.write_text(json.dumps(answer, indent=1) + "\n")
    partial.replace(stored)
    return answer


def tally(answers: Sequence[dict[str, Any]]) -> tuple[str, bool]:
    """The closing line, and whether enough of what was built was caught."""
    outcomes = [answer["outcome"] for answer in answers]
    caught, survived = outcomes.count(CAUGHT), outcomes.count(SURVIVED)
    built = caught + survived
    share = f" ({100 * caught / built:.0f} %)" if built else ""
    line = f"{caught} of {built} caught{share}, {survived} survived, {outcomes.count(NOT_BUILT)} do not build"
    return line, built > 0 and caught >= TARGET * built


def write_report(answers: Sequence[dict[str, Any]], asked: int, out: Path) -> None:
    rows = [
        (
            "failed" if a["outcome"] == SURVIVED else "",
            [f"{a['file']}:{a['line']}", a["kind"], a["after"].strip(), a["outcome"], a["by"]],
        )
        for a in answers
    ]
    title = f"{tally(answers)[0]}; {len(answers)} of {asked} mutants run"
    table = Table(["place", "kind", "becomes", "outcome", "by"], rows)
    (out / "report.md").write_text(to_markdown(title, [table], out, "Mutation report"))


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m verification.mutations", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--count", type=int, default=72, help="mutants to draw (%(default)s)")
    parser.add_argument("--list", action="store_true", help="only show which")
    parser.add_argument("--source", type=Path, default=REPOSITORY)
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "mutations")
    parser.add_argument(
        "--timeout", type=float, default=1800, metavar="S", help="for the unit tests, and a run"
    )
    parser.add_argument(
        "--cmake-flag", action="append", default=[], metavar="FLAG", help="for the first build"
    )
    return parser.parse_args(argv)


def main(argv: Sequence[str] | None = None) -> int:
    options = parse(argv)
    try:
        texts = {file: (options.source / file).read_text() for file in PHYSICS}
        drawn = draw([m for file, text in texts.items() for m in mutants_of(file, text)], options.count)
        if options.list:
            print("\n".join(f"{m.file}:{m.line}: {m.kind}: {m.after.strip()}" for m in drawn))
            return 0
        (options.out / "answers").mkdir(parents=True, exist_ok=True)
        answers = []
        for mutant in drawn:
            answers.append(judge(mutant, options))
            last = answers[-1]
            print(
                f"{last['outcome'].upper()} {mutant.name}: {last['by'] or last['after'].strip()}", flush=True
            )
            write_report(answers, len(drawn), options.out)
    except KeyboardInterrupt:
        print("mutations: interrupted; the answers so far are kept", file=sys.stderr)
        return 2
    except (FaultError, OSError) as error:
        print(f"mutations: {error}", file=sys.stderr)
        return 2
    line, enough = tally(answers)
    print(line)
    return 0 if enough else 1


if __name__ == "__main__":
    sys.exit(main())
