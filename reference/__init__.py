"""Reference solutions to hold the solver against, read from the same scene files.

`load` is all that a comparison needs; the modules' docstrings give equations, discretisation, convergence.
"""

import importlib
from collections.abc import Mapping
from pathlib import Path

from reference.base import Reference, ReferenceError
from reference.scene import read_scene

NAMES = ("start_up_couette", "start_up_poiseuille", "taylor_green", "channel_navier_stokes")

__all__ = ["NAMES", "Reference", "ReferenceError", "load"]


def load(name: str, scene_path: Path, overrides: Mapping[str, object], cache: Path) -> Reference:
    """The reference `name` of a scene, from `cache` where it was made before, made (and kept) otherwise.

    `overrides` maps addresses such as `walls.wafer.velocity` to values, as `slurry run --set` does.
    Raises ReferenceError for an unknown name, a scene outside the reference's reach or a damaged stored file.
    """
    if name not in NAMES:
        raise ReferenceError(f"no reference {name!r}; there are {', '.join(NAMES)}")
    module = importlib.import_module(f"reference.{name}")
    return module.create(read_scene(Path(scene_path), overrides), Path(cache))
