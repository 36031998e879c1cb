#pragma once
// Pressure and velocity at one point of the fluid.
#include "solver/geometry/region.hpp"
#include "solver/particles/disc.hpp"
#include "solver/probes/particle_finder.hpp"

#include <span>

namespace slurry {

struct PointValues {   // NaN outside the fluid, and where the particles around do not determine them
    double pressure;   // Pa
    double velocity_x; // m/s
    double velocity_y; // m/s
};

// `time` in s, the instant of the particles: it says where the walls stand. What is in a disc is not fluid.
[[nodiscard]] PointValues probe_point(const ParticleFinder& particles, const Region& region,
                                      const Vector& position, double time, std::span<const Disc> discs = {});

} // namespace slurry
