"""How far a case is from its limit in one direction: outward in steps of the target, then by bisection."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from verification.stability.trial import Trial

TARGET = 1.5  # issue 7: the least factor by which the defaults should clear every limit
RESOLUTION = 1.11  # a limit is known to this factor: two bisections of a step
SHORTFALL_STEPS = 3  # how many steps back towards the easy side when the defaults do not survive

Attempt = Callable[[float], Trial]


@dataclass
class Margin:
    """`factor`: the largest that survived (0: none did), short of the first that did not (inf: none)."""

    factor: float
    broken_at: float
    trials: list[Trial] = field(default_factory=list)

    @property
    def met(self) -> bool:
        return self.factor >= TARGET * (1 - 1e-9)

    @property
    def last(self) -> Trial | None:
        """The trial nearest beyond the limit, which shows how it fails."""
        beyond = [trial for trial in self.trials if not trial.survived and trial.factor >= self.broken_at]
        return min(beyond, key=lambda trial: trial.factor, default=None)


def find(attempt: Attempt, base: Trial, limit: float) -> Margin:
    """The margin up to the factor `limit`. With a base that fails, the search goes to easier values instead
    and the margin is below 1. Survival need not be monotonic: the first limit met on the way counts.
    """
    trials = [base]

    def tried(factor: float) -> bool:
        trials.append(attempt(factor))
        return trials[-1].survived

    if base.survived:
        good, bad = 1.0, math.inf
        while bad == math.inf and good < limit * (1 - 1e-9):
            factor = min(good * TARGET, limit)
            good, bad = (factor, bad) if tried(factor) else (good, factor)
    else:
        good, bad = 0.0, 1.0
        for step in range(1, SHORTFALL_STEPS + 1):
            if tried(TARGET**-step):
                good = TARGET**-step
                break
            bad = TARGET**-step
    while good > 0 and bad < math.inf and bad / good > RESOLUTION:
        middle = math.sqrt(good * bad)
        good, bad = (middle, bad) if tried(middle) else (good, middle)
    return Margin(good, bad, trials)
