"""Errors of the discrete operators on the exact field, at the particles of a run.

`python -m verification.operators` runs the flows below with the default scheme, takes the reference's
velocity and pressure at their particles, and holds the sums over pairs against the reference's derivatives.
That tells what a sum misses from what the flow makes of it. Three ways: at each particle; as means over cells
of fixed size, because noise of no mean moves particles and not the fluid; and over particles on a lattice,
where only the truncation is left. Only particles whose neighbours are all fluid count. The table goes between
the markers of accuracy.md. Exit status: 0; 1 when a run failed; 2 when it cannot start.

The sums are those of solver/terms: the pressure gradient with (p_i + p_j), Eq. 2.15 with constant volumes;
the viscous one of Eq. 2.15; the divergence with the gradient correction of Eq. 2.21.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from reference import Reference
from verification.case import ROOT, Case, CaseError, Variant, load_case
from verification.compare import Array, DataError
from verification.execute import Run, execute
from verification.markers import replace_between
from verification.page import Table
from verification.run import REPOSITORY, References

PAGE = ROOT / "accuracy.md"
KERNEL = REPOSITORY / "solver" / "kernels" / "fitted_quintic.hpp"  # the default scheme's
SUPPORT = 3.0  # smoothing lengths
SUMS = ("pressure gradient", "viscous force", "divergence")
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
    """`step`: of the differences that stand for the reference's derivatives, m; `cell`: of the means, m."""

    case: str
    variant: str
    spacings: tuple[float, ...]
    step: float
    cell: float


FLOWS = (
    Flow("taylor_green", "re_100", (0.04, 0.02, 0.01), 0.01, 0.1),
    Flow("rough_channel", "top_wall_moves", (5e-7, 2.5e-7, 1.25e-7), 2e-7, 2e-6),
)


@dataclass(frozen=True)
class Cloud:
    """Fluid particles (n, 2) and those of walls (m, 2) in m at a time in s; `period` (2,) in m, 0: none."""

    position: Array
    wall: Array
    time: float
    period: Array
    spacing: float

    def wrapped(self, places: Array) -> Array:
        """Places (n, 2) in m, those beyond a periodic side brought back."""
        periodic = self.period > 0
        return np.where(periodic, places % np.where(periodic, self.period, 1.0), places)


@dataclass(frozen=True)
class Fields:
    """Velocity (n, 2), pressure (n,), and of the exact field at n places what the sums stand for."""

    velocity: Array
    pressure: Array
    exact: Mapping[str, Array]  # by SUMS: (n, 2) or (n, 1)
    gradient: Array  # (n, 4) of the velocity, 1/s


def kernel_slope(squared: Array) -> Array:
    """h^4 (dW/dr) / r of the default kernel from (r / h)^2, with the solver's own coefficients."""
    found = re.search(r"coefficients\{(.*?)\}", KERNEL.read_text(), re.DOTALL)
    if not found:
        raise DataError(f"{KERNEL.name} names no coefficients")
    left = np.maximum(0.0, 1.0 - squared / SUPPORT**2)
    return -(left**5) * np.polynomial.polynomial.polyval(left, [float(c) for c in found[1].split(",")])


def sums(cloud: Cloud, velocity: Array, pressure: Array) -> dict[str, Array]:
    """The sums of the particles of a cloud, by SUMS: (n, 2), (n, 2), (n, 1), in units of the derivatives that
    they stand for; and as "moments" (n, 3) -sum V F (x x, y y, x y), which are 1, 1, 0 in a continuum.
    """
    h, volume = cloud.spacing, cloud.spacing**2  # the default smoothing_ratio is 1
    inside = cloud.wrapped(cloud.position)
    i, j = cKDTree(inside, boxsize=cloud.period).query_pairs(SUPPORT * h, output_type="ndarray").T
    i, j = np.concatenate([i, j]), np.concatenate([j, i])
    apart = inside[i] - inside[j]
    apart -= cloud.period * np.round(apart / np.where(cloud.period > 0, cloud.period, np.inf))
    weight = volume * kernel_slope((apart**2).sum(axis=1) / h**2) / h**4
    change = velocity[i] - velocity[j]

    def total(terms: Array) -> Array:
        return np.column_stack([np.bincount(i, term, len(inside)) for term in terms.T])

    moments = -total(weight[:, None] * np.column_stack([apart**2, apart[:, 0] * apart[:, 1]]))
    slopes = total(weight[:, None] * np.column_stack([change * apart, change * apart[:, ::-1]]))
    xx, yy, xy = moments.T
    compression = yy * slopes[:, 0] + xx * slopes[:, 1] - xy * (slopes[:, 2] + slopes[:, 3])
    return {
        SUMS[0]: total((weight * (pressure[i] + pressure[j]))[:, None] * apart),
        SUMS[1]: total(2 * weight[:, None] * change),
        SUMS[2]: -(compression / (xx * yy - xy**2))[:, None],
        "moments": moments,
    }


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
        SUMS[0]: np.column_stack([first[0][:, 2], first[1][:, 2]]),
        SUMS[1]: (second[0] + second[1])[:, :2],
        SUMS[2]: np.zeros((len(here), 1)),
    }
    gradient = np.concatenate([first[0][:, :2], first[1][:, :2]], axis=1)
    return Fields(here[:, :2], here[:, 2], exact, gradient)


def away_from_walls(cloud: Cloud, step: float) -> Array:
    """Which particles (n,) have only fluid within a kernel's support and within the differences' reach."""
    if len(cloud.wall) == 0:
        return np.full(len(cloud.position), True)
    distance, _ = cKDTree(cloud.wall).query(cloud.position)
    return distance > max(SUPPORT, 2 * step / cloud.spacing + 0.5) * cloud.spacing


def root_mean_square(values: Array) -> float:
    return float(np.sqrt(np.mean((values**2).sum(axis=-1))))


def cell_means(places: Array, values: Array, cell: float) -> Array:
    """Means (cells, k) of values (n, k) over square cells of that size in m."""
    _, index, count = np.unique(np.floor(places / cell), axis=0, return_inverse=True, return_counts=True)
    index = index.ravel()
    return np.column_stack([np.bincount(index, column) / count for column in values.T])


def errors(cloud: Cloud, reference: Reference, flow: Flow) -> dict[str, tuple[float, float]]:
    """For each of SUMS the error at the particles and that of the means over cells, over the root mean square
    of what it stands for; of the divergence over that of the velocity's gradient. "moments": the root mean
    squares of what they are off by.
    """
    fields = exact_fields(reference, cloud, flow.step)
    found = sums(cloud, fields.velocity, fields.pressure)
    counts = away_from_walls(cloud, flow.step)
    places = cloud.position[counts]
    table = {}
    for name in SUMS:
        off = (found[name] - fields.exact[name])[counts]
        scale = root_mean_square(fields.exact[name][counts]) or root_mean_square(fields.gradient[counts])
        means = cell_means(places, off, flow.cell)
        table[name] = (root_mean_square(off) / scale, root_mean_square(means) / scale)
    off = (found["moments"] - [1.0, 1.0, 0.0])[counts]
    table["moments"] = (root_mean_square(off), root_mean_square(cell_means(places, off, flow.cell)))
    return table


def cloud_of(run: Run, options: argparse.Namespace) -> Cloud:
    """The particles at the end of a run; raises CaseError when it fails."""
    chosen = argparse.Namespace(**vars(options), solver_set=[], reuse=False, timeout=3600.0)
    outcome = execute(run, chosen)
    if outcome.failure:
        raise CaseError(f"{run.label}: {outcome.failure}")
    fluid, wall = outcome.result.snapshot(outcome.result.end_time)
    domain = run.case.scene(run.variant)["domain"]
    size = np.subtract(domain["upper"], domain["lower"])
    period = np.where([axis in domain["periodic"] for axis in "xy"], size, 0.0)
    return Cloud(fluid.position, wall, fluid.time, period, run.spacing)


def on_a_lattice(case: Case, variant: Variant) -> Variant:
    """The variant with particles that have hardly left a lattice."""
    end_time = 1e-9 * case.scene(variant)["output"]["end_time"]
    changes = {"start.arrangement": "lattice", "output.end_time": end_time, "output.snapshot_times": []}
    return Variant(f"{variant.name}_lattice", {**variant.set, **changes})


def rows_of(flow: Flow, references: References, options: argparse.Namespace) -> list[list[str]]:
    """The table's rows of a flow, one for each spacing and sum."""
    case = load_case(flow.case)
    variant = next(v for v in case.variants if v.name == flow.variant)
    reference, rows = references.of(case, variant), []
    for spacing in flow.spacings:
        cloud, lattice = (
            cloud_of(Run(case, "default", arranged, spacing, finest=False), options)
            for arranged in (variant, on_a_lattice(case, variant))
        )
        moved, still = errors(cloud, reference, flow), errors(lattice, reference, flow)
        for name in (*SUMS, "moments"):
            cells = [100 * value for value in (*moved[name], still[name][0])]
            rows.append(
                [
                    f"{case.name}, {variant.name}".replace("_", " "),
                    f"{spacing:g}",
                    str(len(cloud.position)),
                    name,
                    *[f"{value:.2g}" for value in cells],
                ]
            )
    return rows


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m verification.operators", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--solver", type=Path, default=REPOSITORY / "build" / "slurry")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build" / "operators")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--page", type=Path, default=PAGE, help="with the markers of the table")
    options = parser.parse_args(argv)
    references = References()
    try:
        rows = [row for flow in FLOWS for row in rows_of(flow, references, options)]
        table = Table(HEAD, [("", row) for row in rows]).markdown().strip()
        print(table)
        replace_between(options.page, "operators", table)
    except CaseError as error:
        print(f"FAILED: {error}")
        return 1
    except (DataError, OSError, ValueError) as error:
        print(f"operators: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
