"""Runs another code's examples of flows that are cases of ours, and our solver on the same flows beside them.

`python -m verification.bench.peers` writes peers.json into the output folder, and the report there again if
there is one. The other code is PySPH (Debian's python3-pysph): its examples run unchanged on one thread, with
this machine's instruction set (CFLAGS), after a warm-up that generates and compiles their code. The time is
the one that PySPH prints for its solve. Errors are by the comparer of `make verify`, and, apart, by the
example's own measure. Exit status: 1 when a run failed, 2 when it cannot start.
"""

from __future__ import annotations

import dataclasses
import datetime
import json
import shutil
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from reference import Reference
from reference import load as load_reference
from verification import execute
from verification.bench import report
from verification.bench.files import write_json
from verification.bench.plan import load_plan
from verification.bench.session import Job, Session, ask, finite, parser
from verification.bench.speed_error import point
from verification.case import Case, CaseError, Variant, load_case
from verification.compare import Array, Check, DataError, measure
from verification.execute import Outcome
from verification.results import commit, machine
from verification.run import LoadReference, References
from verification.truth import error_of

SYSTEM_PYTHON = "/usr/bin/python3"  # the one that Debian's packages are for
DRIVER = Path(__file__).resolve().parent / "pysph_example.py"
COMPILER_FLAGS = "-O3 -march=native"
DESCRIPTION = (
    "PySPH's own examples on one thread, compiled for this machine, in double; its time is that of the solve "
    "alone. Errors are by our comparer; its own l1 compares the magnitudes of the velocities only."
)


@dataclasses.dataclass(frozen=True)
class Flow:
    """The flow of a peer's example as one of our cases, with the error of its velocity at the end."""

    case: Case
    variant: Variant
    check: Check
    spacing: float  # m

    @classmethod
    def of(cls, entry: Mapping[str, Any]) -> Flow:
        case = load_case(entry["case"])
        plain, changes = case.variants[0], entry.get("set", {})
        variant = Variant("as_the_example", {**plain.set, **changes}) if changes else plain
        checks = case.checks("default", "gate", plain.name)
        check = next(c for c in checks if c.at == "particles" and c.field == "velocity")
        check = dataclasses.replace(check, quantity=check.quantity.split(" at ")[0], time=None)
        return cls(case, variant, check, entry["spacing"])


def l1_of_speed(velocity: Array, exact: Array) -> float:
    """PySPH's measure for Taylor-Green: blind to directions, so never above the comparer's relative_l1."""
    ours, truth = (np.linalg.norm(field, axis=1) for field in (velocity, exact))
    return float(np.mean(np.abs(ours - truth)) / np.mean(truth))


def peer_run(entry: Mapping[str, Any], warm_up: Sequence[str], reference: Reference, folder: Path,
             timeout: float) -> dict[str, Any]:  # fmt: skip
    """One example, warmed up and timed; raises DataError when it fails or its files are not as expected."""
    environment = ["env", f"HOME={folder}", f"CFLAGS={COMPILER_FLAGS}", "OMP_NUM_THREADS=1"]
    example = [SYSTEM_PYTHON, str(DRIVER), entry["example"], entry["application"], *entry["arguments"]]
    out = folder / f"{entry['example']}-{entry['scheme']}"
    for name, more in (("warm_up", warm_up), ("timed", [])):
        shutil.rmtree(out / name, ignore_errors=True)  # an earlier result must never pass for this one
        # One thread, and no snapshots between start and end: ours writes none either.
        options = ["--no-openmp", "--pfreq", "1000000000", "--directory", str(out / name)]
        if failure := execute.call([*environment, *example, *options, *more], timeout):
            raise DataError(f"{name.replace('_', ' ')}: {failure}")
    try:
        facts = json.loads((out / "timed" / f"{entry['example']}.info").read_text())
        final = np.load(out / "timed" / "final.npz")
        own = np.load(out / "timed" / "results.npz")
        velocity = np.stack([final["u"], final["v"]], axis=1)
        exact = reference.velocity(final["x"], final["y"], float(final["t"]))
        seconds, steps = float(facts["cpu_time"]), int(final["steps"])
    except (OSError, KeyError, ValueError) as error:
        raise DataError(f"its results cannot be read: {error}") from error
    if not facts.get("completed") or not seconds > 0:
        raise DataError("it did not complete")
    check = Flow.of(entry).check
    return {
        "fluid_particles": len(velocity),
        "steps": steps,
        "end_time_s": float(final["t"]),
        "wall_s": seconds,
        "errors": {check.quantity: measure(check, velocity, exact)},
        "own_errors": {name: finite(float(own[name][-1])) for name in ("l1", "linf", "p_l1") if name in own},
    }


def peer_entry(entry: Mapping[str, Any], session: Session, folder: Path) -> dict[str, Any]:
    """A row of peers.json; a run that failed keeps its reason and is a failure of the session."""
    row: dict[str, Any] = {"code": "PySPH", "arithmetic": "double", "threads": 1}
    row |= {key: entry[key] for key in ("case", "scheme", "arguments")} | {"set": entry.get("set", {})}
    row |= {
        "fluid_particles": None,
        "steps": 0,
        "wall_s": None,
        "errors": {},
        "own_errors": {},
        "failure": "",
    }
    flow = Flow.of(entry)
    try:
        reference = session.references.of(flow.case, flow.variant)
        warm_up = session.plan["peers"]["warm_up"]
        row |= peer_run(entry, warm_up, reference, folder, session.plan["timeout_s"])
    except ValueError as error:  # DataError and ReferenceError are
        row["failure"] = str(error)
        session.fail(f"PySPH {entry['example']} {entry['scheme']}: {error}")
    return row


def our_entries(entry: Mapping[str, Any], session: Session) -> list[dict[str, Any]]:
    """Our solver on the same flow at the same spacing, both schemes, one thread."""
    flow = Flow.of(entry)
    reference = session.references.of(flow.case, flow.variant)
    own: dict[str, float] = {}

    def read(outcome: Outcome) -> dict[str, float]:
        particles = outcome.result.particles()
        exact = reference.velocity(*particles.position.T, particles.time)
        own["l1"] = l1_of_speed(particles.velocity, exact)
        return {flow.check.quantity: error_of(flow.check, outcome.result, reference)}

    rows = []
    for scheme in ("default", "wang2014"):
        for arithmetic in session.arithmetics(["float", "double"]):
            own.clear()
            job = Job(flow.case, flow.variant, flow.spacing, scheme, arithmetic)
            row = {"code": "slurry", **point(session.measure(job, read)), "set": entry.get("set", {})}
            rows.append(row | {"own_errors": {name: finite(value) for name, value in own.items()}})
    return rows


def measure_peers(session: Session) -> dict[str, Any]:
    folder = session.out.resolve() / "pysph"
    folder.mkdir(parents=True, exist_ok=True)
    runs, ours, seen = [], [], []
    for entry in session.plan["peers"]["runs"]:
        print(f"bench: PySPH {entry['example']} {entry['scheme']}", file=sys.stderr, flush=True)
        runs.append(peer_entry(entry, session, folder))
        flow = (entry["case"], entry["spacing"], entry.get("set", {}))
        if flow not in seen:
            seen.append(flow)
            ours += our_entries(entry, session)
    return {"runs": runs, "ours": ours}


def main(argv: Sequence[str] | None = None, load: LoadReference = load_reference) -> int:
    arguments = parser("python -m verification.bench.peers", __doc__)
    arguments.add_argument("--page", type=Path, help="a page with the markers of peers, and those of bench")
    options = arguments.parse_args(argv)
    try:
        version = ask([SYSTEM_PYTHON, "-c", "import pysph; print(pysph.__version__)"]).split()[-1]
        session = Session(options.solver, options.out, load_plan(options.quick), References(load))
        (options.out / report.PEERS).unlink(missing_ok=True)
    except (CaseError, OSError) as error:
        print(
            f"bench-peers: {error}; `make bench-peers` installs PySPH and builds the solver", file=sys.stderr
        )
        return 2
    peers = {
        "description": DESCRIPTION,
        "generated": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "commit": commit(),
        "quick": options.quick,
        "machine": machine(),
        "pysph": {"version": version, "compiler_flags": COMPILER_FLAGS},
        **measure_peers(session),
        "notes": session.notes,
        "failures": session.failures,
    }
    write_json(options.out / report.PEERS, peers)
    print(report.peer_table(peers).markdown())
    if options.page:
        report.write_peers(options.page, peers)
    stored = options.out / report.RESULTS
    if stored.exists():
        results = json.loads(stored.read_text())
        report.write(options.out, results)
        if options.page:  # a target is held against the other code's time
            report.write_page(options.page, results)
        print(options.out / "report.html")
    for failure in session.failures:
        print(f"FAILED: {failure}")
    return 1 if session.failures else 0


if __name__ == "__main__":
    sys.exit(main())
