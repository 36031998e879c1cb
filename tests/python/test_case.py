"""checks.toml: what a check of discs may say, and what is refused."""

from pathlib import Path

import pytest

from verification import execute, run
from verification.case import CaseError, load_case, load_cases

HEAD = """schemes = ["default"]
[spacings]
slow = { gate = [0.1], paper = [] }
fast = [0.2, 0.1]
[[variants]]
name = "slow"
[[variants]]
name = "fast"
set = { "discs.disc.velocity" = [1.0, 0.0] }
[[checks]]
quantity = "height"
at = "disc:disc"
field = "position_y"
window = { slow = [0.0, 2.0], fast = [0.0, 1.0] }
kind = "published"
why = "test"
tolerance = 0.01
"""
VALUE = (
    'value = { slow = 1.0, fast = 2.0 }\nsource = "nobody"\nmetric = "relative_scalar"\nstatistic = "max"\n'
)
DATA = 'data = { file = "a.csv", columns = ["a"] }\n'
METRES = 'metric = "largest_difference"\nunit = "m"\n'


def case(folder: Path, text: str):
    (folder / "discs").mkdir()
    (folder / "discs" / "checks.toml").write_text(HEAD + text)
    (folder / "discs" / "scene.toml").write_text("")
    return load_case("discs", folder)


def test_choices_by_variant(tmp_path):
    discs = case(tmp_path, VALUE + "reported = { fast = true }")
    slow, fast = (discs.checks("default", "gate", name)[0] for name in ("slow", "fast"))
    assert (slow.value, slow.window, slow.reported) == ((1.0,), (0.0, 2.0), False)
    assert (fast.value, fast.window, fast.reported) == ((2.0,), (0.0, 1.0), True)
    assert discs.references("slow") == []
    options = run.parse(["--level", "paper"])
    planned = [(r.scheme, r.variant.name, r.spacing, r.finest) for r in execute.plan([discs], options)]
    assert planned == [("default", "fast", 0.2, False), ("default", "fast", 0.1, True)]
    assert execute.plan([discs], run.parse(["--scheme", "wang2014"])) == []


def test_data_envelopes_and_references(tmp_path):
    check = case(tmp_path, DATA + METRES + 'against = "*"\n').checks("default", "gate", "slow")[0]
    assert (check.data.file, check.data.time, check.data.columns) == ("a.csv", "t_s", ("a",))
    assert run.described(check) == "a of data/a.csv against the band of all variants"
    settling = load_case("disc_rotating")
    assert settling.references("rings") == ["rotating_disc"]
    noise = settling.checks("default", "gate", "rings")[1]
    assert (noise.reference, run.described(noise)) == ("", "a steady torque")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (METRES, "nothing to hold it against"),
        (VALUE + DATA, "held against data, value"),
        (METRES + DATA + 'against = "fast"\n', "held against against, data"),
        (METRES + 'against = "*"\n', "held against against; "),
        (DATA + 'metric = "largest_difference"\n', "needs a unit or a scale"),
        (DATA + METRES + "scale = 1.0\n", "needs a unit or a scale"),
        (VALUE + 'unit = "m"\n', "needs a unit or a scale"),
        (DATA + METRES + 'statistic = "max"\n', "not of published curves"),
        (VALUE.replace("max", "median"), "a statistic is min or max"),
        (VALUE.replace('source = "nobody"\n', ""), "go together"),
        (VALUE.replace("slow = 1.0, ", ""), "no value for default, gate, slow"),
        (METRES + 'data = { file = "a.csv" }\n', "data needs file and columns"),
        (METRES + 'data = { file = "a.csv", columns = ["a"], shift = 1 }\n', "data needs file and columns"),
        (VALUE + "order_band = [1, 3]\n", "an order_band needs three spacings"),
    ],
)
def test_nonsense_is_refused(tmp_path, text, reason):
    with pytest.raises(CaseError, match=reason):
        case(tmp_path, text)


def test_an_unknown_scheme_is_refused(tmp_path):
    case(tmp_path, VALUE)
    (tmp_path / "discs" / "checks.toml").write_text(HEAD.replace("default", "best") + VALUE)
    with pytest.raises(CaseError, match="no scheme is called best"):
        load_case("discs", tmp_path)


def test_no_tolerance_is_looser_than_the_issues_ask():
    found = {c.name: c for c in load_cases()}
    for name, quantity, gate, paper in (
        ("disc_conservation", "momentum_step", 1e-12, 1e-12),
        ("disc_flight", "position", 1e-12, 1e-12),
        ("disc_still", "disc_speed", 1e-6, 1e-6),
        ("disc_array_drag", "drag", 0.01, 0.01),
        ("disc_rotating", "torque", 0.02, 0.01),
        ("disc_settling", "greatest_fall_speed", 0.03, 0.015),
        ("disc_settling", "height", 3e-4, 2e-4),
        ("disc_pair", "leading_height", 6e-4, 3e-4),
        ("disc_pair", "contact_time", 0.01, 0.006),
    ):
        variant = found[name].variants[0].name
        for level, tolerance in (("gate", gate), ("paper", paper)):
            checks = {c.quantity: c for c in found[name].checks("default", level, variant)}
            assert 0 < checks[quantity].tolerance <= tolerance
            assert not checks[quantity].reported
