#pragma once
#include "solver/particles/disc.hpp"

#include <span>

namespace slurry {

// Signed distance of a point to the nearest rim of a disc, periodic images included, m: negative in a disc,
// infinite without discs.
double clearance(std::span<const Disc> discs, const Domain& domain, const Vector& point);

} // namespace slurry
