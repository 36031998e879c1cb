"""What every reference offers, how its identity is computed and how a costly one is kept on disk.

A reference is identified by a digest of everything that can change its numbers: its name, the physics of the
scene (domain, fluid, walls; never the particles), the scripts that make it and the versions of their
libraries. A file is written whole or not at all, and read only if digest, scene, shapes and checksum are as
expected.
"""

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Protocol

import h5py
import numpy as np
import scipy
import skfem

Array = np.ndarray


class ReferenceError(ValueError):
    """A reference that cannot be made, or a stored one that must not be used; the message says why."""


class Reference(Protocol):
    """A solution to compare with, in SI units and in the frame of the scene (the laboratory).

    Positions x, y are arrays of one shape (n,); `wall` is a wall's name, and x along it is measured where the
    wall stood at time 0. The wall shear is the tangential traction of the wall on the fluid, towards +x.
    """

    kind: str  # "exact" or "finite-element"
    source: str  # one line, with a key of references.bib
    error_estimate: float  # relative, from the reference's own convergence
    seconds: float  # what making it cost
    digest: str

    def velocity(self, x: Array, y: Array, t: float) -> Array: ...  # (n, 2), m/s
    def pressure(self, x: Array, y: Array, t: float) -> Array: ...  # (n,), Pa, mean zero over the fluid
    def wall_pressure(self, wall: str, x: Array, t: float) -> Array: ...  # (n,), Pa
    def wall_shear(self, wall: str, x: Array, t: float) -> Array: ...  # (n,), Pa
    def kinetic_energy(self, t: float) -> float: ...  # J/m

    # Of a scene with discs, at times t (n,): "position" or "velocity" (n, 2) in m or m/s, "angle" (n,) in
    # rad, "spin" (n,) in rad/s, "torque" (n,) in N: what the reference knows; ReferenceError otherwise.
    def disc(self, name: str, quantity: str, t: Array) -> Array: ...


def canonical(problem: Mapping[str, object]) -> str:
    """One text for one problem, whatever the order of its keys."""
    return json.dumps(problem, sort_keys=True, allow_nan=False)


def digest_of(name: str, problem: Mapping[str, object], scripts: Sequence[Path]) -> str:
    """The identity of a reference, 64 hexadecimal digits."""
    versions = {module.__name__: module.__version__ for module in (np, scipy, skfem)}
    sources = {script.name: hashlib.sha256(script.read_bytes()).hexdigest() for script in scripts}
    identity = {"name": name, "problem": problem, "scripts": sources, "versions": versions}
    return hashlib.sha256(canonical(identity).encode()).hexdigest()


def cache_file(cache: Path, name: str, digest: str) -> Path:
    return cache / f"{name}-{digest[:16]}.h5"


def _checksum(arrays: Mapping[str, Array]) -> str:
    total = hashlib.sha256()
    for key in sorted(arrays):
        array = np.ascontiguousarray(arrays[key], dtype=float)
        total.update(f"{key}{array.shape}".encode())
        total.update(array.tobytes())
    return total.hexdigest()


def write_arrays(file: Path, digest: str, problem: Mapping[str, object], arrays: Mapping[str, Array]) -> None:
    """Writes `arrays` beside the identity they belong to. Raises ReferenceError where that is impossible."""
    part = file.with_name(f"{file.name}.{os.getpid()}.part")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        try:
            with h5py.File(part, "w") as out:
                out.attrs.update(digest=digest, problem=canonical(problem), checksum=_checksum(arrays))
                for key, array in arrays.items():
                    out[key] = np.asarray(array, dtype=float)
            part.replace(file)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise ReferenceError(f"{file}: the reference cannot be stored: {error}") from error


def read_arrays(file: Path, digest: str, problem: Mapping[str, object]) -> dict[str, Array]:
    """The arrays of a stored reference. Raises ReferenceError: another geometry, a damaged file, a NaN."""
    advice = "delete it and run `make reference`"
    try:
        with h5py.File(file, "r") as stored:
            attributes = {key: str(stored.attrs.get(key, "")) for key in ("digest", "problem", "checksum")}
            arrays = {key: np.asarray(stored[key][()], dtype=float) for key in stored}
    except (OSError, RuntimeError, TypeError, ValueError) as error:
        raise ReferenceError(f"{file}: not a whole HDF5 file ({error}); {advice}") from error
    if attributes["problem"] != canonical(problem):
        raise ReferenceError(f"{file}: belongs to another geometry or fluid than the scene's; {advice}")
    if attributes["digest"] != digest:
        raise ReferenceError(f"{file}: was made by other scripts or library versions than these; {advice}")
    for key, array in arrays.items():
        if not np.isfinite(array).all():
            raise ReferenceError(f"{file}: {key} has values that are not finite; {advice}")
    if attributes["checksum"] != _checksum(arrays):
        raise ReferenceError(f"{file}: its data do not have the checksum they were stored with; {advice}")
    return arrays
