"""Progress with time remaining: a bar on a terminal, a line for each step in a log; on standard error."""

from __future__ import annotations

import sys
import time


class Progress:
    """Counts work in any unit (here the expected particle-steps) and extrapolates the time remaining."""

    def __init__(self, work: float, steps: int) -> None:
        self.work, self.steps = max(work, 1e-300), steps
        self.done, self.step = 0.0, 0
        self.started = time.monotonic()
        self.terminal = sys.stderr.isatty()

    def begin(self, label: str) -> None:
        if self.terminal:
            filled = int(30 * self.done / self.work)
            bar = "#" * filled + "." * (30 - filled)
            sys.stderr.write(f"\r\033[K[{bar}] {self.step}/{self.steps} {self.remaining()} {label}")
            sys.stderr.flush()

    def end(self, label: str, work: float) -> None:
        self.step += 1
        self.done += work
        if not self.terminal:
            print(f"[{self.step}/{self.steps}] {label} {self.remaining()}", file=sys.stderr, flush=True)
        elif self.step == self.steps:
            sys.stderr.write("\r\033[K")

    def remaining(self) -> str:
        if self.done <= 0:
            return ""
        seconds = (time.monotonic() - self.started) * (self.work / self.done - 1)
        return f"(about {seconds:.0f} s left)" if seconds < 120 else f"(about {seconds / 60:.0f} min left)"
