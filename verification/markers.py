"""Generated parts of a page: what stands between `<!-- NAME:begin -->` and `<!-- NAME:end -->`."""

from __future__ import annotations

from pathlib import Path


def replace_between(page: Path, name: str, text: str) -> None:
    """Writes the text between the markers of that name; ValueError when the page does not have both once."""
    begin, end = f"<!-- {name}:begin -->", f"<!-- {name}:end -->"
    whole = page.read_text()
    if whole.count(begin) != 1 or whole.count(end) != 1 or whole.index(begin) > whole.index(end):
        raise ValueError(f"{page.name}: needs {begin} and {end}, once each and in this order")
    before, rest = whole.split(begin)
    part = page.with_name(page.name + ".part")
    part.write_text(f"{before}{begin}\n{text}\n{end}{rest.split(end)[1]}")
    part.replace(page)
