"""Files that appear whole or not at all."""

from __future__ import annotations

import io
import json
import os
import tempfile
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure


def write_whole(path: Path, content: str | bytes) -> None:
    """Writes beside `path` and renames; whatever interrupts it leaves the old file or none."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    part = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content.encode() if isinstance(content, str) else content)
        part.chmod(0o644)
        part.replace(path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def write_json(path: Path, content: Any) -> None:
    """Raises ValueError, and writes nothing, for a number that is not finite."""
    write_whole(path, json.dumps(content, indent=1, allow_nan=False) + "\n")


def write_figure(path: Path, figure: Figure) -> None:
    image = io.BytesIO()
    figure.savefig(image, format="png")
    write_whole(path, image.getvalue())
