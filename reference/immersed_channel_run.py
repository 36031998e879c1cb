"""One disc in a channel with a rough wall, on one grid: the flow, the wall and the samples in time.

Flow (immersed_boundary_flow.py), periodic along x, in the frame in which the lower wall rests. The upper wall
is a side of the box and moves along itself with speed U. In the differences of second order, with the wall
half a spacing above the last velocities, that is the force 2 nu U / h^2 on these; nothing is convected
through a wall. The lower wall is immersed: points a spacing apart, forced to rest as the rim of a disc is
(immersed_boundary_discs.py), RETRACTION spacings beneath the wall. The delta function spreads the force of a
point, and again the velocity that it sees, over a standard deviation of 0.54 spacings: where the fluid is
sheared on one side of a wall alone, its velocity as seen from there vanishes 0.3 spacings above the points.
The fluid beneath them takes part in the solution and has no meaning. Points in the lowest row of cells are
left out: there the side of the box, at rest as well, stands for the wall.
Steps are half as long as in immersed_boundary_run.py, because the forces and the pressure of the step before
lag behind a disc that is carried along: in a Couette flow of speed 1 m/s, 18 um deep, a disc of 2 um and of
the fluid's density on four cells drifts from the middle at 2.4e-3 m/s with COURANT 0.5, 4e-4 m/s with 0.125.
Shear on the upper wall: eta du/dy from the wall's speed and the two velocities beneath, of second order.
"""

import math
from dataclasses import dataclass

import numpy as np

from reference.base import Array, ReferenceError
from reference.immersed_boundary_discs import ITERATIONS, RELAXATION, Contact, Disc, Discs, Points
from reference.immersed_boundary_flow import Flow, Grid
from reference.immersed_boundary_run import CONTACT_CELLS, sampled, steps_left
from reference.scene import Scene
from reference.walls import Graph, graph

RETRACTION = 0.3  # spacings
GAP_CELLS, DISC_CELLS = 30, 10  # of the finest grid to the least gap and to the disc's diameter
COURANT = 0.25
CURVE_POINTS = 20  # to a spacing, along the wall, where its length and its distance are measured


class Channel:
    """A scene as this method needs it; its lower left corner is the origin. ReferenceError for others."""

    def __init__(self, scene: Scene):
        self.scene, self.size = scene, scene.size
        if scene.periodic != "x" or len(scene.walls) != 2 or len(scene.discs) > 1 or scene.dry:
            raise scene.refuse("a channel is periodic in x and has fluid, two walls and one disc or none")
        if scene.body_force != (0.0, 0.0) or scene.start_velocity != "rest":
            raise scene.refuse("the fluid of a channel starts at rest, without a body force")
        self.lower, self.upper = self._walls()
        self.speed = self.upper.wall.velocity[0]
        self.disc = self._disc()
        x, y = self.curve(4096)
        self.gap = float(self.size[1] - y.max())
        self.since = self.gap**2 / scene.kinematic_viscosity  # s, when the start is felt across the gap
        if y.min() < 0 or self.gap <= 0 or self.speed == 0:
            raise scene.refuse("the lower wall must lie in the domain, the upper one must move along itself")

    def _walls(self) -> tuple[Graph, Graph]:
        scene = self.scene
        walls = sorted(scene.walls, key=lambda wall: wall.fluid_side)
        if [wall.fluid_side for wall in walls] != ["above", "below"]:
            raise scene.refuse("a channel has its fluid above one wall and below the other")
        lower, upper = (graph(scene, wall) for wall in walls)
        height = upper.height(np.zeros(1))[0]
        if not upper.flat or abs(height - scene.upper[1]) > 1e-9 * self.size[1]:
            raise scene.refuse("the upper wall of a channel is the line along the upper side of the domain")
        if lower.wall.velocity != (0.0, 0.0) or upper.wall.velocity[1] != 0:
            raise scene.refuse("the lower wall of a channel rests, the upper one moves along x")
        return lower, upper

    def _disc(self) -> Disc | None:
        for disc in self.scene.discs:
            place = (disc.position[0] - self.scene.lower[0], disc.position[1] - self.scene.lower[1])
            free = disc.motion == "free"
            return Disc(disc.radius, disc.density, place, disc.velocity, disc.spin, free)
        return None

    def curve(self, count: int) -> tuple[Array, Array]:
        """x and y (count + 1,) of the lower wall, m, from one side of the domain to the other."""
        x = np.linspace(0, self.size[0], count + 1)
        return x, self.lower.height(x + self.scene.lower[0]) - self.scene.lower[1]

    def grid(self, share: float) -> Grid:
        """A grid with that share of the finest's cells along an axis."""
        spacing = self.gap / GAP_CELLS
        if self.disc:
            spacing = min(spacing, 2 * self.disc.radius / DISC_CELLS)
        cells = round(share * self.size[0] / spacing), round(share * self.size[1] / spacing)
        return Grid(cells, self.size, (True, False))

    def points(self, grid: Grid) -> Points:
        """Of the lower wall."""
        spacing = math.sqrt(grid.spacing[0] * grid.spacing[1])
        x, y = self.curve(CURVE_POINTS * grid.cells[0])
        along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        count = round(along[-1] / spacing)
        x = np.interp((np.arange(count) + 0.5) * along[-1] / count, along, x)
        place = x + self.scene.lower[0]
        slope = self.lower.slope(place)
        into_wall = np.column_stack([slope, -np.ones(count)]) / np.hypot(slope, 1)[:, None]
        places = np.column_stack([x, self.lower.height(place) - self.scene.lower[1]])
        places += RETRACTION * spacing * into_wall
        places = places[places[:, 1] > grid.spacing[1]]
        return Points(grid, places, np.full(len(places), along[-1] / count * spacing))

    def clearance(self, places: Array) -> float:
        """The least distance (m) of the disc's rim from a wall, for centres (n, 2), m."""
        wall = np.column_stack(self.curve(4096))
        apart = places[:, None] - wall[None]
        apart[..., 0] -= self.size[0] * np.round(apart[..., 0] / self.size[0])
        nearest = min(np.hypot(*np.moveaxis(apart, 2, 0)).min(), (self.size[1] - places[:, 1]).min())
        return float(nearest) - (self.disc.radius if self.disc else 0.0)


class ChannelFlow(Flow):
    """A flow whose upper side moves, and which is at rest at the points of a wall."""

    def __init__(self, grid: Grid, viscosity: float, speed: float, wall: Points):
        super().__init__(grid, viscosity)
        self.speed, self.wall = speed, wall
        self._push = np.zeros_like(wall.places)  # of the points on the fluid, m/s2

    def predicted(self, step: float, force: list[Array]) -> list[Array]:
        """Flow.predicted, at rest at the points. No disc may be within three spacings of them."""
        force = [field.copy() for field in force]
        force[0][:, -1] += 2 * self.viscosity * self.speed / self.grid.spacing[1] ** 2
        self.wall.spread(self._push, force)
        velocity = super().predicted(step, force)
        for _ in range(ITERATIONS):
            change = -RELAXATION * self.wall.interpolated(velocity)
            self.wall.spread(change, velocity)
            self._push += change / step
        return velocity

    def upper_slope(self) -> Array:
        """du/dy on the upper side at the places of u (nx,), 1/s."""
        u = self.velocity[0]
        return (8 * self.speed - 9 * u[:, -1] + u[:, -2]) / (3 * self.grid.spacing[1])


@dataclass(frozen=True)
class Passage:
    """Samples at times (n,): the greatest |shear| on the upper wall, Pa; the disc (n, 6)."""

    shear: Array
    states: Array  # x, y (m), angle (rad), velocity (m/s), spin (rad/s); zeros without a disc


def run(channel: Channel, grid: Grid, times: Array) -> Passage:
    """From rest at times[0] = 0 to times[-1] (s). Raises ReferenceError when the run breaks down."""
    scene, end = channel.scene, float(times[-1])
    flow = ChannelFlow(grid, scene.kinematic_viscosity, channel.speed, channel.points(grid))
    discs, still = None, [np.zeros_like(field) for field in flow.velocity]
    if channel.disc:
        contact = Contact(np.array([channel.disc.radius]), grid, CONTACT_CELLS * max(grid.spacing), 0.0)
        discs = Discs(flow, scene.density, (channel.disc,), scene.gravity, contact)
    now, stamps, shear, states = 0.0, [], [], []
    while True:
        stamps.append(now)
        shear.append(scene.dynamic_viscosity * np.abs(flow.upper_slope()).max())
        states.append(np.hstack((discs.place, discs.velocity)) if discs else np.zeros((1, 6)))
        if not (np.isfinite(shear[-1]) and np.isfinite(states[-1]).all()):
            raise ReferenceError(f"channel on {grid.cells} cells: the run broke down at {now:.4g} s")
        if now >= end:
            break
        left = steps_left(flow, abs(channel.speed), end - now, len(stamps), COURANT)
        step = (end - now) / left
        if discs:
            discs.step(step)
        else:
            flow.project(flow.predicted(step, still), step)
        now = end if left == 1 else now + step
    found = sampled(np.array(stamps), np.array(states), times)
    return Passage(np.interp(times, stamps, shear), found[:, 0])
