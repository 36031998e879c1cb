#pragma once
#include "solver/scene/scene.hpp"

#include <cmath>

namespace slurry {

// The shortest of an offset and its periodic images, m.
inline Vector nearest_image(Vector offset, const Domain& domain) {
    for (const int axis : {0, 1}) {
        if (domain.periodic[static_cast<std::size_t>(axis)]) {
            offset[axis] = std::remainder(offset[axis], domain.size()[axis]);
        }
    }
    return offset;
}

// The periodic image of a point that is in the domain, m.
inline Vector wrapped(Vector point, const Domain& domain) {
    for (const int axis : {0, 1}) {
        if (domain.periodic[static_cast<std::size_t>(axis)]) {
            const double size = domain.size()[axis];
            point[axis] -= std::floor((point[axis] - domain.lower[axis]) / size) * size;
        }
    }
    return point;
}

} // namespace slurry
