import json
import sys

import numpy as np
import pytest
from bench_fakes import FakeBench, FakePeer
from verification_fakes import load

from verification.bench import peers


@pytest.fixture
def peer(monkeypatch):
    fake = FakePeer(FakeBench().install(monkeypatch))
    monkeypatch.setattr("verification.execute.call", fake.call)
    return fake


def run(tmp_path, *arguments):
    page = tmp_path / "speed.md"
    page.write_text("<!-- peers:begin -->\n<!-- peers:end -->\n")
    places = ["--solver", sys.executable, "--out", str(tmp_path), "--page", str(page)]
    status = peers.main([*places, *arguments], load)
    return status, json.loads((tmp_path / "peers.json").read_text())


def test_every_example_stands_beside_ours(peer, tmp_path, capsys):
    status, results = run(tmp_path)
    assert status == 0
    tvf, edac, couette = results["runs"]
    assert (tvf["scheme"], edac["scheme"], couette["case"]) == ("tvf", "edac", "couette")
    assert tvf["errors"]["velocity"] == pytest.approx(0.02)
    assert tvf["own_errors"] == {"l1": pytest.approx(0.01)}
    assert (tvf["wall_s"], tvf["steps"], tvf["fluid_particles"]) == (30.0, 44, 30)
    ours = {(row["case"], row["scheme"], row["arithmetic"]) for row in results["ours"]}
    assert len(ours) == len(results["ours"]) == 8  # the two Taylor-Green examples share theirs
    assert all(row["errors"]["velocity"] > 0 and row["own_errors"]["l1"] > 0 for row in results["ours"])
    assert "| PySPH | couette | tvf |" in capsys.readouterr().out
    assert "| PySPH | couette | tvf |" in (tmp_path / "speed.md").read_text()


@pytest.mark.parametrize(
    ("change", "reason"), [({"completed": "false"}, "did not complete"), ({"error": np.nan}, "not finite")]
)
def test_a_bad_peer_run_is_a_failure_with_its_reason(peer, tmp_path, change, reason):
    for key, value in change.items():
        setattr(peer, key, value)
    status, results = run(tmp_path)
    assert status == 1
    assert reason in results["runs"][0]["failure"]
    assert results["runs"][0]["wall_s"] is None
    assert len(results["failures"]) == 3


def test_without_pysph_it_does_not_start(peer, tmp_path, capsys, monkeypatch):
    def absent(command):
        raise peers.CaseError("python3 -c: exit status 1: No module named 'pysph'")

    monkeypatch.setattr(peers, "ask", absent)
    assert peers.main(["--out", str(tmp_path)]) == 2
    assert "make bench-peers" in capsys.readouterr().err


def test_the_speed_s_l1_is_never_above_the_vector_s():
    random = np.random.default_rng(1)
    exact, ours = random.normal(size=(2, 50, 2))
    vector = np.linalg.norm(ours - exact, axis=1).sum() / np.linalg.norm(exact, axis=1).sum()
    assert 0 < peers.l1_of_speed(ours, exact) < vector
