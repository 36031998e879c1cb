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

void DummyParticles::move_walls_to(double time) {
    for (std::size_t d = 0; d < first_of_discs; ++d) {
        const Vector& drift = wall_drift[static_cast<std::size_t>(wall[d])];
        x[d] = start_x[d] + drift.x() * time;
        y[d] = start_y[d] + drift.y() * time;
    }
}

std::size_t FluidParticles::bytes() const {
    std::size_t sum =
        identity.capacity() * sizeof(std::uint32_t) + number_density_volume.capacity() * sizeof(double);
    each_array_of(*this, [&](const auto& array) { sum += array.capacity() * sizeof(array[0]); });
    return sum;
}

std::size_t DummyParticles::bytes() const {
    std::size_t sum = 0;
    each_array_of(*this, [&](const auto& array) { sum += array.capacity() * sizeof(array[0]); });
    return sum;
}

} // namespace slurry
