"""The report's front page: a card for each case, its number from results.json, its link."""

import copy
import re

import matplotlib.image
import numpy as np
import pytest

from verification import gallery, page
from verification.case import CaseError, load_cases

CHECK = {"quantity": "wafer_pressure", "value": 0.002, "tolerance": 0.008, "unit": "", "passed": True}
CHECK |= {"known_shortfall": False, "reported": False, "source": "steady flow (wang2014)"}
ENTRY = {"case": "rough_channel", "scheme": "default", "finest": True, "checks": [CHECK]}


def entries(*changes, **of_entry):
    """An entry for each change of the check."""
    return [copy.deepcopy(ENTRY) | of_entry | {"checks": [CHECK | change]} for change in changes]


def test_the_number_is_the_worst_of_the_finest_runs():
    runs = entries({}, {"value": 0.0041}, {"quantity": "velocity", "value": 0.1})
    runs += entries({"value": 0.2}, finest=False) + entries({"value": 0.3}, scheme="wang2014")
    words, verdict = gallery.sentence("rough_channel", runs)
    assert words == (
        "Wafer pressure, held against steady flow: 0.41 % off in the worst of 2, 0.8 % is allowed."
    )
    assert verdict == "passed"


@pytest.mark.parametrize(
    ("change", "said", "verdict"),
    [
        ({"value": 0.01, "passed": False}, "1 % off, 0.8 % is allowed. FAILED.", "failed"),
        ({"value": None, "passed": False}, "no finite error, 0.8 % is allowed. FAILED.", "failed"),
        ({"passed": False, "known_shortfall": True}, "A known shortfall.", "known"),
        ({"unit": "m", "value": 9e-6, "tolerance": 1e-4}, "9 µm off, 100 µm is allowed.", "passed"),
        ({"source": "a_m, b_m of data/curve.csv"}, "held against data/curve.csv: 0.2 %", "passed"),
        ({"quantity": "velocity"}, "Wafer pressure was not measured.", "failed"),
    ],
)
def test_a_sentence_says_how_it_stands(change, said, verdict):
    words, found = gallery.sentence("rough_channel", entries(change))
    assert said in words
    assert found == verdict


def test_a_run_without_an_error_is_the_worst():
    words, verdict = gallery.sentence("rough_channel", entries({}, {"value": None, "passed": False}))
    assert "no finite error in the worst of 2" in words
    assert verdict == "failed"


def test_what_is_only_reported_does_not_stand_for_a_case():
    runs = entries({}, {"value": 0.5, "reported": True, "passed": False})
    assert gallery.sentence("rough_channel", runs)[1] == "passed"


def test_every_case_has_a_heading_and_a_headline_that_it_measures(monkeypatch):
    for case in load_cases():
        assert gallery.title(case.name)
        gallery.sentence(case.name, [])
    case = next(case for case in load_cases() if case.name == "rough_channel")
    case.data["headline"] = "colour"
    monkeypatch.setattr(gallery, "load_case", lambda name: case)
    with pytest.raises(CaseError, match="headline colour"):
        gallery.sentence("rough_channel", [])


def test_a_card_is_small_and_leads_to_its_heading(tmp_path):
    path = tmp_path / "wafer.png"
    matplotlib.image.imsave(path, np.random.default_rng(1).random((700, 800, 3)))
    picture = page.Picture("rough_channel_wafer", path, "caption", "rough_channel")
    results = {"cases": [*entries({}), ENTRY | {"case": "couette"}]}
    cards = gallery.cards(results, [picture])
    assert [card.title for card in cards] == [gallery.title("rough_channel")]
    assert len(cards[0].image) < path.stat().st_size / 3
    text = page.to_html("title", True, [cards, f"## {cards[0].title}", picture])
    links = re.findall(r"href='#([^']+)'", text)
    assert links == ["rough-channel-sec-411-figs-6-8"]
    assert f"<h3 id='{links[0]}'>" in text
    markdown = page.to_markdown("title", [cards, f"## {cards[0].title}"], tmp_path)
    assert f"](#{links[0]}): Wafer pressure" in markdown
