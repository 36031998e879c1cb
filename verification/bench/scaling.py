"""Cost of a particle-step and memory of a particle against the number of particles."""

from __future__ import annotations

from typing import Any

from verification.bench.session import Session, finite


def measure(session: Session) -> dict[str, Any]:
    """Rows by size and threads, and the memory of a run of 1e3 particles, which theirs is counted from."""
    plan = session.plan["scaling"]
    box = {"case": plan["case"], "variant": plan["variant"]}
    sizes = [{"spacing": plan["memory_floor_spacing"], "steps": 10}, *plan["sizes"]]
    threads = [1] + [count for _ in plan["sizes"] for count in plan["threads"]]
    shapes = [sizes[0]] + [size for size in plan["sizes"] for _ in plan["threads"]]
    jobs = [
        session.shortened(session.job(**box, spacing=size["spacing"], threads=count), size["steps"])
        for size, count in zip(shapes, threads, strict=True)
    ]
    floor, *measured = session.measure_all(jobs, memory=True)
    rows = []
    for item in measured:
        extra = item.peak_memory - floor.peak_memory
        rows.append(
            {
                "spacing_m": item.job.spacing,
                "threads": item.job.threads,
                "particles": None if item.failure else int(item.particles),
                "steps": int(item.attributes.get("steps", 0)),
                "repetitions": item.repetitions,
                "ns_per_particle_step": finite(1e9 * item.step_seconds / item.particles),
                "peak_memory_bytes": finite(item.peak_memory),
                "bytes_per_particle": finite(extra / (item.particles - floor.particles)),
                "failure": item.failure,
            }
        )
    return {"rows": rows, "memory_floor_bytes": finite(floor.peak_memory)}
