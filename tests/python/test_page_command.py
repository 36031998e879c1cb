"""A command that writes generated tables into a page: its exit status, and what the page holds after it."""

from __future__ import annotations

import pytest

from verification.case import CaseError
from verification.page import Table
from verification.page_command import write_tables


def write(page, measure):
    return write_tables("made_up", "Makes up a table.", page, measure, [])


def test_tables_go_between_their_markers(tmp_path, capsys):
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- one:begin -->\nold\n<!-- one:end -->\nafter\n")
    assert write(page, lambda options: {"one": Table(("head",), [("", ["cell"])])}) == 0
    text = page.read_text()
    assert "| cell |" in text and "old" not in text
    assert text.startswith("before") and text.endswith("after\n")
    assert "| cell |" in capsys.readouterr().out


@pytest.mark.parametrize(("error", "status"), [(CaseError("it failed"), 1), (ValueError("it failed"), 2)])
def test_what_fails_leaves_the_page_as_it_was(tmp_path, capsys, error, status):
    def measure(options):
        raise error

    page = tmp_path / "page.md"
    page.write_text("as it was\n")
    assert write(page, measure) == status
    assert page.read_text() == "as it was\n"
    assert "it failed" in "".join(capsys.readouterr())


def test_a_page_without_the_markers_is_refused(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("no markers\n")
    assert write(page, lambda options: {"one": Table(("head",), [])}) == 2
