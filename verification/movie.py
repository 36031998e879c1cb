"""A movie of a run, from its snapshots: vorticity and discs; MP4 where ffmpeg is installed, else GIF.

`python -m verification.movie RUN` reads RUN/result.h5 and writes RUN/movie.mp4 or RUN/movie.gif. The run
needs many snapshots: `slurry run ... --set output.snapshot_times=[...]`.
"""

from __future__ import annotations

import argparse
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path

import h5py
import numpy as np
from matplotlib import animation
from matplotlib.figure import Figure

from verification.compare import DataError
from verification.measure import Result
from verification.picture import SHOWN, draw, vorticity

FEWEST_FRAMES = 2


def open_run(folder: Path) -> Result:
    """The result of a run, with the scene that it says it is of."""
    path = folder / "result.h5"
    try:
        with h5py.File(path, "r") as file:
            scene = tomllib.loads(str(file.attrs["scene"]))
    except (OSError, KeyError, tomllib.TOMLDecodeError) as error:
        raise DataError(f"{path} is not the result of a run: {error}") from error
    return Result(path, scene["output"]["end_time"], scene)


def write(result: Result, out: Path, rate: int) -> int:
    """Writes the movie at `rate` frames a second, whole or not at all; returns the number of frames."""
    times = result.snapshot_times()
    if len(times) < FEWEST_FRAMES:
        raise DataError("a movie needs snapshots: slurry run ... --set output.snapshot_times=[0.01,0.02,...]")
    size = np.subtract(result.scene["domain"]["upper"], result.scene["domain"]["lower"])
    width, height = 8 * size / size.max()
    figure = Figure(figsize=(width + 1.6, height + 0.8), layout="constrained")
    axes = figure.subplots()
    limit = float(np.quantile(np.abs(vorticity(result.particles(times[-1]))), SHOWN))
    figure.colorbar(draw(axes, result, times[-1], limit), ax=axes, label="vorticity (1/s)", shrink=0.7)

    def frame(index: int) -> list:
        axes.clear()
        dots = draw(axes, result, times[index], limit)
        axes.set(title=f"t = {times[index]:.3f} s", ylabel="y (m)")
        return [dots]

    part = out.with_name(f"part.{out.name}")
    writer = animation.FFMpegWriter(rate) if out.suffix == ".mp4" else animation.PillowWriter(rate)
    try:
        animation.FuncAnimation(figure, frame, frames=len(times)).save(part, writer, dpi=100)
        part.replace(out)
    finally:
        part.unlink(missing_ok=True)
    return len(times)


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m verification.movie", description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, metavar="RUN", help="the folder of a run, with its result.h5")
    parser.add_argument("--out", type=Path, help="movie file, .mp4 or .gif (default: in RUN)")
    parser.add_argument("--rate", type=int, default=25, help="frames a second (%(default)s)")
    options = parser.parse_args(argv)
    suffix = ".mp4" if animation.FFMpegWriter.isAvailable() else ".gif"
    out = options.out or options.run / f"movie{suffix}"
    if out.suffix not in (".mp4", ".gif") or (out.suffix == ".mp4" and suffix != ".mp4"):
        print(f"movie: {out.name}: a movie is .gif, or .mp4 where ffmpeg is installed", file=sys.stderr)
        return 2
    try:
        print(f"{out}: {write(open_run(options.run), out, options.rate)} frames")
    except (DataError, OSError) as error:
        print(f"movie: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
