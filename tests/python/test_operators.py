"""Sums over pairs against fields whose derivatives are known, and the table's place in the page."""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np
import pytest

from verification import operators
from verification.compare import DataError
from verification.operators import Cloud, Flow

FLOW = Flow("box", "box", (0.02,), step=0.01, cell=0.1)


class Vortices:
    """A field of period 1, and what a difference of it must give."""

    def velocity(self, x, y, t):
        return np.column_stack([np.sin(2 * np.pi * y), np.sin(2 * np.pi * x)])

    def pressure(self, x, y, t):
        return np.cos(2 * np.pi * x) * np.cos(2 * np.pi * y)


def box(spacing=0.02, jitter=0.0):
    """A periodic box of size 1, its lattice moved by `jitter` spacings."""
    along = np.arange(0.5 * spacing, 1.0, spacing)
    places = np.column_stack([axis.ravel() for axis in np.meshgrid(along, along)])
    places += jitter * spacing * np.random.default_rng(1).uniform(-1, 1, places.shape)
    return Cloud(places, np.empty((0, 2)), 0.0, np.array([1.0, 1.0]), spacing)


def test_the_kernel_is_the_solver_s():
    radii = np.linspace(1e-6, 3, 20001)
    slope = operators.kernel_slope(radii**2)
    assert np.pi * -np.trapezoid(slope * radii**3, radii) == pytest.approx(1.0, abs=1e-6)  # as a delta's
    assert operators.kernel_slope(np.array([9.0, 10.0])).tolist() == [0.0, 0.0]


def test_without_coefficients_nothing_is_measured(tmp_path, monkeypatch):
    monkeypatch.setattr(operators, "KERNEL", tmp_path / "kernel.hpp")
    operators.KERNEL.write_text("struct FittedQuintic {};")
    with pytest.raises(DataError, match="coefficients"):
        operators.kernel_slope(np.array([1.0]))


def test_exact_derivatives_are_those_of_the_field():
    cloud = box()
    fields = operators.exact_fields(Vortices(), cloud, 0.01)
    x, y = 2 * np.pi * cloud.position.T
    assert fields.exact["pressure gradient"][:, 0] == pytest.approx(
        -2 * np.pi * np.sin(x) * np.cos(y), abs=1e-4
    )
    assert fields.exact["viscous force"][:, 0] == pytest.approx(-((2 * np.pi) ** 2) * np.sin(y), abs=1e-3)
    assert operators.root_mean_square(fields.gradient) == pytest.approx(2 * np.pi, rel=1e-5)


def test_a_lattice_leaves_the_truncation_alone():
    coarse, fine = (operators.errors(box(spacing), Vortices(), FLOW) for spacing in (0.04, 0.02))
    for name in operators.SUMS[:2]:
        assert 3.5 < coarse[name][0] / fine[name][0] < 4.5  # second order
    assert fine["divergence"][0] < 1e-12
    assert fine["moments"][0] < 5e-4


def test_disorder_is_seen_and_most_of_it_has_no_mean():
    still, moved = (operators.errors(box(jitter=jitter), Vortices(), FLOW) for jitter in (0.0, 0.1))
    for name in (*operators.SUMS, "moments"):
        at_particles, means = moved[name]
        assert at_particles > 3 * still[name][0]
        assert means < 0.5 * at_particles


def test_particles_near_walls_do_not_count():
    cloud = replace(box(), wall=np.column_stack([np.arange(0.0, 1.0, 0.02), np.full(50, -0.01)]))
    counts = operators.away_from_walls(cloud, 0.01)
    height = cloud.position[:, 1]
    assert not counts[height < 0.04].any()
    assert counts[height > 0.06].all()


def test_only_periodic_axes_are_wrapped():
    cloud = replace(box(), period=np.array([1.0, 0.0]))
    assert cloud.wrapped(np.array([[-0.25, -0.25], [1.25, 1.25]])).tolist() == [[0.75, -0.25], [0.25, 1.25]]


def test_what_lies_beyond_a_wall_does_not_scale_the_divergence():
    class Torn(Vortices):
        def velocity(self, x, y, t):
            return super().velocity(x, y, t) * np.where(y > 0, 1.0, 1e6)[:, None]

    wall = np.column_stack([np.arange(0.0, 1.0, 0.02), np.full(50, -0.01)])
    cloud = replace(box(jitter=0.1), wall=wall, period=np.array([1.0, 0.0]))
    torn, sound = (operators.errors(cloud, field, FLOW)["divergence"] for field in (Torn(), Vortices()))
    assert torn == pytest.approx(sound)


def test_the_table_goes_into_the_page(tmp_path, monkeypatch):
    page = tmp_path / "accuracy.md"
    page.write_text("<!-- operators:begin -->\n<!-- operators:end -->\n")
    seen: list[argparse.Namespace] = []

    def rows_of(flow, references, options):
        seen.append(options)
        return [[flow.case, *"123456"]]

    monkeypatch.setattr(operators, "rows_of", rows_of)
    assert operators.main(["--page", str(page)]) == 0
    assert "| taylor_green | 1 | 2 | 3 | 4 | 5 | 6 |" in page.read_text()
    assert len(seen) == len(operators.FLOWS)


def test_a_run_that_fails_fails_the_command(tmp_path, monkeypatch, capsys):
    def rows_of(*rest):
        raise operators.CaseError("rough_channel at 1e-07 m: exit status 3")

    monkeypatch.setattr(operators, "rows_of", rows_of)
    assert operators.main(["--page", str(tmp_path / "none.md")]) == 1
    assert "exit status 3" in capsys.readouterr().out
