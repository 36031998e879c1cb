#pragma once
// A periodic curve, cut elsewhere.
#include "solver/geometry/curve.hpp"
#include "solver/scene/scene.hpp"

#include <vector>

namespace slurry {

using Pieces = std::vector<Piece>;

// The same periodic curve with its first point at the domain's left side; lengths that differ by less than
// `rounding` of the domain's width are equal.
Pieces from_the_left(const Pieces& pieces, const Domain& domain, double rounding);

} // namespace slurry
