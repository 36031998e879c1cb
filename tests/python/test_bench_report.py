import html.parser
import json
import os
import subprocess
import sys

import pytest
from test_bench_verdicts import channel_points, measured

from verification.bench import figures, report
from verification.bench.files import write_json, write_whole
from verification.bench.session import WRAPPER
from verification.compare import DataError


def speed_points():
    plain = {"case": "taylor_green", "variant": "re_100", "failure": "", "steps": 10, "fluid_particles": 400}
    return [
        plain
        | {
            "scheme": scheme,
            "arithmetic": "float",
            "threads": threads,
            "spacing_m": spacing,
            "wall_s": 0.01 / spacing,
        }
        | {"particle_steps_per_s": 1e7, "errors": {"velocity": spacing**2}}
        for scheme in ("default", "wang2014")
        for threads in (1, 2)
        for spacing in (0.04, 0.02)
    ]


def search():
    return [
        {"search": name, "set": points, "points": count, "threads": 1, "seconds": 1e-7 * count}
        for name in ("strips", "plane_sweep")
        for points in ("uniform", "clustered")
        for count in (1000, 100000)
    ]


def results(**changes):
    machine = {"processor": "p", "cores": 2, "system": "s"}
    facts = {"commit": "c", "generated": "now", "machine": machine, "load_average_at_start": 0.0}
    facts |= {"notes": ["a key is missing"], "failures": [], "references": []}
    facts["speed_error"] = speed_points() + [
        p | {"fluid_particles": 400, "particle_steps_per_s": 1e7, "steps": 10} for p in channel_points()
    ]
    content = measured() | facts
    content["machine_bench"] |= {"search": search(), "fma_peak_gflops": {"float": {"one_core": 100.0}}}
    for row in content["scaling"]["rows"]:
        row |= {
            "particles": round(row["spacing_m"] ** -2),
            "steps": 60,
            "peak_memory_bytes": 1e9,
            "failure": "",
        }
    return content | changes


def test_a_page_gets_the_targets_and_the_points_of_one_thread(tmp_path):
    page = tmp_path / "speed.md"
    parts = "<!-- targets:begin -->\n<!-- targets:end -->\nkept\n<!-- points:begin -->\n<!-- points:end -->\n"
    page.write_text(parts)
    found = results()
    report.write(tmp_path, found)
    report.write_page(page, found)
    text = page.read_text()
    peak = "100 Gflop/s of fused multiply-adds in float on one core"
    assert f"p, 2 cores, {peak}, now: 15 targets met, 0 missed, 0 skipped." in text
    assert text.count("| taylor_green, re_100 |") == 4
    assert "\nkept\n" in text
    page.write_text("no markers")
    with pytest.raises(ValueError, match="targets:begin"):
        report.write_page(page, found)


def test_the_report_has_targets_figures_and_notes(tmp_path, capsys):
    report.write(tmp_path, results())
    text = (tmp_path / "report.md").read_text()
    assert "**15 targets met, 0 missed, 0 skipped**" in text
    assert "a key is missing" in text
    for name in ("error-taylor_green-re_100", "error-rough_channel-v", "scaling", "search"):
        assert f"](figures/{name}.png)" in text
        assert (tmp_path / "figures" / f"{name}.png").stat().st_size > 5000
    page = (tmp_path / "report.html").read_text()
    assert page.count("data:image/png;base64,") == 4
    assert "class='verdict passed'" in page
    html.parser.HTMLParser().feed(page)
    stored = json.loads((tmp_path / "speed_error.json").read_text())
    report.print_targets(stored)
    assert capsys.readouterr().out.count("MET: ") == 15


def test_failures_colour_the_page_whatever_the_targets(tmp_path):
    report.write(tmp_path, results(failures=["couette: exit status 3"]))
    assert "class='verdict failed'" in (tmp_path / "report.html").read_text()
    assert "1 FAILED" in (tmp_path / "report.md").read_text()


def peer_results():
    run = {
        "code": "PySPH",
        "case": "taylor_green",
        "scheme": "edac",
        "arithmetic": "double",
        "fluid_particles": 2500,
    }
    run |= {
        "steps": 4400,
        "wall_s": 30.0,
        "errors": {"velocity": 0.03},
        "own_errors": {"l1": 0.02},
        "set": {},
        "failure": "",
    }
    machine = {"processor": "q", "cores": 1}
    facts = {"description": "Another code.", "generated": "then", "commit": "c", "machine": machine}
    return facts | {"pysph": {"version": "1.0", "compiler_flags": "-O3"}, "runs": [run], "ours": []}


def test_peers_appear_beside_ours(tmp_path):
    row = "| PySPH | taylor_green | edac | double | 2500 | 4400 | 30 |"
    write_json(tmp_path / "peers.json", peer_results())
    found = results()
    report.write(tmp_path, found)
    assert row in (tmp_path / "report.md").read_text()
    page = tmp_path / "speed.md"
    names = ("targets", "points", "peers")
    page.write_text("".join(f"<!-- {name}:begin -->\n<!-- {name}:end -->\n" for name in names))
    report.write_page(page, found)
    assert row in page.read_text()
    assert "q, 1 cores, then; PySPH 1.0, -O3. Another code." in page.read_text()


def test_no_data_no_figure():
    empty = {"speed_error": [], "scaling": None, "machine_bench": {}, "references": []}
    for draw in (
        figures.scaling,
        figures.search,
        lambda content: figures.error_against_time(content, "couette", "couette"),
    ):
        with pytest.raises(DataError):
            draw(empty)


def test_a_file_is_written_whole_or_not_at_all(tmp_path, monkeypatch):
    path = tmp_path / "speed_error.json"
    write_json(path, {"a": 1})
    with pytest.raises(ValueError, match="Out of range"):
        write_json(path, {"a": float("nan")})

    def full(*rest):
        raise OSError("no space left")

    monkeypatch.setattr(os, "fdopen", full)
    with pytest.raises(OSError, match="no space left"):
        write_whole(path, "half")
    assert json.loads(path.read_text()) == {"a": 1}
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_peak_memory_is_the_command_s(tmp_path):
    wrapped = [sys.executable, "-I", "-S", str(WRAPPER), str(tmp_path / "peak")]
    assert (
        subprocess.run(
            [*wrapped, "60", sys.executable, "-c", "b = bytearray(10**8); b[::4096] = b[::4096]"]
        ).returncode
        == 0
    )
    peak = float((tmp_path / "peak").read_text())
    assert 1e8 < peak < 2e8
    assert subprocess.run([*wrapped, "60", sys.executable, "-c", "raise SystemExit(3)"]).returncode == 3
    slow = [*wrapped, "0.2", sys.executable, "-c", "import time; time.sleep(60)"]
    assert "did not end" in subprocess.run(slow, capture_output=True, text=True).stderr
