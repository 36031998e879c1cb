"""A movie of a run, from its snapshots: a field, walls and discs; MP4 where ffmpeg is installed, else GIF.

`python -m verification.movie RUN`, or `make movie RUN=FOLDER FIELD=pressure`, reads RUN/result.h5 and writes
RUN/FIELD.mp4 or RUN/FIELD.gif. The run needs many snapshots: `--set output.snapshot_times=[...]`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from matplotlib import animation
from matplotlib.figure import Figure

from verification.compare import DataError
from verification.measure import Result, open_run, unended_since
from verification.picture import FIELDS, bounds, draw, limit_of
from verification.units import label, text

FEWEST_FRAMES = 2
LONGER_SIDE = 8  # of the domain in the picture, inches


def write(result: Result, out: Path, rate: int, field: str = "vorticity") -> int:
    """Writes the movie at `rate` frames a second, whole or not at all; returns the number of frames.

    The colours suit the second half of it: a start may be beyond them.
    """
    times = result.snapshot_times()
    if len(times) < FEWEST_FRAMES:
        raise DataError("a movie needs snapshots: slurry run ... --set output.snapshot_times=[0.01,0.02,...]")
    lower, upper = bounds(result)
    width, height = LONGER_SIDE * (upper - lower) / (upper - lower).max()
    figure = Figure(figsize=(width + 2, height + 1), layout="compressed")
    axes = figure.subplots()
    limit = limit_of(result, times[len(times) // 2 :], field)
    shown = FIELDS[field]
    bar = figure.colorbar(draw(axes, result, times[-1], field, limit), ax=axes, extend=shown.beyond)
    label(bar.ax.yaxis, shown.name, shown.unit)
    axes.set_title("t")  # room for the title
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # what is drawn must not move from frame to frame

    def frame(index: int) -> list:
        axes.clear()
        dots = draw(axes, result, times[index], field, limit)
        axes.set_title(f"t = {text(times[index], 's')}")
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
    parser.add_argument("--field", choices=FIELDS, default="vorticity", help="what is shown (%(default)s)")
    parser.add_argument("--rate", type=int, default=25, help="frames a second (%(default)s)")
    options = parser.parse_args(argv)
    suffix = ".mp4" if animation.FFMpegWriter.isAvailable() else ".gif"
    folder = options.run if options.run.is_dir() else options.run.parent
    out = options.out or folder / f"{options.field}{suffix}"
    if out.suffix not in (".mp4", ".gif") or (out.suffix == ".mp4" and suffix != ".mp4"):
        print(f"movie: {out.name}: a movie is .gif, or .mp4 where ffmpeg is installed", file=sys.stderr)
        return 2
    try:
        result = open_run(options.run)
        for reason in unended_since(result.path):
            print(f"movie: warning: {reason}", file=sys.stderr)
        print(f"{out}: {write(result, out, options.rate, options.field)} frames")
    except (DataError, OSError) as error:
        print(f"movie: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
