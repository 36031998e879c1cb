"""What mutants a source offers, which are drawn, and how they are planted."""

import pytest

from verification import mutations
from verification.mutants import FACTORS, PHYSICS, draw, header, hidden, mutants_of, planted

SOURCE = """// a + b = c;
#include "x + y"
double energy(double m, double v) { // of one
    double sum = 0;
    sum += m * v * v /
           2; // kinetic
    std::string text = "a + " + name(m);
    constexpr double g = 9.8 * 1;
    std::array<double, 2 + 1> three{};
    for (int k = 0; k < 3 * 4; ++k) { v = m; }
    const bool fast = v > 2 * m;
    return sum - std::max({3 * m, v});
}
"""
OFFERED = {
    (5, "sign", "m * v * v / 2"),
    (5, "drop", "m * v * v / 2"),
    (5, "scale", "m * v * v / 2"),
    (12, "sign", "- std::max({3 * m, v})"),
    (12, "drop", "- std::max({3 * m, v})"),
    (12, "scale", "sum - std::max({3 * m, v})"),
}


def test_signs_terms_and_results_of_the_physics_alone():
    found = list(mutants_of("solver/energy.cpp", SOURCE))
    assert {(m.line, m.kind, m.expression) for m in found} == OFFERED
    assert {m.last_line for m in found} == {6, 12}


def test_a_label_hides_no_result():
    found = list(mutants_of("solver/volume.cpp", "switch (k) { case Kind::of_one: return m / v; }"))
    assert [(m.kind, m.expression, m.statement) for m in found] == [("scale", "m / v", "return m / v")]


def test_hidden_code_keeps_every_place():
    assert len(hidden(SOURCE)) == len(SOURCE)
    assert hidden(SOURCE).count("\n") == SOURCE.count("\n")


def test_names_tell_equal_statements_apart_and_outlive_a_move():
    twice = [m.name for m in mutants_of("a.cpp", "{ s += a * b; } { s += a * b; }")]
    assert len(set(twice)) == len(twice) == 6
    moved = [m.name for m in mutants_of("a.cpp", "// new\n{ s += a * b; } { s += a * b; }")]
    assert moved == twice


def test_the_draw_is_even_and_always_the_same():
    files = {f: (mutations.REPOSITORY / f).read_text() for f in PHYSICS}
    every = [m for file, text in files.items() for m in mutants_of(file, text)]
    drawn = draw(every, 160)
    assert drawn == draw(list(reversed(every)), 160)
    assert len({m.name for m in drawn}) == 160
    assert {m.file for m in drawn} == set(PHYSICS)
    assert {m.kind for m in drawn} == set(FACTORS)


def test_planted_factors_nest_and_lines_stay():
    found = {(m.kind, m.end > m.start): m for m in mutants_of("a.cpp", "double f() {\n return a - b * c;\n}")}
    chosen = {4: found["scale", True], 7: found["sign", False], 9: found["drop", False]}
    text = planted("double f() {\n return a - b * c;\n}", chosen)
    statement = text.split("\n#line 1\n")[1].splitlines()[1]
    assert statement == " return mutant(4) * (a - mutant(7) * mutant(9) * b * c);"


@pytest.mark.parametrize("count", [0, 3])
def test_the_header_holds_a_factor_for_each(count):
    assert f"std::array<float, {max(count, 1)}>" in header(count)
