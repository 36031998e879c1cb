#pragma once
// The particle spacings of a convergence study.
#include "solver/scene/scene.hpp"

#include <string>
#include <vector>

namespace slurry {

// The particle spacing nearest to `wanted` (m) of which the domain's sides are whole multiples, as nearly as
// its proportions allow: the lattice would be stretched by what is left, and that changes from one spacing to
// the next like noise.
[[nodiscard]] double admissible_spacing(const Domain& domain, double wanted);

// `count` spacings, coarsest first, each about sqrt(2) times the next; the last is the admissible one nearest
// to `finest`.
[[nodiscard]] std::vector<double> study_spacings(const Domain& domain, double finest, int count);

// What a user is told whose spacing `wanted` became `taken` (both m), and why; empty where they are the same.
[[nodiscard]] std::string adaptation(const Domain& domain, double wanted, double taken);

} // namespace slurry
