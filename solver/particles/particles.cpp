#include "solver/particles/particles.hpp"

#include <numeric>

namespace slurry {

void FluidParticles::resize(std::size_t count) {
    each_array([count](std::vector<double>& array) { array.resize(count); });
    identity.resize(count);
    std::iota(identity.begin(), identity.end(), 0U);
}

void DummyParticles::resize(std::size_t count) {
    each_array([count](auto& array) { array.resize(count); });
}

void DummyParticles::move_to(double time) {
    for (std::size_t d = 0; d < size(); ++d) {
        const Vector& drift = wall_drift[static_cast<std::size_t>(wall[d])];
        x[d] = start_x[d] + drift.x() * time;
        y[d] = start_y[d] + drift.y() * time;
    }
}

} // namespace slurry
