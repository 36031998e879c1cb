"""The physics of a scene file, as a reference needs it: domain, fluid, walls, discs, start; no numerics.

The solver validates a scene as a whole. Here only the tables read are checked, so that a misspelt key or
override can never be left out of a reference in silence.
"""

import math
import tomllib
from collections.abc import Mapping
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from reference.base import ReferenceError

REQUIRED = object()
SHAPES = {  # wall shapes: parameter -> length of its vector (0 = a number)
    "line": {"from": 2, "to": 2},
    "cosine": {"mean_height": 0, "amplitude": 0, "wavelength": 0, "crest": 0},
    "gaussian": {"base_height": 0, "amplitude": 0, "centre": 0, "width": 0},
    "arc": {"base_height": 0, "centre": 0, "radius": 0, "angle": 0},
    "sine": {"base_height": 0, "amplitude": 0, "centre": 0, "length": 0},
    "profile": {"base_height": 0},
    "random": {"mean_height": 0, "rms_height": 0, "correlation_length": 0, "seed": 0},
}
SHAPE_DEFAULTS = {("cosine", "crest"): 0.0, ("profile", "base_height"): 0.0, ("random", "seed"): 1}


@dataclass(frozen=True)
class WallScene:
    name: str
    shape: str
    parameters: dict[str, object]  # of the shape, SI; a profile's points in full
    fluid_side: str
    velocity: tuple[float, float]  # m/s


@dataclass(frozen=True)
class DiscScene:
    name: str
    radius: float  # m
    position: tuple[float, float]  # m, of the centre at time 0
    density: float  # kg/m3
    motion: str  # "free", "fixed" or "prescribed"
    velocity: tuple[float, float]  # m/s, at time 0, or always when prescribed
    spin: float  # rad/s anticlockwise, likewise


@dataclass(frozen=True)
class Scene:
    path: Path
    end_time: float  # s
    lower: tuple[float, float]  # m
    upper: tuple[float, float]  # m
    periodic: str
    density: float  # kg/m3
    dynamic_viscosity: float  # Pa s
    body_force: tuple[float, float]  # m/s2
    gravity: tuple[float, float]  # m/s2
    hydrostatics: str
    walls: tuple[WallScene, ...]
    discs: tuple[DiscScene, ...]
    start_velocity: str
    start_speed: float  # m/s
    dry: bool  # no fluid, discs alone

    @property
    def size(self) -> tuple[float, float]:
        return self.upper[0] - self.lower[0], self.upper[1] - self.lower[1]

    @property
    def kinematic_viscosity(self) -> float:
        return self.dynamic_viscosity / self.density

    def disc(self, name: str) -> DiscScene:
        """Raises ReferenceError when there is no disc of that name."""
        for disc in self.discs:
            if disc.name == name:
                return disc
        raise self.refuse(f"no disc {name!r}, only {', '.join(disc.name for disc in self.discs) or 'none'}")

    def refuse(self, reason: str) -> ReferenceError:
        return ReferenceError(f"{self.path}: {reason}")

    def flow(self) -> dict[str, object]:
        """Everything a flow between walls and discs depends on: a reference's identity is made from it."""
        walls = {
            wall.name: [wall.shape, wall.parameters, wall.fluid_side, wall.velocity] for wall in self.walls
        }
        discs = {disc.name: list(astuple(disc)[1:]) for disc in self.discs}
        fluid = [self.density, self.dynamic_viscosity, self.body_force, self.gravity, self.hydrostatics]
        domain = [self.lower, self.upper, self.periodic]
        return {"domain": domain, "fluid": fluid, "walls": walls, "discs": discs}


class _Table:
    """One table of the file, its keys taken one by one; `close` refuses what nobody took."""

    def __init__(self, path: Path, name: str, content: object):
        if not isinstance(content, dict):
            raise ReferenceError(f"{path}: {name} must be a table")
        self.path, self.name, self.content = path, name, dict(content)

    def take(self, key: str, default: object = REQUIRED) -> object:
        if key not in self.content and default is REQUIRED:
            raise ReferenceError(f"{self.path}: {self.name}.{key} is missing")
        return self.content.pop(key, default)

    def number(self, key: str, default: object = REQUIRED, positive: bool = False) -> float:
        value = self.take(key, default)
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise ReferenceError(f"{self.path}: {self.name}.{key} = {value!r} must be a finite number")
        if positive and value <= 0:
            raise ReferenceError(f"{self.path}: {self.name}.{key} = {value!r} must be positive")
        return float(value)

    def vector(self, key: str, default: object = REQUIRED) -> tuple[float, float]:
        value = self.take(key, default)
        if not isinstance(value, list | tuple) or len(value) != 2:
            raise ReferenceError(f"{self.path}: {self.name}.{key} = {value!r} must be two numbers")
        pair = _Table(self.path, self.name, {f"{key}[{i}]": value[i] for i in range(2)})
        return pair.number(f"{key}[0]"), pair.number(f"{key}[1]")

    def choice(self, key: str, allowed: tuple[str, ...], default: object = REQUIRED) -> str:
        value = self.take(key, default)
        if value not in allowed:
            found = f"{self.path}: {self.name}.{key} = {value!r}"
            raise ReferenceError(f"{found} must be one of {', '.join(allowed)}")
        return str(value)

    def flag(self, key: str) -> bool:
        value = self.take(key)
        if not isinstance(value, bool):
            raise ReferenceError(f"{self.path}: {self.name}.{key} = {value!r} must be true or false")
        return value

    def close(self) -> None:
        for key in self.content:
            raise ReferenceError(f"{self.path}: {self.name}.{key} is not a key of a scene")


def flatten(overrides: Mapping[str, object], prefix: str = "") -> dict[str, object]:
    """Nested tables of overrides as dotted addresses."""
    flat: dict[str, object] = {}
    for key, value in overrides.items():
        if isinstance(value, Mapping):
            flat.update(flatten(value, f"{prefix}{key}."))
        else:
            flat[f"{prefix}{key}"] = value
    return flat


def override(tables: dict, address: str, value: object, path: Path) -> None:
    """Sets one value; entries of an array of tables are addressed by name (`walls.wafer.velocity`)."""
    *parents, key = address.split(".")
    node: object = tables
    for part in parents:
        if isinstance(node, list):
            names = [entry.get("name") for entry in node]
            if part not in names:
                known = ", ".join(map(str, names))
                raise ReferenceError(f"{path}: {address}: no {part!r} here, only {known}")
            node = node[names.index(part)]
        else:
            node = node.setdefault(part, {})
        if not isinstance(node, dict | list):
            raise ReferenceError(f"{path}: {address}: {part!r} is a value, not a table")
    if not isinstance(node, dict) or not key:
        raise ReferenceError(f"{path}: {address}: a name and a key must follow an array of tables")
    node[key] = value


def _profile_points(file: Path) -> list[list[float]]:
    try:
        points = np.loadtxt(file, delimiter=",", comments="#", ndmin=2)
    except (OSError, ValueError) as error:
        raise ReferenceError(f"{file}: not a readable profile: {error}") from error
    if points.shape[0] < 4 or points.shape[1] != 2 or not np.isfinite(points).all():
        raise ReferenceError(f"{file}: a profile is at least four rows of two finite numbers")
    if not (np.diff(points[:, 0]) > 0).all():
        raise ReferenceError(f"{file}: the first column of a profile must increase")
    return points.tolist()


def _read_wall(path: Path, content: object, number: int) -> WallScene:
    table = _Table(path, f"walls[{number}]", content)
    name = str(table.take("name"))
    table.name = f"walls.{name}"
    shape = table.choice("shape", tuple(SHAPES))
    parameters: dict[str, object] = {}
    for key, length in SHAPES[shape].items():
        default = SHAPE_DEFAULTS.get((shape, key), REQUIRED)
        parameters[key] = table.vector(key, default) if length else table.number(key, default)
    if shape == "arc":
        parameters["upward"] = table.flag("upward")
    if shape == "profile":
        parameters["points"] = _profile_points(path.parent / str(table.take("file")))
    side = table.choice("fluid_side", ("above", "below", "left", "right"))
    wall = WallScene(name, shape, parameters, side, table.vector("velocity", (0.0, 0.0)))
    table.close()
    return wall


def _read_disc(path: Path, content: object, number: int) -> DiscScene:
    table = _Table(path, f"discs[{number}]", content)
    name = str(table.take("name"))
    table.name = f"discs.{name}"
    table.choice("placement", ("single",))  # where the solver puts the others is not in the scene
    disc = DiscScene(
        name=name,
        radius=table.number("radius", positive=True),
        position=table.vector("position"),
        density=table.number("density", positive=True),
        motion=table.choice("motion", ("free", "fixed", "prescribed"), "free"),
        velocity=table.vector("velocity", (0.0, 0.0)),
        spin=table.number("spin", 0.0),
    )
    table.close()
    return disc


def read_scene(path: Path, overrides: Mapping[str, object]) -> Scene:
    """Raises ReferenceError: a file that cannot be read, a key missing, unknown or of the wrong type."""
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ReferenceError(f"{path}: not a readable scene: {error}") from error
    for address, value in flatten(overrides).items():
        override(tables, address, value, path)
    return scene_of(path, tables)


def scene_of(path: Path, tables: Mapping[str, Any]) -> Scene:
    """The scene of a file's content; ReferenceError as for read_scene."""
    domain = _Table(path, "domain", tables.get("domain", {}))
    fluid = _Table(path, "fluid", tables.get("fluid", {}))
    start = _Table(path, "start", tables.get("start", {}))
    scene = Scene(
        path=path,
        end_time=_Table(path, "output", tables.get("output", {})).number("end_time", 0.0),
        lower=domain.vector("lower"),
        upper=domain.vector("upper"),
        periodic=domain.choice("periodic", ("none", "x", "y", "xy"), "none"),
        density=fluid.number("density", positive=True),
        dynamic_viscosity=fluid.number("dynamic_viscosity", positive=True),
        body_force=fluid.vector("body_force", (0.0, 0.0)),
        gravity=fluid.vector("gravity", (0.0, 0.0)),
        hydrostatics=fluid.choice("hydrostatics", ("buoyancy", "full"), "buoyancy"),
        walls=tuple(_read_wall(path, wall, i) for i, wall in enumerate(tables.get("walls", []))),
        discs=tuple(_read_disc(path, disc, i) for i, disc in enumerate(tables.get("discs", []))),
        start_velocity=start.choice("velocity", ("rest", "shear", "taylor_green"), "rest"),
        start_speed=start.number("speed", 0.0),
        dry=start.take("arrangement", "lattice") == "empty",
    )
    domain.close()
    fluid.close()
    if min(scene.size) <= 0:
        raise scene.refuse("domain.upper must exceed domain.lower")
    return scene
