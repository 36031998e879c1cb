"""The scene of moving_channel.py as a problem without dimensions, and the units that lead back."""

from dataclasses import dataclass

import numpy as np

from reference import walls
from reference.base import Array
from reference.moving_channel_flow import MovingProblem
from reference.scene import Scene
from reference.walls import Function, Graph

NAME = "moving_channel"
SHARP_KINK = 0.05  # smallest jump of slope that mesh lines crowd towards
WAVES = 12  # of the moving wall; LARGEST_SMOOTHING of the narrowest gap may be left out
LARGEST_SMOOTHING = 1e-3


@dataclass(frozen=True)
class Waves:
    """A periodic function as its first waves. What a feature's repetition leaves of a kink at half a period
    would go through the elements as noise: jumps of their volumes' rates, and of the pressure over the step.
    """

    coefficients: Array  # complex, of exp(2 pi i k (x - start) / length)
    start: float
    length: float

    @classmethod
    def through(cls, values: Array, start: float, length: float) -> "Waves":
        waves = np.fft.rfft(values)[: WAVES + 1] / len(values)
        waves[1:] *= 2
        return cls(waves, start, length)

    def _sum(self, coefficients: Array, x: Array) -> Array:
        turn = np.exp(2j * np.pi * (np.asarray(x, dtype=float) - self.start) / self.length)
        result = np.zeros(turn.shape, dtype=complex)
        for coefficient in coefficients[::-1]:
            result = result * turn + coefficient
        return result.real

    def height(self, x: Array) -> Array:
        return self._sum(self.coefficients, x)

    def slope(self, x: Array) -> Array:
        return self._sum(self.coefficients * 2j * np.pi * np.arange(WAVES + 1) / self.length, x)


class Units:
    """The scene as a MovingProblem, and the units that lead back."""

    def __init__(self, scene: Scene):
        self.scene = scene
        self.bottom, self.top = self._graphs()
        x = scene.lower[0] + scene.size[0] * (np.arange(4096) + 0.5) / 4096
        self.length = float((self.top.height(x) - self.bottom.height(x)).mean())
        self.highest = float(self.bottom.height(x).max())
        self.asperity = Waves.through(self.bottom.height(x), x[0], scene.size[0])
        if self.top.height(x).min() <= self.highest:
            raise scene.refuse(f"{NAME}: the walls collide as they move")
        narrowest = float(self.top.height(x).min()) - self.highest
        if np.abs(self.asperity.height(x) - self.bottom.height(x)).max() > LARGEST_SMOOTHING * narrowest:
            raise scene.refuse(f"{NAME}: the bottom has more than {WAVES} waves over the domain")
        self.velocity = self.bottom.wall.velocity[0]
        self.stress = scene.dynamic_viscosity * abs(self.velocity) / self.length
        self.period = scene.size[0] / abs(self.velocity)

    def _graphs(self) -> tuple[Graph, Graph]:
        scene = self.scene
        if scene.periodic != "x" or len(scene.walls) != 2 or scene.body_force != (0.0, 0.0):
            raise scene.refuse(f"{NAME} needs a domain periodic in x, exactly two walls and no body force")
        graphs = {wall.fluid_side: walls.graph(scene, wall) for wall in scene.walls}
        if len(graphs) != 2:
            raise scene.refuse(f"{NAME} needs one wall with the fluid above it and one with the fluid below")
        bottom, top = graphs["above"], graphs["below"]
        (along, up), still = bottom.wall.velocity, top.wall.velocity
        if still != (0.0, 0.0) or along == 0 or up != 0 or self._sharp(bottom):
            raise scene.refuse(f"{NAME} needs a top at rest, and a bottom without kinks that moves along x")
        return bottom, top

    def _sharp(self, graph: Graph) -> list[float]:
        return [x for x in graph.kinks if abs(self._jump(graph, x)) > SHARP_KINK]

    def _jump(self, graph: Graph, x: float) -> float:
        step = 1e-6 * self.scene.size[0]
        return float(graph.slope(x + step) - graph.slope(x - step))

    def problem(self) -> MovingProblem:
        unit = self.length

        def scaled(function: Function, by: float) -> Function:
            return lambda x: function(np.asarray(x) * unit) / by

        return MovingProblem(
            start=self.scene.lower[0] / unit,
            length=self.scene.size[0] / unit,
            bottom=scaled(self.asperity.height, unit),
            top=scaled(self.top.height, unit),
            bottom_slope=scaled(self.asperity.slope, 1.0),
            top_slope=scaled(self.top.slope, 1.0),
            highest=self.highest / unit,
            kinks=tuple((x / unit, self._jump(self.top, x) > 0) for x in self._sharp(self.top)),
            reynolds=abs(self.velocity) * unit / self.scene.kinematic_viscosity,
            direction=float(np.sign(self.velocity)),
        )

    def laboratory(self, x: Array, y: Array, phase: float) -> tuple[Array, Array]:
        """x and eta of points of the laboratory."""
        x = np.asarray(x, dtype=float)
        bottom = self.asperity.height(x - self.velocity * phase * self.period)
        return x, (np.asarray(y, dtype=float) - bottom) / (self.top.height(x) - bottom)

    def place(self, x: float, y: float, phase: float) -> tuple[Array, Array]:
        """The same of one point, as arrays and in the problem's units."""
        along, eta = self.laboratory(np.array([x]), np.array([y]), phase)
        if not -1e-9 <= eta[0] <= 1 + 1e-9:
            raise self.scene.refuse(f"{NAME}: ({x:g}, {y:g}) m is not in the fluid at {phase:g} T")
        return along / self.length, np.clip(eta, 0, 1)
