"""Mutants of the physics: which a source offers, which are drawn, and how a build holds them all at once.

A mutant is a factor on one expression: -1 flips a sign, 0 drops a term, 1.02 scales a result by 2 %. So every
expression that has mutants is multiplied by a number that is read when the program starts, from
SLURRY_MUTANT=<mutant>:<factor>, and 1 without: one build shows all of them. Constants of the compiler
(constexpr) offer no mutants, the formulas that use them do.
"""

from __future__ import annotations

import bisect
import hashlib
import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

PHYSICS = tuple(
    f"solver/{name}"
    for name in (
        "terms/advection_tensor.hpp", "terms/background_pressure.hpp", "terms/continuity.hpp",
        "terms/density_diffusion.hpp", "terms/equation_of_state.hpp", "terms/gradient_correction.hpp",
        "terms/normal_equations.hpp", "terms/number_density.hpp", "terms/particle_volume.hpp",
        "terms/plain_pressure_force.hpp", "terms/pressure_advection.hpp", "terms/pressure_force.hpp",
        "terms/viscous_force.hpp", "terms/viscous_twist.hpp", "terms/wall_extrapolation.hpp",
        "terms/wall_fit.hpp", "terms/wall_pressure_gradient.hpp",
        "kernels/fitted_quintic.hpp", "kernels/quintic_spline.hpp", "kernels/wendland.hpp",
        "discs/clearance.cpp", "discs/contact.cpp", "discs/crowd.cpp", "discs/disc_dummies.cpp",
        "discs/motion.cpp",
        "geometry/layers.cpp", "loop/pair_interactions.hpp", "loop/pass_rows.hpp", "loop/units.hpp",
        "particles/particles.cpp", "particles/wall_impulse.cpp",
        "probes/local_fit.cpp", "probes/point_probe.cpp", "probes/totals.cpp", "probes/wall_probe.cpp",
        "time/time_step.hpp", "time/velocity_verlet.cpp",
    )
)  # fmt: skip
FACTORS = {"sign": "-1", "drop": "0", "scale": "1.02"}
HEADER = "solver/mutants.hpp"

HIDDEN = re.compile(r'//[^\n]*|^\s*#[^\n]*|"(?:\\.|[^"\\\n])*"|\bcase\s[\w:]+', re.MULTILINE)
# One brace group is part of an expression, as in Real{0.5} or std::min({a, b}).
EXPRESSION = r"(?P<expression>[^\s;{}=](?:[^;{}]|(?<=[\w(])\{[^;{}]*\})*)(?=;)"
ASSIGNED = re.compile(
    r"(?<![^\s;{}])(?P<to>return|(?:const\s+)?(?:double|P|Real|Vector|Stencil|Eigen::ArrayXd)\s\w+\s=|[a-z][\w.:\[\]()]*\s(?P<by>[-+]?)=)\s+"
    + EXPRESSION
)
STATEMENT = re.compile(r"[^;{}\s](?:[^;{}]|(?<=[\w(])\{[^;{}]*\})*")
SIGN = re.compile(r"(?<=[\w)\]]\s)[-+]\s+(?=[\w(])")
INDEX = re.compile(r"\b(?:column|degree|order)\s$")
OPERAND = re.compile(r"\w(?:[\w.:]|->)*(?:\([^()]*\)|\[\w*\])*")
COMPUTES = re.compile(r"\s[-+*/]\s|\w\(")
NO_PHYSICS = re.compile(
    r"\b(?:constexpr|using|template|static_assert|for|while|namespace|struct|throw|static_cast<std::|auto"
    r"|size_t|ptrdiff_t|int|bool|string|begin|count|std::array|bytes|optional|first_coefficient|move|push_back|resize"
    r"|numeric_limits|Zero|first_of_discs|end|capacity|lanes|products\[at|leaves\(\)\[)\b|<<"
    r"|\breturn\s*\{|i \* \(i \+ 1\)"
)
COMPARES = re.compile(r"\s[<>]=?\s|[!=]=\s|&&|\|\|")


@dataclass(frozen=True)
class Mutant:
    name: str  # stays the same when lines move
    file: str
    line: int
    last_line: int  # of the statement
    kind: str  # of FACTORS
    expression: str
    statement: str
    start: int  # of what is multiplied, in the text of the file
    end: int  # of a whole expression; `start` for an operand

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.kind}: `{self.expression}` in `{self.statement}`"


def hidden(text: str) -> str:
    """The text with comments, directives, strings and labels blanked, every place in it the same."""
    return HIDDEN.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def offered(code: str) -> Iterator[tuple[str, re.Match[str], int, int, str]]:
    """Kind, statement, and where the expression is and what, of every mutant; operands end at their start."""
    for statement in STATEMENT.finditer(code):
        if NO_PHYSICS.search(statement[0]):
            continue
        for sign in SIGN.finditer(statement[0]):
            if INDEX.search(statement[0], 0, sign.start()):
                continue
            start = statement.start() + sign.end()
            operand = OPERAND.match(code, start)
            for kind in ("sign", "drop"):
                yield kind, statement, start, start, sign[0][0] + " " + (operand[0] if operand else "(...)")
        whole = ASSIGNED.match(code, statement.start())
        if not whole or not COMPUTES.search(whole["expression"]):
            continue
        if "?" in whole["expression"] or not COMPARES.search(whole["expression"]):
            for kind in ("sign", "drop", "scale") if whole["by"] else ("scale",):
                yield kind, statement, *whole.span("expression"), whole["expression"]


def mutants_of(file: str, text: str) -> Iterator[Mutant]:
    """All mutants of a file."""
    lines = [0, *(found.end() for found in re.finditer("\n", text))]
    seen: dict[str, int] = {}
    for kind, statement, start, end, expression in offered(hidden(text)):
        flat = " ".join(statement[0].split())
        key = f"{file}\0{kind}\0{flat}\0{start - statement.start()}"
        seen[key] = seen.get(key, 0) + 1
        digest = hashlib.sha256(f"{key}\0{seen[key]}".encode()).hexdigest()[:8]
        name = f"{Path(file).stem}-{kind}-{digest}"
        line, last = (bisect.bisect_right(lines, place) for place in (start, statement.end()))
        yield Mutant(name, file, line, last, kind, " ".join(expression.split()), flat, start, end)


def draw(mutants: Sequence[Mutant], count: int) -> list[Mutant]:
    """The same `count` of them each time, by turns from every file and kind."""
    groups: dict[tuple[str, str], list[Mutant]] = {}
    for mutant in sorted(mutants, key=lambda m: m.name[-8:]):
        groups.setdefault((mutant.kind, mutant.file), []).append(mutant)
    turns = itertools.zip_longest(*(groups[key] for key in sorted(groups)))
    return [mutant for turn in turns for mutant in turn if mutant is not None][:count]


def planted(text: str, numbered: Mapping[int, Mutant]) -> str:
    """The text of a file with the factors of its mutants in; the compiler counts its lines as before."""
    insertions = []
    for number, mutant in numbered.items():
        factor = f"mutant({number}) * "
        if mutant.end == mutant.start:
            insertions.append((mutant.start, 1, factor))
        else:
            insertions += [(mutant.start, 0, f"{factor}("), (mutant.end, 0, ")")]
    for place, _, inserted in sorted(insertions, reverse=True):
        text = text[:place] + inserted + text[place:]
    return f'#include "{HEADER}"\n#line 1\n{text}'


def header(count: int) -> str:
    """What the planted sources include: the factors, all 1 but that of SLURRY_MUTANT."""
    return HEADER_TEXT.replace("COUNT", str(max(count, 1)))


HEADER_TEXT = """#pragma once
#include <array>
#include <cstdio>
#include <cstdlib>
#include <type_traits>

struct MutantFactor {
    float value;
};
struct MutantFactors {
    std::array<float, COUNT> of;
    MutantFactors() {
        of.fill(1);
        int number = 0;
        float factor = 1;
        const char* chosen = std::getenv("SLURRY_MUTANT");
        if (chosen != nullptr && std::sscanf(chosen, "%d:%f", &number, &factor) == 2) {
            of.at(static_cast<std::size_t>(number)) = factor;
        }
    }
};
inline const MutantFactors mutant_factors;

inline MutantFactor mutant(std::size_t number) { return {mutant_factors.of[number]}; }

inline MutantFactor operator*(MutantFactor a, MutantFactor b) { return {a.value * b.value}; }

template <class T> requires std::is_floating_point_v<T> T operator*(MutantFactor factor, T value) {
    return static_cast<T>(factor.value) * value;
}
template <class T> requires std::is_integral_v<T> float operator*(MutantFactor factor, T value) {
    return factor.value * static_cast<float>(value);
}
template <class T> requires requires { typename T::PlainObject; } // Eigen's
typename T::PlainObject operator*(MutantFactor factor, const T& value) {
    return static_cast<double>(factor.value) * value;
}
template <class T> // packs
requires(!std::is_arithmetic_v<T> && !requires { typename T::PlainObject; } &&
         requires(T value) { T(1.F * value); })
T operator*(MutantFactor factor, const T& value) {
    return T(factor.value * value);
}
"""
