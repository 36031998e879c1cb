#pragma once
// What a region has to fulfil before it is worth simulating.
#include "solver/geometry/region.hpp"

namespace slurry {

// Throws GeometryError, one line that names the walls and the place, at the first requirement that is not
// met.
void check_region(const Region& region, const Numerics& numerics);

} // namespace slurry
