#include "solver/discs/clearance.hpp"

#include "solver/discs/nearest_image.hpp"

#include <algorithm>
#include <limits>

namespace slurry {

double clearance(std::span<const Disc> discs, const Domain& domain, const Vector& point) {
    double least = std::numeric_limits<double>::infinity();
    for (const Disc& disc : discs) {
        least = std::min(least, nearest_image(point - disc.position, domain).norm() - disc.radius);
    }
    return least;
}

} // namespace slurry
