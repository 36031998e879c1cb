"""Claims on two discs: each verdict follows what is planted."""

from __future__ import annotations

import numpy as np
import pytest
from ledger_fakes import Planted, results

from verification.ledger import discs
from verification.ledger.discs import CASE, VARIANT, Pair, published
from verification.ledger.evidence import CORRECTED, FAILS, HOLDS, OPEN

CHECKS = (
    "contact_time", "leading_height", "trailing_height",
    "leading_height_by_immersed_boundaries", "trailing_height_by_immersed_boundaries",
)  # fmt: skip


class PairRun:
    """A run whose discs go the ways of a Pair."""

    def __init__(self, pair: Pair, contact: float = 0.17) -> None:
        self.pair, self.contact = pair, contact

    def disc(self, name: str, field: str) -> tuple[np.ndarray, np.ndarray]:
        if field == "position":
            return self.pair.times, self.pair.position[name]
        return self.pair.times, np.stack([0 * self.pair.times, -self.pair.fall[name]], axis=1)

    def disc_constant(self, name: str, field: str) -> float:
        return {"radius": 1.25e-3}[field]

    def attribute(self, name: str) -> float:
        return {"first_contact_time": self.contact}[name]


def planted(pair: Pair) -> Planted:
    return Planted(runs={(CASE, VARIANT): PairRun(pair)})


@pytest.mark.parametrize("bad", ["", "contact_time", "leading_height", "trailing_height"])
def test_the_way_to_contact_by_its_checks(bad: str) -> None:
    found = results(CASE, VARIANT, **{name: name != bad for name in CHECKS})
    assert discs.agrees_until_kissing(Planted(results=found)).verdict == (FAILS if bad else HOLDS)


@pytest.mark.parametrize(("swapped", "verdict"), [(False, HOLDS), (True, FAILS)])
def test_the_upper_disc_by_its_speed(swapped: bool, verdict: str) -> None:
    pair = published("uhlmann")
    leading, trailing = pair.fall["leading"], pair.fall["trailing"]
    fall = {"leading": trailing, "trailing": leading} if swapped else pair.fall
    assert discs.trailing_is_faster(planted(Pair(pair.times, pair.position, fall))).verdict == verdict


def cut(pair: Pair, end: float) -> Pair:
    kept = pair.times <= end + 1e-9
    return Pair(
        pair.times[kept],
        {name: place[kept] for name, place in pair.position.items()},
        {name: fall[kept] for name, fall in pair.fall.items()},
    )


@pytest.mark.parametrize(("end", "verdict"), [(0.29, HOLDS), (0.2, OPEN), (0.15, FAILS)])
def test_the_phases_as_far_as_a_run_goes(end: float, verdict: str) -> None:
    found = discs.order_of_phases(planted(cut(published("uhlmann"), end)))
    assert found.verdict == verdict
    assert ("none of" in found.ours) == (verdict != HOLDS)
    assert "tumbling 0.24 to 0.25 s" in found.truth


@pytest.mark.parametrize(
    ("ends", "verdict"), [((0.29, 0.29), HOLDS), ((0.2, 0.29), CORRECTED), ((0.2, 0.2), OPEN)]
)
def test_other_starts_are_asked_where_they_were_run(ends: tuple[float, float], verdict: str) -> None:
    own, other = (PairRun(cut(published("uhlmann"), end)) for end in ends)
    evidence = Planted(
        results=results(discs.ENSEMBLE, "member_1"),
        runs={(CASE, VARIANT): own, (discs.ENSEMBLE, "member_1"): other},
    )
    found = discs.order_of_phases(evidence)
    assert found.verdict == verdict
    assert f"of 1 other starts {int(ends[1] > 0.25)} tumble" in found.ours


@pytest.mark.parametrize(
    ("leading", "trailing", "verdict"),
    [("uhlmann", "uhlmann", HOLDS), ("uhlmann", "glowinski", OPEN), ("glowinski", "glowinski", FAILS)],
)
def test_the_nearest_author_after_contact(leading: str, trailing: str, verdict: str) -> None:
    glowinski = published("glowinski")
    count = len(glowinski.times)  # the shorter curves
    own = {
        name: published(author).position[name][:count]
        for name, author in (("leading", leading), ("trailing", trailing))
    }
    pair = Pair(glowinski.times, own, glowinski.fall)
    assert discs.nearer_to_uhlmann(planted(pair)).verdict == verdict
