"""plan.toml, with the tables of [quick] laid over it when asked for."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from verification.case import CaseError

PLAN = Path(__file__).resolve().parent / "plan.toml"


def load_plan(quick: bool, path: Path = PLAN) -> dict[str, Any]:
    """The plan of a bench; raises CaseError for a file that cannot be read or lays over what is not there."""
    try:
        plan = tomllib.loads(path.read_text())
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise CaseError(f"{path}: {error}") from error
    overlay = plan.pop("quick", {})
    return _merge(plan, overlay, path.name) if quick else plan


def _merge(plan: Mapping[str, Any], overlay: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Tables are merged, anything else is replaced; a table named more_... is replaced as a whole."""
    if unknown := overlay.keys() - plan.keys():
        raise CaseError(f"{where}: [quick] sets {', '.join(sorted(unknown))}, which the plan does not have")
    merged = dict(plan)
    for key, value in overlay.items():
        nested = isinstance(value, Mapping) and not key.startswith("more_")
        merged[key] = _merge(plan[key], value, where) if nested else value
    return merged
