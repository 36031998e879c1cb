"""Solutions stored in data/: rows of CSV under a header of JSON values with a checksum of the rows."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from reference.base import ReferenceError


def write_rows(
    file: Path, head: Sequence[str], columns: str, header: Mapping[str, object], body: str
) -> None:
    """The file appears whole or not at all; raises ReferenceError where it cannot be written."""
    sealed = {**header, "sha256": hashlib.sha256(body.encode()).hexdigest()}
    lines = [*head, *(f"# {key}: {json.dumps(value)}" for key, value in sealed.items()), columns]
    part = file.with_name(f"{file.name}.{os.getpid()}.part")
    try:
        try:
            part.write_text("\n".join(lines) + "\n" + body, encoding="utf-8")
            part.replace(file)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise ReferenceError(f"{file}: the reference cannot be stored: {error}") from error


def read_rows(file: Path, head: Sequence[str], columns: str) -> tuple[dict, list[list[str]], str]:
    """The header, the rows' cells and the file's digest; raises OSError, and ValueError for changed rows."""
    text = file.read_text(encoding="utf-8")
    above, body = text.split(f"{columns}\n")
    lines = [line.removeprefix("# ").split(": ", 1) for line in above.splitlines()[len(head) :]]
    header = {key: json.loads(value) for key, value in lines}
    if header["sha256"] != hashlib.sha256(body.encode()).hexdigest():
        raise ValueError("its rows do not have the checksum of its header")
    cells = [line.split(",") for line in body.splitlines()]
    return header, cells, hashlib.sha256(text.encode()).hexdigest()
