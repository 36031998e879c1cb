"""Reference solutions to hold the solver against, read from the same scene files.

`load` is all that a comparison needs; the modules' docstrings give equations, discretisation, convergence.
"""

import importlib
from collections.abc import Mapping
from pathlib import Path

from reference.base import Reference, ReferenceError
from reference.scene import read_scene

WITH_DISCS = (
    "added_mass", "disc_near_wall", "free_flight", "immersed_boundary", "immersed_channel", "rotating_disc",
)  # fmt: skip
FLOWS = ("start_up_couette", "start_up_poiseuille", "taylor_green", "channel_navier_stokes", "moving_channel")
NAMES = (*FLOWS, *WITH_DISCS)

__all__ = ["NAMES", "Reference", "ReferenceError", "load"]


def load(name: str, scene_path: Path, overrides: Mapping[str, object], cache: Path) -> Reference:
    """The reference `name` of a scene, from `cache` where it was made before, made (and kept) otherwise.

    `overrides` maps addresses such as `walls.wafer.velocity` to values, as `slurry run --set` does.
    Raises ReferenceError for an unknown name, a scene outside the reference's reach or a damaged stored file.
    """
    if name not in NAMES:
        raise ReferenceError(f"no reference {name!r}; there are {', '.join(NAMES)}")
    scene = read_scene(Path(scene_path), overrides)
    if name not in WITH_DISCS and (scene.discs or scene.gravity != (0.0, 0.0) or scene.dry):
        raise scene.refuse(f"{name} is a flow without discs and gravity")
    return importlib.import_module(f"reference.{name}").create(scene, Path(cache))
