"""The ledger of claims as a whole: what was not run is not decided, and nothing is written without it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from ledger_fakes import ALIKE, ensemble, results, whole

from verification import claims
from verification.case import load_case
from verification.ledger import shear_frequency
from verification.ledger.evidence import OPEN, Claim, Evidence, Finding, Missing, undecided

BY_ARITHMETIC = 3  # factors of the kernel, numbers of particles, Table 1


def test_without_evidence_nothing_but_arithmetic_is_decided() -> None:
    rows = list(zip(claims.CLAIMS, claims.findings(Evidence(), claims.CLAIMS), strict=True))
    found = [finding for _, finding in rows if isinstance(finding, Finding)]
    assert sum(finding.verdict != OPEN for finding in found) == BY_ARITHMETIC
    text = claims.ledger(Evidence())
    assert text.count("not decided") == len(rows) - len(found)
    assert "8 for 7, 15 for 14, 29 for 28" in text


def test_every_section_has_its_claims_in_the_papers_order() -> None:
    sections = [claim.section.split(",")[0] for claim in claims.CLAIMS]
    chapters = [[int(part) for part in section.split(".")][:2] for section in sections]
    assert chapters == sorted(chapters)
    assert len({claim.text for claim in claims.CLAIMS}) == len(claims.CLAIMS)


def test_what_cannot_be_decided_says_why() -> None:
    found = undecided("nothing", "none", "no removal is computed")(Evidence())
    assert (found.verdict, found.why) == (OPEN, "no removal is computed")


def test_the_run_of_a_check_is_beside_the_results(tmp_path: Path) -> None:
    case, variant = "rough_channel", "top_wall_moves"
    evidence = Evidence(results=results(case, variant), build=tmp_path)
    with pytest.raises(Missing, match="make verify"):
        evidence.run(case, variant)
    folder = tmp_path / "verify/runs" / case / "default" / variant / "1e-07"
    folder.mkdir(parents=True)
    (folder / "result.h5").touch()
    assert evidence.run(case, variant).path == folder / "result.h5"
    assert evidence.run(case, variant).scene == load_case(case).scene(load_case(case).variants[0])


def test_a_reference_is_not_made_for_a_run_that_was_not() -> None:
    with pytest.raises(Missing, match="make verify"):
        Evidence().truth("rough_channel", "top_wall_moves")
    with pytest.raises(Missing, match="make verify"):
        Evidence(results={"cases": []}).own_error("rough_channel")


def test_evidence_is_read_from_its_files(tmp_path: Path) -> None:
    for name in ("verify/asperity.json", "ablation/couette.json", "bench/machine_bench.json"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(json.dumps({"rows": [], "from": name}))
    found = Evidence.read(tmp_path)
    assert (found.results, found.abrasives) == (None, None)
    assert (found.asperity or {})["from"] == "verify/asperity.json"
    assert found.ablation["couette"]["from"] == "ablation/couette.json"
    assert (found.bench or {})["from"] == "bench/machine_bench.json"


def test_an_ensemble_of_an_older_report_is_named() -> None:
    assert "`make figures` (none)" in claims.ledger(Evidence(abrasives=ensemble()))


def test_a_row_that_was_not_run_names_the_command() -> None:
    def lacking(evidence: Evidence) -> Finding:
        raise Missing("`make tea`")

    text = claims.ledger(Evidence(), [Claim("9", "tea", lacking)])
    assert "| 9 | tea |  |  | not decided | not run: `make tea` |" in text


def test_the_ledger_says_what_each_part_is_from() -> None:
    text = claims.ledger(
        Evidence(results={"level": "gate", "cases": []}, asperity={"level": "paper"}, abrasives=whole(ALIKE)),
        shear_frequency.CLAIMS,
    )
    assert "`make verify` (level gate): Secs. 4.1 and 4.3" in text
    assert "`python -m verification.asperity` (level paper): Sec. 4.2" in text
    assert "`make figures` (4 members for each number of discs, spacing 2e-07 m): abrasives" in text


@pytest.fixture
def repository(tmp_path: Path) -> list[str]:
    """A ledger, a page with markers and no evidence; the command line for them."""
    (tmp_path / "claims.md").write_text("of earlier\n")
    (tmp_path / "README.md").write_text("<!-- sensitivity:begin -->\n<!-- sensitivity:end -->\n")
    paths = {"--build": "build", "--to": "claims.md", "--page": "README.md"}
    return [text for option, name in paths.items() for text in (option, str(tmp_path / name))]


def test_a_clone_without_evidence_keeps_its_ledger(
    repository: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert claims.main(repository) == 2
    assert (tmp_path / "claims.md").read_text() == "of earlier\n"
    message = capsys.readouterr().err
    for command in (
        "make verify",
        "make verify LEVEL=paper",
        "python -m verification.asperity",
        "make figures",
        "make ablation",
        "make bench",
    ):
        assert f"`{command}`" in message


def test_whole_evidence_makes_the_ledger_and_the_page(
    repository: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(claims, "CLAIMS", shear_frequency.CLAIMS)
    (tmp_path / "build/figures").mkdir(parents=True)
    (tmp_path / "build/figures/abrasives.json").write_text(json.dumps(whole(ALIKE)))
    assert claims.main(repository) == 0
    assert "F_tau rises" in (tmp_path / "claims.md").read_text()
    assert "| 5 % | 0.30 |" in (tmp_path / "README.md").read_text()
