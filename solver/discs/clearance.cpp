#include "solver/discs/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slurry {

double clearance(std::span<const Disc> discs, const Domain& domain, const Vector& point) {
    const Vector size = domain.size();
    double least = std::numeric_limits<double>::infinity();
    for (const Disc& disc : discs) {
        Vector offset = point - disc.position;
        for (const int axis : {0, 1}) {
            if (domain.periodic[static_cast<std::size_t>(axis)]) {
                offset[axis] -= std::round(offset[axis] / size[axis]) * size[axis];
            }
        }
        least = std::min(least, offset.norm() - disc.radius);
    }
    return least;
}

} // namespace slurry
