#pragma once
// A convergence study as a table for the terminal, as JSON and as a figure.
#include "solver/converge/requirement.hpp"
#include "solver/converge/study.hpp"

#include <span>
#include <string>

namespace slurry {

// Runs, quantities with their bands, and what the wanted errors need.
[[nodiscard]] std::string study_text(const Study& study, std::span<const Plan> plans);

// The same for programs: SI units, names of quantities as in the table, null for what is not known.
[[nodiscard]] std::string study_json(const Study& study, std::span<const Plan> plans);

// SVG: a panel for each quantity, its values against the spacing, the curve through them and the band.
[[nodiscard]] std::string study_svg(const Study& study);

// "converging", "settled", "scattered" or "not converging".
[[nodiscard]] std::string_view verdict_name(Verdict verdict);

} // namespace slurry
