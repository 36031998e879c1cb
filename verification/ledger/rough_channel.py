"""Sec. 4.1.1 of the paper, the rough channel, and the numbers of particles of Sec. 4."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from verification.case import load_case
from verification.compare import Array, settled
from verification.ledger.evidence import (
    CORRECTED,
    FAILS,
    HOLDS,
    PAPER_SCHEME,
    Claim,
    Evidence,
    Finding,
    by_checks,
    percent,
)
from verification.measure import Result

CASE, FLAT, CURVED = "rough_channel", "top_wall_moves", "bottom_wall_moves"
WAFER = "wafer"
SATISFACTORY = 0.05  # of two fields or curves that a reader takes for the same
STEADY = 0.01  # of the last value
LONGER = 1.5  # times as long; the paper's two times differ by a factor of 2
POINTS = 400
DUMMY_LAYERS = 3  # of the paper's box, which is walled on all four sides


def agrees_with_fluent(evidence: Evidence) -> Finding:
    pressure, shear = (evidence.check(CASE, name, FLAT) for name in ("wafer_pressure", "wafer_shear"))
    written = [evidence.check(CASE, name, FLAT, PAPER_SCHEME) for name in ("wafer_pressure", "wafer_shear")]
    return by_checks(
        (pressure, shear),
        f"pressure within {percent(pressure)}, shear within {percent(shear)} (L2, {shear['spacing_m']:g} m); "
        f"by the paper's scheme as written {percent(written[0])} and {percent(written[1])}",
        f"steady Navier-Stokes by finite elements, {evidence.own_error(CASE)}",
        "the paper shows curves and no number",
    )


def whole_field(evidence: Evidence) -> Finding:
    ours = evidence.check(CASE, "pressure", FLAT)
    written = evidence.check(CASE, "pressure", FLAT, PAPER_SCHEME)
    close = [check["value"] is not None and check["value"] < SATISFACTORY for check in (ours, written)]
    return Finding(
        f"at every particle at one instant within {percent(ours)}; by the paper's scheme as written within "
        f"{percent(written)} (L2, {ours['spacing_m']:g} m)",
        f"steady Navier-Stokes by finite elements, {evidence.own_error(CASE)}",
        HOLDS if all(close) else CORRECTED if close[0] else FAILS,
        "the density of Eq. 2.14 is noisy from particle to particle, which a picture smooths; density "
        "diffusion takes the noise out",
    )


def either_wall(evidence: Evidence) -> Finding:
    names = ("wafer_pressure_of_variants", "wafer_shear_of_variants")
    pressure, shear = (evidence.check(CASE, name) for name in names)
    written = [evidence.check(CASE, name, FLAT, PAPER_SCHEME) for name in names]
    return by_checks(
        (pressure, shear),
        f"they differ by {percent(pressure)} in pressure and {percent(shear)} in shear (L2); by the paper's "
        f"scheme as written {percent(written[0])} and {percent(written[1])}",
        "the two are one flow seen from two frames",
        "the difference is an error of the particles, not a property of the flow",
    )


def lubrication(scene: dict[str, Any], x: Array) -> tuple[Array, Array]:
    """Pressure less its mean and shear on the wafer (Pa) at evenly spaced x by Reynolds' equation."""
    pad = next(wall for wall in scene["walls"] if wall["shape"] == "cosine")
    wave = np.cos(2 * np.pi * (x - pad["crest"]) / pad["wavelength"])
    gap = scene["domain"]["upper"][1] - pad["mean_height"] - pad["amplitude"] * wave
    speed = next(wall for wall in scene["walls"] if wall["name"] == WAFER)["velocity"][0]
    viscosity = scene["fluid"]["dynamic_viscosity"]
    carried = np.mean(gap**-2) / np.mean(gap**-3)  # twice the flow over the speed: p is periodic
    slope = 6 * viscosity * speed * (gap**-2 - carried * gap**-3)
    pressure = np.cumsum(slope) * (x[1] - x[0])
    return pressure - pressure.mean(), viscosity * speed / gap + gap * slope / 2


def reynolds_fails(evidence: Evidence) -> Finding:
    scene, truth = evidence.scene(CASE, FLAT), evidence.truth(CASE, FLAT)
    length = scene["domain"]["upper"][0]
    x = (np.arange(POINTS) + 0.5) * length / POINTS
    exact = [truth.wall_pressure(WAFER, x, 0.0), truth.wall_shear(WAFER, x, 0.0)]
    exact[0] = exact[0] - exact[0].mean()
    off = [
        float(np.linalg.norm(found - right) / np.linalg.norm(right))
        for found, right in zip(lubrication(scene, x), exact, strict=True)
    ]
    return Finding(
        "not needed",
        f"Reynolds' equation is off finite elements by {100 * off[0]:.2g} % in the wafer's pressure and "
        f"{100 * off[1]:.2g} % in its shear (L2), {evidence.own_error(CASE)}",
        HOLDS if max(off) > SATISFACTORY else FAILS,
        "no particles are needed to say so",
    )


def mesh_is_difficult(evidence: Evidence) -> Finding:
    steady = next(row for row in evidence.references(CASE) if row["variant"] == CURVED)
    moving = evidence.references("wafer_feature")
    worst = max(row["error_estimate"] for row in (steady, *moving))
    times = [row["seconds"] for row in moving]
    return Finding(
        "not needed",
        f"in the curved wall's frame finite elements need {steady['seconds']:.2g} s for an error of "
        f"{steady['error_estimate']:.1g}; on a mesh that moves with an asperity {min(times):.0f} to "
        f"{max(times):.0f} s for {max(row['error_estimate'] for row in moving):.1g} (Sec. 4.3)",
        FAILS if worst < SATISFACTORY else HOLDS,
        "both walls are graphs over x, so that the mesh moves in y alone; with discs it would be difficult",
    )


def steady_times(evidence: Evidence) -> Finding:
    flat, curved = (evidence.check(CASE, "kinetic_energy_steady", wall) for wall in (FLAT, CURVED))
    return by_checks(
        (flat, curved),
        f"the kinetic energy stays within {percent(flat)} (flat) and {percent(curved)} (curved) of its last",
        "none needed: the run's own last value",
        "the paper does not say how near to steady it means",
    )


def steady_from(times: Array, apart: Array) -> float:
    """The first of the times (n,) from which on `apart` (n,), 0 at the last, stays within STEADY; infinite
    for none before the last.
    """
    time = settled(times[:-1], apart[:-1], STEADY)
    return math.inf if math.isnan(time) else time


def starts(run: Result) -> tuple[float, float, float]:
    """When wafer pressure and kinetic energy become steady (s), and the largest change of density."""
    times, along, pressure = run.wall_samples(WAFER, "pressure")
    moving = {wall["name"]: wall.get("velocity", [0.0, 0.0])[0] for wall in run.scene["walls"]}
    pad = next(wall["name"] for wall in run.scene["walls"] if wall["shape"] != "line")
    length = run.scene["domain"]["upper"][0]
    # A probe's place is the wafer's at the start; the flow is steady as seen from the pad.
    seen = [
        np.interp(
            along, *ordered((along + (moving[WAFER] - moving[pad]) * time) % length, row), period=length
        )
        for time, row in zip(times, pressure, strict=True)
    ]
    seen = np.array([row - row.mean() for row in seen])
    apart = np.linalg.norm(seen - seen[-1], axis=1) / np.linalg.norm(seen[-1])
    stamps, energy = run.series("kinetic_energy")
    sound = float(run.series("largest_density_error")[1].max())
    return steady_from(times, apart), steady_from(stamps, np.abs(energy / energy[-1] - 1)), sound


def ordered(x: Array, values: Array) -> tuple[Array, Array]:
    order = np.argsort(x)
    return x[order], values[order]


def curved_is_slower(evidence: Evidence) -> Finding:
    flat, curved = starts(evidence.run(CASE, FLAT)), starts(evidence.run(CASE, CURVED))
    slower = [mine / other for mine, other in zip(curved, flat, strict=True)]
    verdict = FAILS if not slower[0] > LONGER else HOLDS if slower[1] > LONGER else CORRECTED
    apart = evidence.run(CASE, FLAT).wall_samples(WAFER, "pressure")[0]
    return Finding(
        f"the density changes by up to {100 * curved[2]:.2g} % (curved) and {100 * flat[2]:.2g} % (flat); "
        f"wafer pressure steady within {100 * STEADY:g} % from {curved[0]:.2g} and {flat[0]:.2g} s on "
        f"(samples {apart[1] - apart[0]:.1g} s apart), kinetic energy from {curved[1]:.2g} and {flat[1]:.2g} "
        "s on",
        "none: an incompressible fluid has no sound, and viscosity damps both flows alike",
        verdict,
        "what takes longer is artificial sound: verification/accuracy.md has the times, by how the run starts"
        if verdict == CORRECTED
        else "by wafer pressure and kinetic energy",
    )


def lattice_points(radius: float) -> int:
    """Centres of unit cells no farther than `radius` from a corner of cells."""
    places = np.arange(-math.ceil(radius), math.ceil(radius)) + 0.5
    return int(np.count_nonzero(np.add.outer(places**2, places**2) <= radius**2))


def particle_counts(evidence: Evidence) -> Finding:
    channel, box = load_case(CASE).scene(), load_case("disc_pair").scene()
    pad = next(wall for wall in channel["walls"] if wall["shape"] == "cosine")
    length, height = channel["domain"]["upper"]
    fluid = round(length * (height - pad["mean_height"]) / 1e-7**2)
    sides = [round(size / 1e-4) + 2 * DUMMY_LAYERS for size in box["domain"]["upper"]]
    cylinder = lattice_points(box["discs"][0]["radius"] / 1e-4)
    abrasive = lattice_points(load_case("abrasives").scene()["discs"][0]["radius"] / 1e-7)
    found = (fluid, sides[0] * sides[1], cylinder, abrasive)
    return Finding(
        "not needed",
        f"area over spacing squared: {fluid}; {sides[0]} x {sides[1]} = {found[1]} with three layers of "
        f"dummies on all sides; lattice points in a disc: {cylinder} and {abrasive}",
        HOLDS if found == (30000, 124836, 484, 80) else FAILS,
        "so that the scenes here are the paper's",
    )


CLAIMS = (
    Claim(
        "4",
        "30000 fluid particles, 124836 particles in the box, 484 in a cylinder, 80 in an abrasive",
        particle_counts,
    ),
    Claim("4.1.1", "Reynolds' equation is not valid here, L being comparable with H", reynolds_fails),
    Claim("4.1.1", "moving the rough wall is difficult for methods with a mesh", mesh_is_difficult),
    Claim("4.1.1", "SPH and FLUENT agree on wafer pressure and shear (Fig. 7)", agrees_with_fluent),
    Claim("4.1.1", "and on the pressure in the whole channel (Fig. 8)", whole_field),
    Claim("4.1.1", "moving either wall gives almost identical results (Fig. 7)", either_wall),
    Claim("4.1.1", "steady after 3e-5 s (flat wall moves) and 6e-5 s (curved wall moves)", steady_times),
    Claim(
        "4.1.1",
        "moving the curved wall changes the flow more sharply at first, and takes longer to be steady",
        curved_is_slower,
    ),
)
