#pragma once
// Sums and extremes over the fluid.
#include "solver/vector.hpp"

#include <span>

namespace slurry {

struct Totals {
    double kinetic_energy;        // J/m (per metre of depth)
    Vector momentum;              // kg/s (kg m/s per metre of depth)
    double mean_density;          // kg/m3, over particles
    double largest_speed;         // m/s
    double largest_density_error; // largest |density / reference - 1|
};

// Over fluid particles of equal mass (kg/m); the spans have equal length. Sums run in the order of the spans,
// so the answer does not depend on threads. One value that is not a number makes every total it enters NaN;
// so does no particle at all for the mean density.
[[nodiscard]] Totals fluid_totals(std::span<const double> velocity_x, std::span<const double> velocity_y,
                                  std::span<const double> density, double particle_mass,
                                  double reference_density);

} // namespace slurry
