"""Makes every reference that the verification cases need, and prints its convergence and cost.

python -m reference.make [--cache DIR] [CASE...]
python -m reference.make [--cache DIR] --scene FILE --reference NAME
"""

import argparse
import sys
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path

from reference import NAMES, ReferenceError, load

Task = tuple[str, str, Path, dict]  # label, reference, scene file, overrides


def tasks(root: Path, wanted: list[str]) -> Iterator[Task]:
    """One task for every reference of every variant of every case of the folder `root`."""
    cases = {file.parent.name: file for file in sorted(root.glob("*/checks.toml"))}
    for name in wanted:
        if name not in cases:
            raise ReferenceError(f"{root}: no case {name!r}; there are: {', '.join(cases) or 'none'}")
    for name in wanted or cases:
        try:
            checks = tomllib.loads(cases[name].read_text(encoding="utf-8"))
            named = [({}, checks)] if "reference" in checks else []
            named += [(entry, entry) for entry in checks.get("checks", []) if "reference" in entry]
        except (OSError, tomllib.TOMLDecodeError) as error:
            raise ReferenceError(f"{cases[name]}: cannot be read: {error}") from error
        for variant in checks.get("variants", []) or [{}]:
            label = " ".join(filter(None, (name, variant.get("name"))))
            mine = [
                r["reference"]
                for of, r in named
                if variant.get("name") in of.get("variants", [variant.get("name")])
            ]
            for reference in dict.fromkeys(mine):
                yield (
                    label,
                    reference,
                    cases[name].with_name(variant.get("scene", "scene.toml")),
                    variant.get("set", {}),
                )


def make(task: Task, cache: Path) -> None:
    label, name, scene, overrides = task
    print(f"{label}: {name} ...", flush=True)
    started = time.perf_counter()
    reference = load(name, scene, overrides, cache)
    now = time.perf_counter() - started
    if hasattr(reference, "error_table"):
        print(reference.error_table())
    print(
        f"{label}: {reference.kind}, own error {reference.error_estimate:.1e}, "
        f"cost {reference.seconds:.1f} s (now {now:.1f} s), {reference.digest[:16]}"
    )


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m reference.make", description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="*", metavar="CASE", help="folders of verification/ (default: all)")
    parser.add_argument("--cache", type=Path, default=Path("build/reference"), help="default: %(default)s")
    parser.add_argument(
        "--verification", type=Path, default=Path("verification"), help="default: %(default)s"
    )
    parser.add_argument("--scene", type=Path, help="a scene file, instead of cases")
    parser.add_argument("--reference", choices=NAMES, help="the reference to make of --scene")
    arguments = parser.parse_args()
    if (arguments.scene is None) != (arguments.reference is None):
        parser.error("--scene and --reference go together")
    if arguments.scene and arguments.cases:
        parser.error("name cases or a --scene, not both")
    try:
        if arguments.scene:
            found = [(arguments.scene.stem, arguments.reference, arguments.scene, {})]
        else:
            found = list(tasks(arguments.verification, arguments.cases))
        if not found:
            print(f"{arguments.verification}: no cases yet (no */checks.toml), so no reference to make")
        for task in found:
            make(task, arguments.cache)
    except ReferenceError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
