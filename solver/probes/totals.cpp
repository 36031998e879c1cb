#include "solver/probes/totals.hpp"

#include <cmath>

namespace slurry {

namespace {

// std::max would lose a NaN.
double larger(double largest, double value) {
    return value > largest || std::isnan(value) ? value : largest;
}

} // namespace

Totals fluid_totals(std::span<const double> velocity_x, std::span<const double> velocity_y,
                    std::span<const double> density, double particle_mass, double reference_density) {
    Vector velocity_sum = Vector::Zero();
    double square_sum = 0;
    double density_sum = 0;
    double largest_square = 0;
    double largest_density_error = 0;
    for (std::size_t i = 0; i < density.size(); ++i) {
        const Vector velocity(velocity_x[i], velocity_y[i]);
        velocity_sum += velocity;
        square_sum += velocity.squaredNorm();
        density_sum += density[i];
        largest_square = larger(largest_square, velocity.squaredNorm());
        largest_density_error = larger(largest_density_error, std::abs(density[i] / reference_density - 1));
    }
    return {.kinetic_energy = 0.5 * particle_mass * square_sum,
            .momentum = particle_mass * velocity_sum,
            .mean_density = density_sum / static_cast<double>(density.size()),
            .largest_speed = std::sqrt(largest_square),
            .largest_density_error = largest_density_error};
}

} // namespace slurry
