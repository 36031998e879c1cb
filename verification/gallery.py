"""The report's front: a small picture of each case, and one sentence on what it is held against and how well.

The number is of the quantity that checks.toml names as `headline`, else of its first check: the largest error
for its tolerance over the variants and times, at the finest spacing.
"""

from __future__ import annotations

import io
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from PIL import Image

from verification.case import HARD, ROOT, CaseError, load_case
from verification.page import Card, Picture
from verification.results import standing
from verification.units import text

SIZE = (500, 320)  # of a small picture, pixels: twice what is shown, for dense screens
VERDICTS = {"failed": "FAILED.", "known": "A known shortfall.", "reported": "Only reported.", "passed": ""}


def title(case: str) -> str:
    """The heading of the case's README, or its name in words."""
    for folder in (ROOT / case, ROOT / HARD / case):
        if (readme := folder / "README.md").exists():
            return readme.read_text().splitlines()[0].removeprefix("# ")
    return case.replace("_", " ").capitalize()


def worst(checks: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """The check with the largest error for its tolerance; one without an error is worse than any."""

    def size(check: dict[str, Any]) -> float:
        return math.inf if check["value"] is None else check["value"] / check["tolerance"]

    return max(checks, key=size)


def sentence(case: str, entries: Sequence[dict[str, Any]]) -> tuple[str, str]:
    """What the case's headline check is held against and how well, and the check's standing."""
    data = load_case(case).data
    quantities = [check["quantity"] for check in data["checks"]]
    quantity = data.get("headline", quantities[0])
    if quantity not in quantities:
        raise CaseError(f"{case}: the headline {quantity} is the quantity of no check")
    finest = [entry for entry in entries if entry["finest"]]
    finest = [entry for entry in finest if entry["scheme"] == "default"] or finest
    checks = [check for entry in finest for check in entry["checks"]]
    found = [check for check in checks if check["quantity"].split(" at ")[0] == quantity]
    name = quantity.replace("_", " ").capitalize()
    if not found:
        return f"{name} was not measured.", "failed"
    check = worst([check for check in found if not check["reported"]] or found)
    off = "no finite error" if check["value"] is None else f"{_amount(check['value'], check['unit'])} off"
    against = re.sub(r" \([^()]*\d{4}[^()]*\)$|^.* of (?=data/)", "", check["source"])  # no keys, no columns
    runs = f" in the worst of {len(found)}" if len(found) > 1 else ""
    allowed = _amount(check["tolerance"], check["unit"])
    words = f"{name}, held against {against}: {off}{runs}, {allowed} is allowed."
    return f"{words} {VERDICTS[standing(check)]}".strip(), standing(check)


def _amount(value: float, unit: str) -> str:
    return text(value, unit) if unit else f"{100 * value:.3g} %"


def small(picture: Path) -> bytes:
    """The picture as a PNG that is at most SIZE."""
    out = io.BytesIO()
    with Image.open(picture) as image:
        image.thumbnail(SIZE)
        image.save(out, "png")
    return out.getvalue()


def cards(results: dict[str, Any], pictures: Sequence[Picture]) -> list[Card]:
    """A card for every case with a picture of its own, in the order of the results."""
    found = []
    for name in dict.fromkeys(entry["case"] for entry in results["cases"]):
        mine = [picture for picture in pictures if picture.case == name]
        if mine:
            entries = [entry for entry in results["cases"] if entry["case"] == name]
            words, verdict = sentence(name, entries)
            found.append(Card(title(name), words, verdict, small(mine[0].path)))
    return found
