"""Writes the heights of a scene's wall as a table, as a profilometer gives them: for shape = "profile".

python -m reference.rough_profile SCENE WALL [--points N] [--set KEY=VALUE...] --out FILE
"""

import argparse
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from reference.base import ReferenceError
from reference.scene import Scene, read_scene
from reference.walls import graph


def table(scene: Scene, wall: str, points: int) -> str:
    """CSV of x and y in m: `points` even intervals over the domain, both ends included, to 0.1 nm."""
    found = next((candidate for candidate in scene.walls if candidate.name == wall), None)
    if found is None:
        raise scene.refuse(f"no wall {wall!r}, only {', '.join(w.name for w in scene.walls)}")
    x = np.linspace(scene.lower[0], scene.upper[0], points + 1)
    rows = zip(x, graph(scene, found).height(x), strict=True)
    parameters = ", ".join(f"{key} = {value}" for key, value in found.parameters.items())
    head = f"# synthetic, not measured: reference/rough_profile.py, {found.shape}, {parameters}\n"
    return head + "# x (m), y (m)\n" + "".join(f"{at:.4e}, {round(height, 10):.4e}\n" for at, height in rows)


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m reference.rough_profile", description=__doc__.splitlines()[0]
    )
    parser.add_argument("scene", type=Path)
    parser.add_argument("wall")
    parser.add_argument("--points", type=int, default=80, help="intervals (default: %(default)s)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="of the scene")
    parser.add_argument("--out", type=Path, required=True)
    options = parser.parse_args(argv)
    try:
        pairs = (item.split("=", 1) for item in options.set)
        overrides = {key: tomllib.loads(f"value = {value}")["value"] for key, value in pairs}
        text = table(read_scene(options.scene, overrides), options.wall, options.points)
        part = options.out.with_name(options.out.name + ".part")
        part.write_text(text)
        part.replace(options.out)
    except (ReferenceError, OSError, ValueError) as error:
        print(f"rough_profile: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
