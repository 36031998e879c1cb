#pragma once
// The fluid's velocity at the start.
#include "solver/scene/scene.hpp"

#include <cmath>
#include <numbers>

namespace slurry {

// At a place in the domain, m/s.
inline Vector start_velocity(const Scene& scene, const Vector& position) {
    const Start& start = scene.start;
    const Vector size = scene.domain.size();
    const Vector from_corner = position - scene.domain.lower;
    if (start.velocity == InitialVelocity::taylor_green) {
        const double x = 2 * std::numbers::pi * from_corner.x() / size.x();
        const double y = 2 * std::numbers::pi * from_corner.y() / size.x();
        return {-start.speed * std::cos(x) * std::sin(y), start.speed * std::sin(x) * std::cos(y)};
    }
    return {start.velocity == InitialVelocity::shear ? start.speed * from_corner.y() / size.y() : 0, 0};
}

} // namespace slurry
