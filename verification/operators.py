"""Errors of the discrete operators on the exact field, at the particles of a run.

`python -m verification.operators` runs the flows below with the default scheme, takes the reference's
velocity and pressure at their particles, and holds the sums over pairs against the reference's derivatives.
That tells what a sum misses from what the flow makes of it. Three ways: at each particle; as means over cells
of fixed size, because noise of no mean moves particles and not the fluid; and over particles on a lattice,
where only the truncation is left. Only particles whose neighbours are all fluid count. The tables go between
the markers of accuracy.md: the solver's sums, other forms of them (verification/operator_forms.py), and what
is continued behind a wall (verification/wall_continuation.py). Exit status: 0; 1 when a run failed; 2 when it
cannot start.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from reference import Reference
from verification import wall_continuation
from verification.case import ROOT, Case, Variant, load_case
from verification.compare import Array
from verification.execute import Run
from verification.operator_forms import (
    DIVERGENCE,
    FORMS,
    GRADIENT,
    MOMENTS,
    OF_NEIGHBOURS,
    SOLVER,
    SUPPORT,
    VISCOUS,
    Cloud,
    sums,
)
from verification.page import Table
from verification.page_command import finished, write_tables
from verification.run import References
from verification.wall_continuation import Continued, continuations

PAGE = ROOT / "accuracy.md"
HEAD = (
    "flow",
    "spacing (m)",
    "particles",
    "sum",
    "at the particles (%)",
    "means over cells (%)",
    "on a lattice (%)",
)


@dataclass(frozen=True)
class Flow:
    """`step`: of the differences that stand for the reference's derivatives, m; `cell`: of the means, m;
    `wall`: where an artificial one is laid through the fluid, y in m.
    """

    case: str
    variant: str
    spacings: tuple[float, ...]
    step: float
    cell: float
    wall: float | None = None


FLOWS = (
    Flow("taylor_green", "re_100", (0.04, 0.02, 0.01), 0.01, 0.1),
    Flow("rough_channel", "top_wall_moves", (5e-7, 2.5e-7, 1.25e-7), 2e-7, 2e-6, 1.25e-5),
)


@dataclass(frozen=True)
class Fields:
    """Velocity (n, 2), pressure (n,), and of the exact field at n places what the sums stand for."""

    velocity: Array
    pressure: Array
    exact: Mapping[str, Array]  # by sum: (n, 2) or (n, 1)
    gradient: Array  # (n, 4) of the velocity, 1/s


@dataclass(frozen=True)
class Measured:
    """A run's errors: by sum and form at the particles and of the means over cells; the same on a lattice;
    by field and form behind the artificial wall.
    """

    flow: str
    spacing: float  # m
    particles: int
    moved: Mapping[tuple[str, str], tuple[float, float]]
    still: Mapping[tuple[str, str], tuple[float, float]]
    behind: Mapping[tuple[str, str], Continued]


def exact_fields(reference: Reference, cloud: Cloud, step: float) -> Fields:
    """Derivatives by central differences of fourth order; worthless where one leaves the fluid."""

    def at(shift_x: float, shift_y: float) -> Array:
        x, y = cloud.wrapped(cloud.position + [shift_x, shift_y]).T
        return np.column_stack([reference.velocity(x, y, cloud.time), reference.pressure(x, y, cloud.time)])

    here = at(0.0, 0.0)
    first, second = [], []
    for axis in ((step, 0.0), (0.0, step)):
        far_below, below, above, far_above = (at(k * axis[0], k * axis[1]) for k in (-2, -1, 1, 2))
        first.append((far_below - 8 * below + 8 * above - far_above) / (12 * step))
        second.append((-far_below + 16 * below - 30 * here + 16 * above - far_above) / (12 * step**2))
    exact = {
        GRADIENT: np.column_stack([first[0][:, 2], first[1][:, 2]]),
        VISCOUS: (second[0] + second[1])[:, :2],
        DIVERGENCE: np.zeros((len(here), 1)),
    }
    gradient = np.concatenate([first[0][:, :2], first[1][:, :2]], axis=1)
    return Fields(here[:, :2], here[:, 2], exact, gradient)


def away_from_walls(cloud: Cloud, step: float, supports: int = 1) -> Array:
    """Which particles (n,) have only fluid within so many kernel supports and the differences' reach."""
    if len(cloud.wall) == 0:
        return np.full(len(cloud.position), True)
    distance, _ = cKDTree(cloud.wall).query(cloud.position)
    return distance > max(supports * SUPPORT, 2 * step / cloud.spacing + 0.5) * cloud.spacing


def root_mean_square(values: Array) -> float:
    return float(np.sqrt(np.mean((values**2).sum(axis=-1))))


def cell_means(places: Array, values: Array, cell: float) -> Array:
    """For each of the values (n, k) the mean over the square cell of that size in m that it lies in, so that
    cells with few particles, beside walls, count for little.
    """
    _, index, count = np.unique(np.floor(places / cell), axis=0, return_inverse=True, return_counts=True)
    index = index.ravel()
    return np.column_stack([np.bincount(index, column) / count for column in values.T])[index]


def errors(cloud: Cloud, reference: Reference, flow: Flow) -> dict[tuple[str, str], tuple[float, float]]:
    """For each sum and form the error at the particles and that of the means over cells, over the root mean
    square of what it stands for; of the divergence over that of the velocity's gradient; of the moments,
    which are numbers, their own.
    """
    fields = exact_fields(reference, cloud, flow.step)
    exact = {**fields.exact, MOMENTS: np.array([[1.0, 1.0, 0.0]])}
    of_the_scale = {**fields.exact, DIVERGENCE: fields.gradient, MOMENTS: np.ones((len(cloud.position), 1))}
    table = {}
    for (name, form), found in sums(cloud, fields.velocity, fields.pressure).items():
        counts = away_from_walls(cloud, flow.step, 2 if form == OF_NEIGHBOURS else 1)
        off, scale = (found - exact[name])[counts], root_mean_square(of_the_scale[name][counts])
        means = cell_means(cloud.position[counts], off, flow.cell)
        table[name, form] = (root_mean_square(off) / scale, root_mean_square(means) / scale)
    return table


def cloud_of(run: Run, options: argparse.Namespace) -> Cloud:
    """The particles at the end of a run; raises CaseError when it fails."""
    result = finished(run, options)
    fluid, wall = result.snapshot(result.end_time)
    domain = run.case.scene(run.variant)["domain"]
    size = np.subtract(domain["upper"], domain["lower"])
    period = np.where([axis in domain["periodic"] for axis in "xy"], size, 0.0)
    return Cloud(fluid.position, wall, fluid.time, period, run.spacing)


def on_a_lattice(case: Case, variant: Variant) -> Variant:
    """The variant with particles that have hardly left a lattice."""
    end_time = 1e-9 * case.scene(variant)["output"]["end_time"]
    changes = {"start.arrangement": "lattice", "output.end_time": end_time, "output.snapshot_times": []}
    return Variant(f"{variant.name}_lattice", {**variant.set, **changes})


def measure(flow: Flow, references: References, options: argparse.Namespace) -> list[Measured]:
    """Runs a flow at each of its spacings."""
    case = load_case(flow.case)
    variant = next(v for v in case.variants if v.name == flow.variant)
    reference, found = references.of(case, variant), []
    for spacing in flow.spacings:
        cloud, lattice = (
            cloud_of(Run(case, "default", arranged, spacing, finest=False), options)
            for arranged in (variant, on_a_lattice(case, variant))
        )
        moved, still = errors(cloud, reference, flow), errors(lattice, reference, flow)
        behind = continuations(cloud, reference, flow.wall, flow.step) if flow.wall else {}
        label = f"{case.name}, {variant.name}".replace("_", " ")
        found.append(Measured(label, spacing, len(cloud.position), moved, still, behind))
    return found


def percent(values: Sequence[float]) -> list[str]:
    return [f"{100 * value:.2g}" for value in values]


def sums_table(measured: Sequence[Measured]) -> Table:
    """The solver's forms: a row for each run and sum."""
    rows = []
    for run in measured:
        for key in SOLVER.items():
            cells = percent([*run.moved[key], run.still[key][0]])
            rows.append(("", [run.flow, f"{run.spacing:g}", str(run.particles), key[0], *cells]))
    return Table(HEAD, rows)


def forms_table(measured: Sequence[Measured]) -> Table:
    """All forms: a row for each, a column for each run."""
    rows = []
    for key in [(name, form) for name, forms in FORMS.items() for form in forms]:
        cells = [" / ".join(percent([*run.moved[key], run.still[key][0]])) for run in measured]
        rows.append(("", [*key, *cells]))
    return Table(("sum", "form", *(f"{run.flow}, {run.spacing:g} m" for run in measured)), rows)


def walls_table(measured: Sequence[Measured]) -> Table:
    """What is continued behind a wall: a row for each form, a column for each run that has such a wall."""
    runs = [run for run in measured if run.behind]
    rows = []
    for key in [(field, form) for field, forms in wall_continuation.FORMS.items() for form in forms]:
        cells = [" / ".join(percent(run.behind[key].error)) for run in runs]
        noise = " / ".join(f"{value:.2g}" for value in runs[-1].behind[key].noise)
        rows.append(("", [*key, *cells, noise]))
    return Table(("field", "form", *(f"{run.flow}, {run.spacing:g} m" for run in runs), "noise"), rows)


TABLES = {"operators": sums_table, "forms": forms_table, "walls": walls_table}  # by their markers


def measure_all(options: argparse.Namespace) -> dict[str, Table]:
    """The tables by their markers."""
    references = References()
    measured = [run for flow in FLOWS for run in measure(flow, references, options)]
    return {marker: table(measured) for marker, table in TABLES.items()}


def main(argv: Sequence[str] | None = None) -> int:
    return write_tables("operators", __doc__.splitlines()[0], PAGE, measure_all, argv)


if __name__ == "__main__":
    sys.exit(main())
