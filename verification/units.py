"""Axes that a person can read: the multiple of a unit that suits the numbers, µm instead of 1e-06 m."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter

PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
PREFIXED = ("m", "m/s", "s", "Pa", "J", "J/m", "N", "N/m")  # units that are read with a prefix
PLAIN = (0.1, 1e4)  # between these a number is read as it is


def readable(unit: str, largest: float) -> tuple[float, str]:
    """The multiple of `unit` that suits values up to `largest`, and what it is called: (1e-6, "µm")."""
    name = "-" if unit in ("", "1") else unit
    if not 0 < largest < math.inf or PLAIN[0] <= largest < PLAIN[1]:
        return 1.0, name
    power = 3 * math.floor(math.log10(largest) / 3)
    if unit in PREFIXED and power in PREFIXES:
        return 10.0**power, PREFIXES[power] + unit
    rest = unit.removeprefix("1") if unit[:1] in ("", "1") else f" {unit}"  # "1/s" is read as 10^3/s
    return 10.0**power, rf"$10^{{{power}}}${rest}"


def text(value: float, unit: str) -> str:
    """A number with its unit: "45.6 µs"."""
    factor, name = readable(unit, abs(value))
    return f"{value / factor:.4g} {name}"


def label(axis: Axis, name: str, unit: str) -> None:
    """Names an axis whose data is in `unit`, and gives its ticks in what its limits are best read in.

    Without a name the axis has its unit alone.
    """
    factor, shown = readable(unit, float(np.abs(axis.get_view_interval()).max()))
    shorten = FuncFormatter(lambda value, _: f"{value / factor:.10g}".replace("-", "\N{MINUS SIGN}"))
    axis.set_major_formatter(shorten)
    axis.set_label_text(f"{name} ({shown})" if name else shown)
