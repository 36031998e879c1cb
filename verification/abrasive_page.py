"""How F_tau depends on the rule, the run's length and the spacing, for verification/abrasives/README.md.

`make claims` writes these tables, from the abrasives.json of verification/abrasive_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from verification.page import Table


def _with_interval(found: Sequence[float]) -> str:
    return "{:.2f} ({:.2f} to {:.2f})".format(*found) if len(found) > 1 else f"{found[0]:.2f}"


def _decisive(row: Mapping[str, Any]) -> list[str]:
    """The cells of one band that decide claims; the reason in the first where it decides nothing."""
    if "result" not in row:
        return [row["reason"], "", "", "", ""]
    result = row["result"]
    slopes = (result["slope_before_per_percent"], result["slope_after_per_percent"])
    best = result["models_before"][0]["model"]
    return [f"{result['rise']['p']:.1g}", _with_interval(result["exponent_before"]), best,
            *map(_with_interval, slopes)]  # fmt: skip


def band_table(found: Mapping[str, Any]) -> Table:
    """By every band: F_tau, and what decides the claims on it, with 95 % intervals."""
    counts = list(found["bands"][0]["means"])
    rows = []
    for row in found["bands"]:
        noise = ", within the noise" if row["within_noise"] else ""
        means = [f"{row['means'][count]:.2f}" for count in counts]
        rows.append(("", (f"{100 * row['band']:g} %{noise}", *means, *_decisive(row))))
    head = ("band", *(f"F_tau({count})" for count in counts), "p of the rise", "exponent up to 5 %",
            "best up to 5 % by AIC", "slope up to 5 %, per %", "slope from there on, per %")  # fmt: skip
    return Table(head, rows)


def convergence_table(found: Mapping[str, Any]) -> Table:
    """F_tau by the rule over the first and the second half of the time, and at the spacings."""
    halves, pairs = found["halves"], list(found["spacings"].values())
    head = ["discs", "first half of the time", "second half"]
    last = [
        "all",
        "second less first",
        _with_interval((halves["later_less_earlier"], *(halves["interval"] or ()))),
    ]
    for pair in pairs:
        head += [f"at {spacing:g} m" for spacing in pair["spacings_m"]]
        last += ["finer less coarser", _with_interval((pair["mean_difference"], *(pair["interval"] or ())))]
    rows = []
    for count, means in halves["rows"].items():
        cells = [f"{mean:.2f}" for mean in means]
        for pair in pairs:
            mine = [key[0] == int(count) for key in pair["members"]]
            cells += [f"{np.mean(np.array(pair[key])[mine]):.2f}" for key in ("coarse", "fine")]
        rows.append(("", (f"{count}", *cells)))
    return Table(head, [*rows, ("", last)])


def page(found: Mapping[str, Any]) -> str:
    """Both tables as Markdown, from what verification/abrasive_report.py writes."""
    rule, members = found["result"]["rule"], [r["members"] for r in found["result"]["rows"] if r["count"]]
    each = f"{members[0]}" if len(set(members)) == 1 else f"{min(members)} to {max(members)}"
    bands = (
        f"By every band ({each} members for each number of discs, spacing {found['spacing_m']:g} m, 95 % "
        "intervals; exponents are sought up to 1.8):"
    )
    rest = f"By a band of {100 * rule['band']:g} %, over time and at other spacings:"
    parts = (bands, band_table(found).markdown(), rest, convergence_table(found).markdown())
    return "\n\n".join(part.strip() for part in parts)
