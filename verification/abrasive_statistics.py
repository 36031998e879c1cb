"""What the ensemble of verification/active_shear.py says of F_tau and the concentration (Fig. 19, Sec. 4.4).

Intervals: 95 %, bootstrap over the members (percentile); members of the same concentration differ in where
the discs start. Between them lies most of the spread: a disc on a closed stream line never passes the gap.

Models of F_tau over the concentration w, by likelihood. A run of t_total makes N = t_total / t_memory
independent looks at the wafer, t_memory the integral of the autocorrelation of active within runs, and
k = F_tau N of them are active. k is beta-binomial with mean p(w) N and one correlation between the looks of a
run, fitted with each model: members differ by more than looks do.
    AIC = 2 parameters - 2 ln L,   BIC = ln(runs) parameters - 2 ln L.
The cube root and the straight line are cut off at F_tau = 1, where F_tau ends by definition.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy import optimize, special, stats

from verification.active_shear import Peaks, Rule
from verification.compare import Array, DataError

SATURATION = 5.1  # % by weight: the paper's "about 5 %", so that its 5.08 % is not beyond
RESAMPLES = 9999
FEWEST = 3  # members that have an interval
SEED = 20140101  # of the bootstrap: the same data give the same interval
BANDS = (0.0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2)
LEAST_DURATIONS = (0.0, 1.5e-6, 3e-6, 6e-6)  # s

Model = Callable[[Array, Array], Array]  # weight percent (n,), parameters -> F_tau
MODELS: dict[str, tuple[Model, tuple[float, ...]]] = {  # with starting values
    "cube root": (lambda w, a: a[0] * np.cbrt(w), (0.5,)),
    "cube root to 5 %, then constant": (lambda w, a: a[0] * np.cbrt(np.minimum(w, SATURATION)), (0.5,)),
    "linear": (lambda w, a: a[0] * w, (0.15,)),
    "linear to 5 %, then constant": (lambda w, a: a[0] * np.minimum(w, SATURATION), (0.15,)),
    "1 - exp(-lambda n)": (lambda w, a: -np.expm1(-a[0] * w), (0.5,)),
    "power": (lambda w, a: a[0] * w ** a[1], (0.5, 0.3)),
    "saturating exponential": (lambda w, a: a[1] * -np.expm1(-a[0] * w), (0.5, 0.9)),
}


def weight_percent(count: int, scene: dict[str, Any]) -> float:
    """Mass of the discs over the fluid's, in %: what Table 1 lists, without the (1 - wt%) of Eq. 4.4."""
    disc, pad = scene["discs"][0], next(w for w in scene["walls"] if w["shape"] == "gaussian")
    width, height = np.subtract(scene["domain"]["upper"], scene["domain"]["lower"])
    reach = math.erf(width / 2 / (pad["width"] * math.sqrt(2)))
    area = width * height - pad["amplitude"] * pad["width"] * math.sqrt(2 * math.pi) * reach
    mass = count * math.pi * disc["radius"] ** 2 * disc["density"]
    return float(100 * mass / (scene["fluid"]["density"] * area))


def interval(values: Array, seed: int = SEED) -> tuple[float, float] | None:
    """95 % bootstrap interval of the mean; None for fewer than three members, which have none."""
    if len(values) < FEWEST:
        return None
    draws = np.random.default_rng(seed).choice(values, (RESAMPLES, len(values))).mean(axis=1)
    low, high = np.quantile(draws, [0.025, 0.975])
    return float(low), float(high)


def memory(runs: Sequence[Peaks], rule: Rule) -> float:
    """Integral of the autocorrelation of active within runs up to its first zero, s; at least a sample."""
    centred = [active - active.mean() for active in (rule.active(run).astype(float) for run in runs)]
    length = min(map(len, centred))
    lags = np.array([sum(np.dot(a[: length - k], a[k:length]) for a in centred) for k in range(length)])
    step = float(runs[0].times[1] - runs[0].times[0])
    if not lags[0] > 0:
        raise DataError("no run changes between active and not active")
    end = int(np.argmax(lags <= 0)) or length
    return step * float(1 + 2 * (lags[1:end] / lags[0]).sum())


def log_likelihood(p: Array, correlation: float, active: Array, looks: float) -> float:
    """Of beta-binomial numbers of active looks (n,), real ones allowed, at means p (n,)."""
    p, correlation = np.clip(p, 1e-6, 1 - 1e-6), float(np.clip(correlation, 1e-6, 1 - 1e-6))
    size = 1 / correlation - 1
    a, b = p * size, (1 - p) * size
    choices = -np.log(looks + 1) - special.betaln(active + 1, looks - active + 1)
    return float(np.sum(choices + special.betaln(active + a, looks - active + b) - special.betaln(a, b)))


def _likeliest(mean: Callable[[Array], Array], start: Sequence[float], frequency: Array, looks: float) -> Any:
    """SciPy's minimum of -ln L over the logarithms of the parameters and the logit of the correlation."""

    def cost(x: Array) -> float:
        p = np.clip(mean(np.exp(x[:-1])), 0, 1)
        return -log_likelihood(p, float(special.expit(x[-1])), frequency * looks, looks)

    # Two starts: where the mean is cut off at 1 the likelihood has ridges that one of them may get stuck on.
    trials = [optimize.minimize(cost, [*np.log(start), logit], method="Nelder-Mead") for logit in (-2.0, 1.0)]
    return min(trials, key=lambda trial: trial.fun)


def fit(name: str, weight: Array, frequency: Array, looks: float) -> dict[str, Any]:
    """The model's most likely parameters, log likelihood, AIC and BIC."""
    model, start = MODELS[name]
    best = _likeliest(lambda parameters: model(weight, parameters), start, frequency, looks)
    count = len(best.x)
    return {
        "model": name,
        "parameters": np.exp(best.x[:-1]).tolist(),
        "correlation": float(special.expit(best.x[-1])),
        "log_likelihood": -float(best.fun),
        "aic": 2 * count + 2 * float(best.fun),
        "bic": math.log(len(weight)) * count + 2 * float(best.fun),
    }


def ranked(weight: Array, frequency: Array, looks: float) -> list[dict[str, Any]]:
    """All models, the best by AIC first, with their Akaike weights; none if all runs are alike."""
    if np.ptp(frequency) == 0:
        return []
    fits = sorted((fit(name, weight, frequency, looks) for name in MODELS), key=lambda f: f["aic"])
    likely = np.exp([(fits[0]["aic"] - f["aic"]) / 2 for f in fits])
    return [f | {"akaike_weight": float(w)} for f, w in zip(fits, likely / likely.sum(), strict=True)]


def exponent(weight: Array, frequency: Array, looks: float) -> tuple[float, float, float]:
    """b of F_tau = a w^b with its 95 % interval by profile likelihood (within 3.84 / 2 of the top)."""
    grid = np.linspace(-0.2, 1.8, 41)
    start = [(frequency.mean() / np.mean(weight**b),) for b in grid]
    profile = -np.array(
        [
            _likeliest(lambda a, b=b: a[0] * weight**b, first, frequency, looks).fun
            for b, first in zip(grid, start, strict=True)
        ]
    )
    inside = grid[profile > profile.max() - stats.chi2.ppf(0.95, 1) / 2]
    return float(grid[np.argmax(profile)]), float(inside.min()), float(inside.max())


def slope(weight: Array, frequency: Array) -> tuple[float, ...]:
    """d F_tau / d w per % by least squares; its 95 % bootstrap interval where every w has FEWEST members."""
    generator, slopes = np.random.default_rng(SEED), []
    groups = [np.flatnonzero(weight == w) for w in np.unique(weight)]
    best = float(np.polyfit(weight, frequency, 1)[0])
    if min(map(len, groups)) < FEWEST:
        return (best,)
    for _ in range(RESAMPLES // 5):
        drawn = np.concatenate([generator.choice(group, len(group)) for group in groups])
        slopes.append(np.polyfit(weight[drawn], frequency[drawn], 1)[0])
    low, high = np.quantile(slopes, [0.025, 0.975])
    return best, float(low), float(high)


def analyse(runs: Sequence[Peaks], scene: dict[str, Any], rule: Rule) -> dict[str, Any]:
    """Everything that is said of one ensemble by one rule."""
    members = [run for run in runs if run.count > 0]
    counts = np.array([run.count for run in members])
    weight = np.array([weight_percent(run.count, scene) for run in members])
    frequency = np.array([rule.frequency(run) for run in members])
    total = float(members[0].times[-1] - rule.settling)
    remembered = memory(members, rule)
    rows = [{"count": 0, "weight_percent": 0.0, "members": 1, "mean": rule.frequency(runs[0])}]
    for count in np.unique(counts):
        mine = frequency[counts == count]
        rows.append({"count": int(count), "weight_percent": weight_percent(count, scene),
                     "members": len(mine), "mean": float(mine.mean()), "interval": interval(mine),
                     "values": mine.tolist(),
                     "t_total_s": total * len(mine), "t_active_s": total * float(mine.sum())})  # fmt: skip
    before, after = weight <= SATURATION, weight > SATURATION - 0.1  # 5.08 % belongs to both
    rise = stats.kendalltau(weight, frequency, alternative="greater")
    return {
        "rule": vars(rule), "memory_s": remembered, "rows": rows,
        "rise": {"kendall_tau": float(rise.statistic), "p": float(rise.pvalue)},
        "slope_before_per_percent": slope(weight[before], frequency[before]),
        "slope_after_per_percent": slope(weight[after], frequency[after]),
        "exponent_before": exponent(weight[before], frequency[before], total / remembered),
        "models": ranked(weight, frequency, total / remembered),
        "models_before": ranked(weight[before], frequency[before], total / remembered),
    }  # fmt: skip
