import base64
import html.parser
import json
import re
import sys

import pytest
from matplotlib.figure import Figure
from verification_fakes import FakeSolver, load

from verification import execute, report, run


@pytest.fixture(scope="module")
def verified(tmp_path_factory):
    """The output folder of a small run of both schemes with its report, one check failing."""
    out = tmp_path_factory.mktemp("verify")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(execute, "call", FakeSolver(error=0.013).call)
        arguments = ["--case", "rough_channel", "--case", "couette", "--case", "taylor_green"]
        assert (
            run.main(["--solver", sys.executable, "--out", str(out), "--no-baseline", *arguments], load) == 1
        )
    return out


def test_markdown_names_every_finest_check(verified):
    text = (verified / "report.md").read_text()
    assert "**FAILED" in text
    assert text.count("| passed |") == 26
    assert "above tolerance" in text
    for picture in re.findall(r"\]\((figures/\S+)\)", text):
        assert (verified / picture).stat().st_size > 5000
    assert text.count("](figures/") == 4 + 3 + 3


def test_html_is_one_well_formed_page_with_its_pictures_inside(verified):
    text = (verified / "report.html").read_text()
    sources = re.findall(r'src="([^"]*)"', text)
    assert len(sources) == 3 + 10  # of the gallery and of the figures
    assert all(base64.b64decode(s.removeprefix("data:image/png;base64,"))[:4] == b"\x89PNG" for s in sources)
    assert "http" not in re.sub(r'src="[^"]*"', "", text)
    assert "class='verdict failed'" in text
    html.parser.HTMLParser().feed(text)


def blank(data):
    return Figure()


def test_regeneration_readme_and_picture(verified, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(report, "FIGURES", dict.fromkeys(report.FIGURES, blank))
    readme, picture = tmp_path / "README.md", tmp_path / "docs" / "figure.png"
    readme.write_text(f"# Title\n{report.MARKERS[0]}\nold\n{report.MARKERS[1]}\nend\n")
    arguments = ["--out", str(verified), "--readme", str(readme), "--picture", str(picture)]
    assert report.main(arguments, lambda: run.References(load)) == 0
    text = readme.read_text()
    assert text.startswith(f"# Title\n{report.MARKERS[0]}\n")
    assert text.endswith(f"{report.MARKERS[1]}\nend\n")
    assert "old" not in text
    assert "| wafer_shear |" in text
    assert picture.read_bytes()[:4] == b"\x89PNG"
    assert report.main(arguments, lambda: run.References(load)) == 0
    assert readme.read_text() == text
    readme.write_text("no markers")
    assert report.main(arguments, lambda: run.References(load)) == 2
    assert readme.read_text() == "no markers"
    assert "needs the lines" in capsys.readouterr().err


def test_known_shortfalls_and_regressions_have_their_own_place(verified):
    results = json.loads((verified / "results.json").read_text())
    check = results["cases"][2]["checks"][0]
    check.update(passed=False, known_shortfall=True, note="start-up | singular", reason="error above")
    row = {"key": "a/b", "accepted": 0.1, "value": 0.2, "status": "regression", "unit": ""}
    content = report.blocks(results | {"baseline": [row]}, [], [])
    page = report.to_html("title", False, content)
    assert '<tr class="known">' in page
    assert page.index("a/b") > page.index("Regression gate")
    assert "a/b" not in report.verification_table(results).markdown()
    assert "start-up \\| singular" in report.failure_table(results).markdown()


def test_a_figure_without_data_becomes_a_note(verified, monkeypatch):
    kept = {"wafer": report.FIGURES["wafer"]}
    monkeypatch.setattr(report, "FIGURES", dict.fromkeys(report.FIGURES, blank) | kept)
    results = json.loads((verified / "results.json").read_text())
    results["cases"] = [c for c in results["cases"] if c["variant"] != "bottom_wall_moves"]
    pictures, notes = report.draw(results, verified, run.References(load))
    assert any("bottom_wall_moves was not run" in note for note in notes)
    assert "rough_channel_convergence" in [picture.name for picture in pictures]
