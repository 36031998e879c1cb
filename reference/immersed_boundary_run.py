"""One run of discs in a box of fluid on one grid, from what the motion depends on to its samples in time.

Step: COURANT times the spacing over the speed of the fastest fluid, or over the scale of the discs' speeds
until that is reached; at most MOST_DIFFUSION. The first is FIRST_STEP of that and the next ones are longer by
GROWTH, because a disc set free needs some twenty steps to take the fluid along. Contact
(immersed_boundary_discs.py) begins at CONTACT_CELLS spacings between rims, where the grid no longer resolves
the fluid between them.
"""

import json
import math
from dataclasses import astuple, dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from reference.base import Array, ReferenceError
from reference.immersed_boundary_discs import Contact, Disc, Discs
from reference.immersed_boundary_flow import Flow, Grid

FINEST_CELLS = 32  # to the smallest diameter
LAYER_CELLS = 1.5  # to the thickness of boundary layers
COURANT = 0.5
MOST_DIFFUSION = 4  # viscosity times step over squared spacing
FIRST_STEP = 0.02
GROWTH = 1.1
CONTACT_CELLS = 2


@dataclass(frozen=True)
class Problem:
    """What the motion of discs in a box depends on; its lower left corner is the origin."""

    size: tuple[float, float]  # m
    periodic: tuple[bool, bool]  # else walls at rest
    density: float  # kg/m3
    viscosity: float  # kinematic, m2/s
    gravity: tuple[float, float]  # m/s2
    discs: tuple[Disc, ...]

    def identity(self) -> dict[str, object]:
        """All of it as lists, rounded so that 0.01 - 1e-5 and 0.00999 are the same."""
        text = json.dumps(dict(zip(self.__dataclass_fields__, astuple(self), strict=True)))
        return json.loads(text, parse_float=lambda number: float(f"{float(number):.12g}"))

    def speed(self) -> float:
        """The scale of the discs' speeds, m/s: of free fall against pressure drag, or given."""
        falls = [abs(disc.density / self.density - 1) * disc.radius for disc in self.discs if disc.free]
        given = [math.hypot(*disc.velocity) + abs(disc.spin) * disc.radius for disc in self.discs]
        return max(math.sqrt(math.pi * math.hypot(*self.gravity) * max(falls, default=0)), *given)

    def grid(self, share: float) -> Grid:
        """A grid with that share of the finest's cells along an axis.

        The finest has FINEST_CELLS or more to the smallest diameter D, LAYER_CELLS or more to D / sqrt(Re).
        """
        diameter = 2 * min(disc.radius for disc in self.discs)
        layer = LAYER_CELLS * math.sqrt(self.speed() * diameter / self.viscosity)
        cells = share * 2 ** math.ceil(math.log2(max(FINEST_CELLS, layer)))
        counts = [round(cells * size / diameter) for size in self.size]
        return Grid((counts[0], counts[1]), self.size, self.periodic)


def prepared(problem: Problem, grid: Grid) -> Discs:
    """Fluid and discs at time 0."""
    reach, speed = CONTACT_CELLS * max(grid.spacing), problem.speed()
    heaviest = max(max(disc.density, problem.density) * math.pi * disc.radius**2 for disc in problem.discs)
    radii = np.array([disc.radius for disc in problem.discs])
    touch = 3 * heaviest * speed**2 / reach  # twice the work that stops the heaviest at that speed
    contact = Contact(radii, grid, reach, touch)
    return Discs(Flow(grid, problem.viscosity), problem.density, problem.discs, problem.gravity, contact)


def steps_left(flow: Flow, speed: float, time: float, number: int, courant: float = COURANT) -> int:
    """How many steps the time left (s) is worth; `speed` (m/s): the least scale; `number`: from 1 on."""
    spacing = min(flow.grid.spacing)
    fastest = max(speed, sum(float(np.abs(field).max()) for field in flow.velocity))
    slowest = flow.viscosity / (MOST_DIFFUSION * spacing**2)  # steps a second
    rate = max(fastest / (courant * spacing), slowest)
    return math.ceil(time * max(rate, rate / FIRST_STEP / GROWTH**number))


def run(problem: Problem, grid: Grid, times: Array) -> tuple[Array, float]:
    """Moves the discs from time 0 = times[0] to times[-1] (s).

    Returns (times, discs, 6): x, y (m), angle (rad), velocity (m/s), spin (rad/s); and when contact first
    acted (s), infinite if never. Raises ReferenceError when the run breaks down.
    """
    discs, speed, end = prepared(problem, grid), problem.speed(), float(times[-1])
    now, stamps, states, touched = 0.0, [0.0], [np.hstack((discs.place, discs.velocity))], math.inf
    while now < end:
        left = steps_left(discs.flow, speed, end - now, len(stamps))
        discs.step((end - now) / left)
        now = end if left == 1 else now + (end - now) / left
        stamps.append(now)
        states.append(np.hstack((discs.place, discs.velocity)))
        if not np.isfinite(states[-1]).all():
            raise ReferenceError(f"discs on {grid.cells} cells: the run broke down at {now:.4g} s")
        if touched == math.inf and discs.contact.forces(discs.place).any():
            touched = now
    return sampled(np.array(stamps), np.array(states), times), touched


def sampled(stamps: Array, states: Array, times: Array) -> Array:
    """States between steps: places by cubics that have the velocities as slopes, velocities linearly."""
    place = CubicHermiteSpline(stamps, states[:, :, :3], states[:, :, 3:])(times)
    columns = states[:, :, 3:].reshape(len(stamps), -1).T
    velocity = np.column_stack([np.interp(times, stamps, column) for column in columns])
    return np.concatenate((place, velocity.reshape(place.shape)), 2)
