"""Plants small faults in the physics by machine and tells which check finds each.

The mutants of `verification/mutants.py` that are drawn go into one copy of the sources, built once; which of
them is active is chosen at run time. With none active everything has to be green. Then each is shown to the
unit tests, those of its own folder first, and to the cheap cases of the gate, until something turns red.
What nothing finds is tried once more with the factor NaN, which tells whether any check runs the line at all.
Answers are stored as they come: an interrupted run goes on where it was, and mutants that survived are tried
again when the tests are others. The exit status is 0 when at least 90 % of the mutants that build are caught.
"""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import hashlib
import io
import json
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verification import run
from verification.case import ROOT
from verification.faults import REPOSITORY, FaultError, compiler_errors, sources, write_tree
from verification.mutants import FACTORS, HEADER, PHYSICS, Mutant, draw, header, mutants_of, planted
from verification.mutations_report import tally, write_report
from verification.results import standing

# From cheap to dear; the first that turns red ends the search.
CASES = (
    ("disc_flight", "default"), ("still_rough_box", "default"), ("thrown_disc", "default"),
    ("rough_pad", "default"), ("couette", "default"), ("poiseuille", "default"), ("taylor_green", "default"),
    ("disc_conservation", "default"), ("disc_density", "default"), ("disc_rotating", "default"),
    ("couette", "wang2014"), ("poiseuille", "wang2014"),
    ("rough_channel", "default"),
)  # fmt: skip
TARGETS = ("slurry", "slurry_tests")
SLOW_TEST_S = 0.5  # with no mutant; these come last
FAILED = re.compile(r"^\[  FAILED  \] ([\w/.]+)", re.MULTILINE)
PASSED = re.compile(r"^\[       OK \] ([\w/.]+).*\((\d+) ms\)$", re.MULTILINE)
ERROR = re.compile(r"^(.*?):(\d+):(?:\d+:)? (?:(?:fatal )?error:| +required from here)")


def plant_all(drawn: Sequence[Mutant], options: argparse.Namespace) -> set[str]:
    """Builds all mutants at once; the names of those that the compiler refuses, which are left out."""
    refused: set[str] = set()
    generator = ["-GNinja"] if shutil.which("ninja") else []
    flags = [*generator, "-DSLURRY_WERROR=OFF", "-DCMAKE_UNITY_BUILD=ON", *options.cmake_flag]
    while True:
        wanted = sources(options.source)
        for file in {mutant.file for mutant in drawn}:
            numbered = {n: m for n, m in enumerate(drawn) if m.file == file and m.name not in refused}
            wanted[Path(file)] = planted(wanted[Path(file)].decode(), numbered).encode()
        wanted[Path(HEADER)] = header(len(drawn)).encode()
        write_tree(wanted, options.out / "source")
        errors = compiler_errors(options.out, TARGETS, flags)
        if not errors:
            return refused
        places = [(found[1], int(found[2])) for line in errors if (found := ERROR.match(line))]
        blamed = {
            m.name
            for m in drawn
            for file, line in places
            if file.endswith(m.file) and m.line <= line <= m.last_line
        }
        if blamed <= refused:
            raise FaultError(f"does not build: {errors[0]}")
        refused |= blamed
        print(f"left out, the compiler refuses them: {', '.join(sorted(blamed))}", flush=True)


@contextlib.contextmanager
def active(number: int | None, factor: str) -> Iterator[None]:
    """The mutant for the programs that are started inside; None: none of them."""
    if number is not None:
        os.environ["SLURRY_MUTANT"] = f"{number}:{factor}"
    try:
        yield
    finally:
        os.environ.pop("SLURRY_MUTANT", None)


@dataclass
class Control:
    """What everything took, in s, with no mutant active."""

    digest: str  # of the programs
    tests: dict[str, float]
    cases: dict[str, float]

    def limit(self, seconds: float) -> float:
        return 120 + 10 * seconds


def near(file: str, source: Path) -> set[str]:
    """The test suites of the folder that mirrors the file's."""
    folder = source / "tests" / Path(file).parent
    texts = (test.read_text() for test in folder.glob("*_test.cpp"))
    return {
        suite
        for text in texts
        for suite in re.findall(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+)", text, re.MULTILINE)
    }


def passes(control: Control, suites: set[str]) -> list[list[str]]:
    """The unit tests in three goes: quick ones nearby, all other quick ones, slow ones."""
    groups: list[list[str]] = [[], [], []]
    for test, seconds in control.tests.items():
        nearby = suites.intersection(test.split(".")[0].split("/"))
        groups[2 if seconds > SLOW_TEST_S else 0 if nearby else 1].append(test)
    return groups


def run_tests(tests: Path, names: Sequence[str], timeout: float, source: Path) -> tuple[str, str]:
    """The first unit test of these that fails, or how they end, "" when all pass; and the log."""
    command = [str(tests), "--gtest_fail_fast", f"--gtest_filter={':'.join(names)}"]
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            check=False,
            cwd=source,
        )
    except subprocess.TimeoutExpired:
        return f"unit tests: no end within {timeout:g} s", ""
    if failed := FAILED.search(done.stdout):
        return f"unit test {failed[1]}", done.stdout
    return f"unit tests: exit status {done.returncode}" if done.returncode else "", done.stdout


def red_check(solver: Path, out: Path, case: str, scheme: str, timeout: float) -> str:
    """The first red check of a case at the gate; "" when all are green."""
    arguments = ["--case", case, "--scheme", scheme, "--solver", str(solver), "--out", str(out)]
    arguments += ["--threads", "1", "--timeout", str(timeout), "--no-baseline", "--no-report"]
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        status = run.main(arguments)
    if status not in (0, 1):
        raise FaultError(f"the verification of {case} could not start")
    cases = json.loads((out / "results.json").read_text())["cases"]
    red = [check for c in cases for check in c["checks"] if standing(check) == "failed"]
    return f"{case} ({scheme}): {red[0]['quantity']}: {red[0]['reason']}" if red else ""


def digest_of(folder: Path) -> str:
    programs = b"".join((folder / name).read_bytes() for name in TARGETS)
    return hashlib.sha256(programs).hexdigest()


def control_run(options: argparse.Namespace) -> Control:
    """Everything with no mutant active; refuses to go on when anything is red."""
    folder, stored = options.out / "build", options.out / "control.json"
    digest = digest_of(folder)
    if stored.exists() and (known := Control(**json.loads(stored.read_text()))).digest == digest:
        return known
    red, log = run_tests(folder / "slurry_tests", ("*",), 3600, options.source)
    control = Control(digest, {name: int(ms) / 1000 for name, ms in PASSED.findall(log)}, {})
    for case, scheme in CASES if not red else ():
        start = time.monotonic()
        red = red or red_check(folder / "slurry", options.out / "runs", case, scheme, 3600)
        control.cases[f"{case} {scheme}"] = time.monotonic() - start
    if red:
        raise FaultError(f"red with no mutant active: {red}")
    store(stored, dataclasses.asdict(control))
    return control


def store(path: Path, content: dict[str, Any]) -> None:
    partial = path.with_suffix(".part")
    partial.write_text(json.dumps(content, indent=1) + "\n")
    partial.replace(path)


def red_of_tests(groups: Sequence[Sequence[str]], control: Control, options: argparse.Namespace) -> str:
    for group in groups:
        limit = control.limit(sum(control.tests[test] for test in group))
        if red := run_tests(options.out / "build" / "slurry_tests", group, limit, options.source)[0]:
            return red
    return ""


def examine(mutant: Mutant, control: Control, options: argparse.Namespace, quick: bool) -> str:
    """What catches the active mutant, among the quick unit tests or all the rest; "" when nothing does."""
    groups = passes(control, near(mutant.file, options.source))
    if quick:
        return red_of_tests(groups[:2], control, options)
    if red := red_of_tests(groups[2:], control, options):
        return red
    for case, scheme in CASES:
        limit = control.limit(control.cases[f"{case} {scheme}"])
        if red := red_check(options.out / "build" / "slurry", options.out / "runs", case, scheme, limit):
            return red
    return ""


def stored_answer(mutant: Mutant, control: Control, options: argparse.Namespace) -> dict[str, Any] | None:
    """The answer of an earlier run, with the mutant where it is now; None where there is no valid one."""
    stored = options.out / "answers" / f"{mutant.name}.json"
    if not stored.exists():
        return None
    answer = json.loads(stored.read_text()) | dataclasses.asdict(mutant)
    return answer if answer["outcome"] == "caught" or answer["digest"] == control.digest else None


def judge(
    mutant: Mutant, number: int, control: Control, options: argparse.Namespace, quick: bool
) -> dict[str, Any] | None:
    """The answer for a mutant, stored whole or not at all; None when the quick tests have none."""
    with active(number, FACTORS[mutant.kind]):
        found = examine(mutant, control, options, quick)
    if quick and not found:
        return None
    reached = ""
    if not found:
        with active(number, "nan"):
            reached = examine(mutant, control, options, True) or examine(mutant, control, options, False)
    answer = dataclasses.asdict(mutant) | {"digest": control.digest, "by": found, "reached": reached}
    answer["outcome"] = "caught" if found else "survived"
    store(options.out / "answers" / f"{mutant.name}.json", answer)
    return answer


def parse(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m verification.mutations", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--count", type=int, default=320, help="mutants to draw (%(default)s)")
    parser.add_argument("--list", action="store_true", help="only show which")
    parser.add_argument(
        "--file", action="append", metavar="FILE", help="draw from this one alone (again: from these)"
    )
    parser.add_argument("--source", type=Path, default=REPOSITORY)
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "mutations")
    parser.add_argument(
        "--explained", type=Path, default=ROOT / "mutations.toml", help="why survivors may survive"
    )
    parser.add_argument("--page", type=Path, help="where a short table by file goes, after a whole run")
    parser.add_argument("--cmake-flag", action="append", default=[], metavar="FLAG")
    options = parser.parse_args(argv)
    if options.file and options.page:
        parser.error("--page shows all files: leave out --file")
    if unknown := set(options.file or ()) - set(PHYSICS):
        parser.error(f"--file: not among the physics: {', '.join(sorted(unknown))}")
    return options


def judge_all(drawn: Sequence[Mutant], options: argparse.Namespace) -> list[dict[str, Any]]:
    (options.out / "answers").mkdir(parents=True, exist_ok=True)
    refused = plant_all(drawn, options)
    control = control_run(options)
    answers = [
        dataclasses.asdict(m) | {"outcome": "not built", "by": "", "reached": ""}
        if m.name in refused
        else stored_answer(m, control, options)
        for m in drawn
    ]
    for quick in (True, False):
        left = [number for number, answer in enumerate(answers) if answer is None]
        start = time.monotonic()
        for done, number in enumerate(left, 1):
            answers[number] = judge(drawn[number], number, control, options, quick)
            minutes = (time.monotonic() - start) / done * (len(left) - done) / 60
            head = f"{'quick unit tests' if quick else 'all'} {done}/{len(left)}, {minutes:.0f} min left"
            outcome = (answers[number] or {"outcome": "not yet found"})["outcome"].upper()
            say = f"{outcome} {drawn[number]}: {(answers[number] or {'by': ''})['by']}"
            print(f"[{head}] {say}", flush=True)
            write_report([answer for answer in answers if answer], len(drawn), options)
    found = [answer for answer in answers if answer]
    write_report(found, len(drawn), options)  # reasons may have changed where no answer has
    return found


def main(argv: Sequence[str] | None = None) -> int:
    options = parse(argv)
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # threads that spin would double the time
    try:
        texts = {file: (options.source / file).read_text() for file in options.file or PHYSICS}
        drawn = draw([m for file, text in texts.items() for m in mutants_of(file, text)], options.count)
        if options.list:
            print("\n".join(map(str, drawn)))
            return 0
        answers = judge_all(drawn, options)
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
