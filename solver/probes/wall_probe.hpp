#pragma once
// Pressure and shear stress along a wall.
#include "solver/geometry/wall.hpp"
#include "solver/probes/particle_finder.hpp"

#include <span>
#include <vector>

namespace slurry {

struct WallValues {               // one per point; NaN where the particles around do not determine it
    std::vector<double> pressure; // Pa
    std::vector<double>
        shear; // Pa, the tangential traction of the wall on the fluid, positive along the tangent
};

// `points` (Wall::sample) lie on the wall where it stood at time 0, and are moved with it to `time` (s), the
// instant of the particles. dynamic_viscosity in Pa s.
[[nodiscard]] WallValues probe_wall(const ParticleFinder& particles, const Wall& wall,
                                    std::span<const WallPoint> points, double time, double dynamic_viscosity);

} // namespace slurry
