"""Shows that the checks can fail: plants every fault of faults.toml; its named checks must turn red.

A fault passes when its checks are green with the healthy solver and fail, on a number or because the solver
stopped the run (exit status 3), with the fault in. A fault that the solver refuses as input, or that does not
build, shows nothing and fails.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

from verification import run
from verification.bench.files import write_whole
from verification.case import ROOT
from verification.page import Table

REPOSITORY = ROOT.parent
SOURCES = ("CMakeLists.txt", "solver", "tests/solver", "tests/fuzz", "benchmarks", "cmake")


class FaultError(Exception):
    """A fault that could not be planted, or was not detected: one line."""


@dataclass(frozen=True)
class Fault:
    name: str
    case: str
    scheme: str
    level: str
    spacing: float
    checks: tuple[str, ...]
    variant: str | None = None
    set: tuple[str, ...] = ()  # for the solver alone
    file: str | None = None  # with find and replace: a change of the source
    find: str = ""
    replace: str = ""

    def __post_init__(self) -> None:
        if bool(self.set) == bool(self.file) or not self.checks:
            raise FaultError(f"{self.name}: needs checks, and either `set` or `file`, `find` and `replace`")


def load(path: Path) -> list[Fault]:
    entries = tomllib.loads(path.read_text())["faults"]
    return [Fault(**{key: tuple(v) if isinstance(v, list) else v for key, v in e.items()}) for e in entries]


def plant(text: str, fault: Fault) -> str:
    """The text with the fault in; exactly one place must match, so that a changed source is noticed."""
    if text.count(fault.find) != 1:
        raise FaultError(f"{fault.file}: {text.count(fault.find)} places match `find`, one is needed")
    if fault.find == fault.replace:
        raise FaultError(f"{fault.file}: `replace` changes nothing")
    return text.replace(fault.find, fault.replace)


def sources(source: Path) -> dict[Path, bytes]:
    """What the solver and its tests are built from."""
    found: dict[Path, bytes] = {}
    for top in SOURCES:
        files = [source / top] if (source / top).is_file() else sorted((source / top).rglob("*"))
        found |= {file.relative_to(source): file.read_bytes() for file in files if file.is_file()}
    return found


def write_tree(wanted: Mapping[Path, bytes], copy: Path) -> None:
    """Makes `copy` hold these files alone; writes only what differs: builds are incremental."""
    for file in [f for f in copy.rglob("*") if f.is_file() and f.relative_to(copy) not in wanted]:
        file.unlink()
    for file, content in wanted.items():
        destination = copy / file
        if not destination.exists() or destination.read_bytes() != content:
            destination.parent.mkdir(parents=True, exist_ok=True)
            destination.write_bytes(content)


def synchronise(source: Path, copy: Path, fault: Fault) -> None:
    """Makes `copy` the source tree with the fault in."""
    wanted = sources(source)
    target = Path(fault.file or "")
    if target not in wanted:
        raise FaultError(f"{fault.file} is not among the sources")
    wanted[target] = plant(wanted[target].decode(), fault).encode()
    write_tree(wanted, copy)


def compiler_errors(out: Path, targets: Sequence[str], flags: Sequence[str]) -> list[str]:
    """Builds the copy `out`/source in `out`/build; the lines that say what is wrong, none when it builds."""
    copy, folder = out / "source", out / "build"
    configure = ["cmake", "-S", str(copy), "-B", str(folder), "-DCMAKE_BUILD_TYPE=Release", *flags]
    for command in (configure, ["cmake", "--build", str(folder), "--parallel", "2", "--target", *targets]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return error_lines(done.stdout + done.stderr) or [" ".join(command)]
    return []


def error_lines(output: str) -> list[str]:
    """Those of a compiler that say what is wrong, and where a template was asked for that has an error."""
    lines = output.splitlines()
    return [
        line
        for line, following in zip(lines, [*lines[1:], ""], strict=True)
        if "rror" in line or (line.endswith("required from here") and " error: " in following)
    ]


def build(
    fault: Fault,
    out: Path,
    source: Path = REPOSITORY,
    targets: Sequence[str] = ("slurry",),
    flags: Sequence[str] = (),
) -> Path:
    """The solver with a source fault in; all source faults share one build folder. `flags` are CMake's."""
    synchronise(source, out / "source", fault)
    if errors := compiler_errors(out, targets, flags):
        raise FaultError(f"does not build: {errors[0]}")
    return out / "build" / "slurry"


def verify(fault: Fault, solver: Path, out: Path, extra: Sequence[str]) -> list[dict[str, Any]]:
    """The named checks of one verification run, as in results.json."""
    arguments = ["--case", fault.case, "--scheme", fault.scheme, "--level", fault.level]
    arguments += ["--spacings", repr(fault.spacing), "--solver", str(solver), "--out", str(out)]
    arguments += ["--variant", fault.variant] if fault.variant else []
    with contextlib.redirect_stdout(io.StringIO()):
        status = run.main([*arguments, "--no-baseline", "--no-report", *extra])
    if status not in (0, 1):
        raise FaultError("the verification could not start")
    cases = json.loads((out / "results.json").read_text())["cases"]
    checks = [check for case in cases for check in case["checks"] if check["quantity"] in fault.checks]
    if absent := set(fault.checks) - {check["quantity"] for check in checks}:
        raise FaultError(f"no check is called {', '.join(sorted(absent))}")
    return checks


def detect(fault: Fault, solver: Path, out: Path, make: Callable[[Fault, Path], Path] = build) -> str:
    """What the faulty solver's checks say, in one line; raises FaultError when the fault is not shown."""
    control = f"{fault.case}-{fault.scheme}-{fault.variant or 'all'}-{fault.spacing:g}"
    healthy = verify(fault, solver, out / "healthy" / control, ["--reuse"])
    if red := [check for check in healthy if not check["passed"]]:
        raise FaultError(f"red without the fault: {red[0]['quantity']}: {red[0]['reason']}")
    faulty = make(fault, out) if fault.file else solver
    checks = verify(
        fault, faulty, out / "faulty" / fault.name, [f"--solver-set={value}" for value in fault.set]
    )
    for check in checks:
        if check["passed"]:
            raise FaultError(
                f"{check['quantity']} stays green: {check['value']:.3g} of {check['tolerance']:.3g}"
            )
        stopped = check["reason"].startswith(("exit status", "the solver"))
        if stopped and not check["reason"].startswith("exit status 3:"):
            raise FaultError(f"the run shows nothing: {check['reason']}")
    return "; ".join(f"{check['quantity']}: {check['reason']}" for check in checks)


def write_page(page: Path, rows: Sequence[tuple[Fault, str, str]]) -> None:
    """The table of the faults with verdict and what was said of them, into the page whole."""
    caught = sum(verdict == "DETECTED" for _, verdict, _ in rows)
    said = (
        f"**{caught} of {len(rows)} caught**, {date.today()}. Made by `make faults` from "
        "[faults.toml](faults.toml): with each fault in, the checks named there have to fail."
    )
    lines = []
    for fault, verdict, text in rows:
        text = re.sub(r"; its state is in \S+", "", text).replace("|", "/")  # a path of this machine
        lines.append(("", (fault.name, fault.file or "the scene", fault.case, verdict, text)))
    table = Table(("fault", "in", "case", "verdict", "its checks"), lines)
    write_whole(page, f"# Planted by hand\n\n{said}\n\n{table.markdown()}")


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.faults", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--only", action="append", metavar="NAME", help="only this fault (repeatable)")
    parser.add_argument("--faults", type=Path, default=ROOT / "faults.toml")
    parser.add_argument("--solver", type=Path, default=REPOSITORY / "build" / "slurry")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "faults")
    parser.add_argument("--page", type=Path, help="a page to write the table of all faults to")
    options = parser.parse_args(argv)
    rows: list[tuple[Fault, str, str]] = []
    try:
        faults = load(options.faults)
        if unknown := set(options.only or []) - {fault.name for fault in faults}:
            raise FaultError(f"no fault is called {', '.join(sorted(unknown))}")
    except (FaultError, OSError, KeyError, TypeError, tomllib.TOMLDecodeError) as error:
        print(f"faults: {error}", file=sys.stderr)
        return 2
    shutil.rmtree(options.out / "faulty", ignore_errors=True)
    for fault in [fault for fault in faults if not options.only or fault.name in options.only]:
        try:
            verdict, text = "DETECTED", detect(fault, options.solver, options.out)
        except FaultError as error:
            verdict, text = "MISSED", str(error)
        print(f"{verdict} {fault.name}: {text}", flush=True)
        rows.append((fault, verdict, text))
    if options.page:
        write_page(options.page, rows)
    passed = sum(verdict == "DETECTED" for _, verdict, _ in rows)
    print(f"{passed} passed, {len(rows) - passed} failed")
    return 0 if passed == len(rows) > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
