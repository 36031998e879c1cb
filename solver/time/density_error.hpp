#pragma once
// What to do when the density of the fluid, which should not change, does.
#include "solver/geometry/region.hpp"
#include "solver/particles/particles.hpp"
#include "solver/particles/start_jump.hpp"

#include <filesystem>
#include <limits>
#include <string>

namespace slurry {

// What is known of a density that is too far off.
struct DensityFault {
    double time = 0;                                      // s
    double fluid_speed = 0;                               // m/s, of the fastest particle
    double gap = std::numeric_limits<double>::infinity(); // m, between the solids on both sides of it
    StartJump jump;                                       // of a wall
};

// The largest density error without a warning, as a share of the density: the project's limit of survival.
inline constexpr double largest_trusted_density_error = 0.05;

// The likeliest reason and what to do about it, one clause, in this order: walls, discs or a start that are
// too fast, a jump that sound has not left the domain since, no transport velocity, fluid that is too fast, a
// gap of too few particles; what often helps where none of them applies.
[[nodiscard]] std::string density_advice(const Scene& scene, const DensityFault& fault);

// Width of the gap at a place in the fluid, m: between its two nearest walls or discs, infinite when they do
// not face each other.
[[nodiscard]] double gap_around(const Particles& particles, const Region& region, const Vector& place);

// One line for the summary of a run when the largest sample of /series/largest_density_error in a result is
// above the 1 % that a sound speed is chosen for, and not yet worth a warning; else empty. Throws ReadError.
[[nodiscard]] std::string density_note(const std::filesystem::path& result, const Scene& scene);

// One line when the largest sample of /series/largest_density_error in a result is more than
// largest_trusted_density_error, else empty. The time step (s) is the run's. Throws ReadError.
[[nodiscard]] std::string density_warning(const std::filesystem::path& result, const Scene& scene,
                                          const Region& region, double time_step);

} // namespace slurry
