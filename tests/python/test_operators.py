"""Sums over pairs against fields whose derivatives are known, and the table's place in the page."""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np
import pytest

from verification import operators, wall_continuation
from verification.case import CaseError
from verification.operator_forms import DIVERGENCE, FORMS, GRADIENT, MOMENTS, SOLVER, VISCOUS, Cloud
from verification.operators import Flow, Measured
from verification.wall_continuation import Continued

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
    for key in [(name, form) for name in (GRADIENT, VISCOUS) for form in FORMS[name]]:
        assert 3.5 < coarse[key][0] / fine[key][0] < 4.5  # second order
    assert fine[DIVERGENCE, SOLVER[DIVERGENCE]][0] < 1e-12
    assert fine[MOMENTS, ""][0] < 5e-4


def test_disorder_is_seen_and_most_of_it_has_no_mean():
    still, moved = (operators.errors(box(jitter=jitter), Vortices(), FLOW) for jitter in (0.0, 0.1))
    for key in SOLVER.items():
        at_particles, means = moved[key]
        assert at_particles > 3 * still[key][0]
        assert means < 0.5 * at_particles


def test_a_cell_counts_by_its_particles():
    places = np.array([[0.1, 0.1], [0.3, 0.4], [0.2, 0.2], [1.5, 0.5]])
    means = operators.cell_means(places, np.array([[1.0], [2.0], [3.0], [8.0]]), cell=1.0)
    assert means.ravel().tolist() == [2.0, 2.0, 2.0, 8.0]


def test_particles_near_walls_do_not_count():
    cloud = replace(box(), wall=np.column_stack([np.arange(0.0, 1.0, 0.02), np.full(50, -0.01)]))
    counts = operators.away_from_walls(cloud, 0.01)
    height = cloud.position[:, 1]
    assert not counts[height < 0.04].any()
    assert counts[height > 0.06].all()
    further = operators.away_from_walls(cloud, 0.01, supports=2)
    assert not further[height < 0.1].any()
    assert further[height > 0.12].all()


def test_a_form_with_the_neighbours_corrections_is_measured_where_these_are_whole():
    bottom = np.column_stack([np.arange(0.0, 1.0, 0.02), np.full(50, -0.01)])
    fence = np.concatenate([bottom, bottom[:, ::-1], 1 - bottom, 1 - bottom[:, ::-1]])
    enclosed = replace(box(), period=np.zeros(2), wall=fence)
    form = (GRADIENT, "p_i B_i + p_j B_j")
    walled, whole = (operators.errors(cloud, Vortices(), FLOW)[form][0] for cloud in (enclosed, box()))
    assert walled == pytest.approx(whole, rel=0.3)


def test_only_periodic_axes_are_wrapped():
    cloud = replace(box(), period=np.array([1.0, 0.0]))
    assert cloud.wrapped(np.array([[-0.25, -0.25], [1.25, 1.25]])).tolist() == [[0.75, -0.25], [0.25, 1.25]]


def test_what_lies_beyond_a_wall_does_not_scale_the_divergence():
    class Torn(Vortices):
        def velocity(self, x, y, t):
            return super().velocity(x, y, t) * np.where(y > 0, 1.0, 1e6)[:, None]

    wall = np.column_stack([np.arange(0.0, 1.0, 0.02), np.full(50, -0.01)])
    cloud = replace(box(jitter=0.1), wall=wall, period=np.array([1.0, 0.0]))
    key = (DIVERGENCE, SOLVER[DIVERGENCE])
    torn, sound = (operators.errors(cloud, field, FLOW)[key] for field in (Torn(), Vortices()))
    assert torn == pytest.approx(sound)


def measured(flow="box", walls=False):
    """A run whose error is 1, 2 and 3 % of everything, behind a wall 4 % at each depth."""
    keys = [*SOLVER.items(), *((name, form) for name, forms in FORMS.items() for form in forms)]
    fields = [(field, form) for field, forms in wall_continuation.FORMS.items() for form in forms]
    behind = dict.fromkeys(fields, Continued((0.04,) * 3, (5.0,) * 3)) if walls else {}
    return Measured(
        flow, 0.5, 42, dict.fromkeys(keys, (0.01, 0.02)), dict.fromkeys(keys, (0.03, 0.0)), behind
    )


def test_the_tables_have_all_forms_and_only_flows_with_a_wall_behind_it():
    runs = [measured(), measured("channel", walls=True)]
    of_the_solver = operators.sums_table(runs).markdown()
    assert "| box | 0.5 | 42 | viscous force | 1 | 2 | 3 |" in of_the_solver
    forms = operators.forms_table(runs).markdown()
    assert "| sum | form | box, 0.5 m | channel, 0.5 m |" in forms
    assert forms.count("| 1 / 2 / 3 | 1 / 2 / 3 |") == sum(map(len, FORMS.values()))
    walls = operators.walls_table(runs).markdown()
    assert "| field | form | channel, 0.5 m | noise |" in walls
    assert "| pressure | second order | 4 / 4 / 4 | 5 / 5 / 5 |" in walls


def test_the_tables_go_into_the_page(tmp_path, monkeypatch):
    page = tmp_path / "accuracy.md"
    page.write_text("".join(f"<!-- {name}:begin -->\n<!-- {name}:end -->\n" for name in operators.TABLES))
    seen: list[argparse.Namespace] = []

    def measure(flow, references, options):
        seen.append(options)
        return [measured(flow.case, walls=True)]

    monkeypatch.setattr(operators, "measure", measure)
    assert operators.main(["--page", str(page)]) == 0
    assert "| taylor_green | 0.5 | 42 | divergence | 1 | 2 | 3 |" in page.read_text()
    assert len(seen) == len(operators.FLOWS)


def test_a_run_that_fails_fails_the_command(tmp_path, monkeypatch, capsys):
    def measure(*rest):
        raise CaseError("rough_channel at 1e-07 m: exit status 3")

    monkeypatch.setattr(operators, "measure", measure)
    assert operators.main(["--page", str(tmp_path / "none.md")]) == 1
    assert "exit status 3" in capsys.readouterr().out
