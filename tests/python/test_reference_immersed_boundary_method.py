"""The method of the immersed-boundary reference: flow without discs, forces on discs and their motion."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from reference.immersed_boundary_discs import Contact, Coverage, Disc, Discs, Markers, delta
from reference.immersed_boundary_flow import Flow, Grid
from reference.immersed_boundary_run import Problem, prepared

AXES = list(itertools.product((False, True), repeat=2))


def free_disc(density, viscosity=1e-6, periodic=(False, False), **changes):
    disc = Disc(radius=1e-3, density=density, position=(0.0101, 0.0103), **changes)
    return Problem((0.02, 0.02), periodic, 1000.0, viscosity, (0.0, -9.81), (disc,))


def stirred(periodic):
    """A flow with a divergence-free random velocity."""
    flow = Flow(Grid((12, 10), (1.2, 1.0), periodic), 0.01)
    random = np.random.default_rng(1)
    flow.project([random.normal(size=flow.grid.shape(component)) for component in range(2)], 1.0)
    return flow


@pytest.mark.parametrize("periodic", AXES)
def test_pressure_solve_is_exact_and_flow_stays_free_of_divergence(periodic):
    flow = stirred(periodic)
    nothing = [np.zeros_like(field) for field in flow.velocity]
    for _ in range(3):
        flow.project(flow.predicted(0.01, nothing), 0.01)
        assert np.abs(flow.velocity[0]).max() > 0.1
        assert np.abs(flow.divergence(flow.velocity)).max() < 1e-12


@pytest.mark.parametrize("periodic", AXES)
def test_convection_keeps_energy(periodic):
    flow = stirred(periodic)
    change = sum((c * u).sum() for c, u in zip(flow.convection(), flow.velocity, strict=True))
    size = sum(np.abs(c * u).sum() for c, u in zip(flow.convection(), flow.velocity, strict=True))
    assert abs(change) < 1e-13 * size


def decay_error(cells, periodic, start, rate):
    """Largest error of u after 0.5 s, over its start, of a flow that decays at `rate` (1/s)."""
    flow = Flow(Grid((cells, cells), (1.0, 1.0), periodic), 0.05)
    places = [
        np.meshgrid(
            *[
                (flow.grid.origin(part)[axis] + np.arange(flow.grid.shape(part)[axis])) / cells
                for axis in (0, 1)
            ],
            indexing="ij",
        )
        for part in (0, 1)
    ]
    flow.velocity = [start[part](*places[part]) for part in (0, 1)]
    nothing, steps = [np.zeros_like(field) for field in flow.velocity], 2 * cells
    for _ in range(steps):
        flow.project(flow.predicted(0.5 / steps, nothing), 0.5 / steps)
    return np.abs(flow.velocity[0] - start[0](*places[0]) * math.exp(-0.5 * rate)).max()


@pytest.mark.parametrize("flow", ["taylor_green", "channel"])
def test_flow_without_discs_is_of_second_order(flow):
    k = 2 * math.pi
    if flow == "taylor_green":
        start = (lambda x, y: -np.cos(k * x) * np.sin(k * y), lambda x, y: np.sin(k * x) * np.cos(k * y))
        errors = [decay_error(cells, (True, True), start, 0.1 * k**2) for cells in (16, 32)]
    else:
        start = (lambda x, y: np.sin(math.pi * y), lambda x, y: np.zeros_like(x))
        errors = [decay_error(cells, (True, False), start, 0.05 * math.pi**2) for cells in (16, 32)]
    assert errors[1] < 2e-3
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2)


def test_delta_has_its_moments():
    for offset in np.linspace(-0.5, 0.5, 11):
        r = np.arange(-2, 3) - offset
        assert delta(r).sum() == pytest.approx(1)
        assert (r * delta(r)).sum() == pytest.approx(0, abs=1e-14)
        assert (delta(r) ** 2).sum() == pytest.approx(0.5)


@pytest.mark.parametrize("periodic", AXES)
def test_spreading_is_the_adjoint_of_interpolating(periodic):
    flow = stirred(periodic)
    discs = (Disc(0.2, 1.0, (0.5, 0.5)), Disc(0.15, 1.0, (1.1, 0.9)))  # the second reaches over the sides
    markers = Markers(flow.grid, discs, np.array([[*disc.position, 0.3] for disc in discs]))
    values = np.random.default_rng(2).normal(size=markers.arms.shape)
    fields = [np.zeros_like(field) for field in flow.velocity]
    markers.spread(values, fields)
    spread = sum((f * u).sum() for f, u in zip(fields, flow.velocity, strict=True)) * 0.1 * 0.1
    assert spread == pytest.approx(
        (values * markers.interpolated(flow.velocity) * markers.areas[:, None]).sum()
    )


def test_coverage_integrates_rigid_motion_exactly():
    grid = Grid((20, 30), (1.0, 1.5), (False, True))
    disc = Disc(0.2, 1.0, (0.0, 0.0))
    for place in ([0.512, 0.744], [0.49, 0.03]):
        x = (grid.origin(0)[1] + np.arange(30)) * 0.05, (grid.origin(1)[0] + np.arange(20)) * 0.05
        away = x[0] - place[1]
        away -= 1.5 * np.round(away / 1.5)
        velocity = [np.zeros(grid.shape(0)) + 2 - 3 * away[None, :], np.zeros(grid.shape(1)) - 1]
        velocity[1] = velocity[1] + 3 * (x[1] - place[0])[:, None]
        area = math.pi * 0.04
        expected = [2 * area, -area, 3 * area * 0.02]
        assert_allclose(Coverage(grid, disc, np.array(place)).integral(velocity), expected, rtol=0.02)


def test_disc_without_weight_stays_at_rest():
    problem = dataclasses.replace(free_disc(1500.0), gravity=(0.0, 0.0))
    grid = Grid((20, 20), problem.size, problem.periodic)
    contact = Contact(np.array([1e-3]), grid, 1e-3, 1.0)
    discs = Discs(Flow(grid, 1e-6), 1000.0, problem.discs, problem.gravity, contact)
    for _ in range(5):
        discs.step(1e-3)
    assert not discs.velocity.any()
    assert not discs.flow.velocity[0].any()


def test_momentum_of_discs_and_fluid_is_what_weight_gives():
    problem = free_disc(1500.0, 1e-5, periodic=(True, True))
    discs = prepared(problem, Grid((80, 80), problem.size, problem.periodic))
    pushed, steps = np.zeros(3), 60
    for _ in range(steps):
        discs.step(2e-4)
        pushed += discs.impulse[0]
    cell = discs.flow.grid.spacing[0] * discs.flow.grid.spacing[1]
    fluid = [1000.0 * field.sum() * cell for field in discs.flow.velocity]
    assert_allclose(fluid, pushed[:2], rtol=1e-10, atol=1e-12)
    given = steps * 2e-4 * discs.weight[0]
    solid = discs._momentum[0] - 1000.0 * discs._within[0]  # what the disc has beyond the fluid it covers
    assert_allclose(solid + pushed, given, atol=1e-10 * abs(given[1]))
    assert discs.mass[0, 1] * discs.velocity[0, 1] == pytest.approx(discs._momentum[0, 1], rel=0.01)


@pytest.mark.parametrize("density", [100.0, 1100.0, 3000.0])
def test_fluid_set_in_motion_adds_its_mass(density):
    """In nearly no viscosity a disc starts as if it had the mass of the displaced fluid in addition.

    The fluid that the regularised rim drags along is of first order in the spacing, hence the two grids.
    """
    problem, added = free_disc(density, 1e-8), []
    for cells in (80, 160):
        discs = prepared(problem, Grid((cells, cells), problem.size, problem.periodic))
        speeds = []
        for _ in range(60):
            discs.step(1e-4)
            speeds.append(discs.velocity[0, 1])
        acceleration = (speeds[-1] - speeds[29]) / 3e-3  # after the first response of the coupling
        added.append((density - 1000.0) * -9.81 / acceleration - density)
    assert 2 * added[1] - added[0] == pytest.approx(1000.0, rel=0.05)


def test_torque_on_a_turning_disc():
    """Close to 4 pi mu R^2 W / (1 - (R / r)^2) of a circle of radius r = 1.08 half widths of the box."""
    box = dataclasses.replace(free_disc(1000.0, 1e-4), size=(0.008, 0.008), gravity=(0.0, 0.0))
    disc = Disc(1e-3, 1000.0, (0.00401, 0.00402), spin=1.0, free=False)
    problem = dataclasses.replace(box, discs=(disc,))
    discs, step = prepared(problem, Grid((64, 64), problem.size, problem.periodic)), 6e-4
    for _ in range(100):
        discs.step(step)
    exact = 4 * math.pi * 0.1 * 1e-3**2 / (1 - (1e-3 / 0.00432) ** 2)
    assert discs.impulse[0, 2] / step == pytest.approx(exact, rel=0.04)


def test_contact_repels():
    contact = Contact(np.array([1.0, 1.0, 1.0]), Grid((8, 8), (10.0, 10.0), (True, False)), 0.5, 3.0)
    place = np.array([[0.5, 1.1, 0.0], [9.0, 2.5, 0.0], [5.0, 5.0, 0.0]])
    forces = contact.forces(place)
    gap = 2 * (1.1 - 1.0)
    wall = np.array([0.0, 3.0 * (1 - gap / 0.5) ** 2, 0.0])
    assert (forces[0] - wall)[0] > 0 > (forces[0] - wall)[1]
    assert_allclose(forces[0] - wall, -forces[1])
    assert not forces[2].any()
