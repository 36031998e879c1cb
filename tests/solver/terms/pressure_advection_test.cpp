// A pressure that is at rest in the frame of the rough walls does not compress.
#include "solver/terms/equation_of_state.hpp"
#include "solver/terms/steady_frame.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace slurry::testing {
namespace {

WallScene wall(Shape shape, const Vector& velocity) {
    WallScene result;
    result.shape = shape;
    result.velocity = velocity;
    return result;
}

const LineShape flat{};
const CosineShape rough{};

TEST(SteadyFrame, IsThatOfTheRoughWalls) {
    Scene scene;
    EXPECT_EQ(steady_frame(scene), Vector(0, 0));
    scene.walls = {wall(flat, {3, 0})};
    EXPECT_EQ(steady_frame(scene), Vector(0, 0));
    scene.walls = {wall(flat, {3, 0}), wall(rough, {-1, 0})};
    EXPECT_EQ(steady_frame(scene), Vector(-1, 0));
    scene.walls = {wall(rough, {-1, 0}), wall(rough, {-1, 0})};
    EXPECT_EQ(steady_frame(scene), Vector(-1, 0));
}

TEST(SteadyFrame, IsNotThereForWallsThatMoveApartNorForDiscsAlone) {
    Scene scene;
    scene.walls = {wall(rough, {-1, 0}), wall(rough, {0, 0})};
    EXPECT_FALSE(steady_frame(scene));
    scene.walls = {wall(flat, {3, 0})};
    scene.discs.emplace_back();
    EXPECT_FALSE(steady_frame(scene));
}

// All particles move with `velocity` in a density wave along the axis (0: x, 1: y); largest difference of the
// rate from `expected` times the density's slope, over the largest slope.
double advection_error(Compressibility compressibility, const Vector& velocity, Eigen::Index axis,
                       double expected) {
    constexpr int n = 48;
    Scene scene = doubly_periodic(n);
    scene.numerics.compressibility = compressibility;
    scene.numerics.density_diffusion = 0;
    Particles particles = arrange(scene);
    FluidParticles& fluid = particles.fluid;
    fluid.shift_time = 1;
    const std::vector<double>& along = axis == 0 ? fluid.x : fluid.y;
    const double wave_number = 2 * std::numbers::pi / scene.domain.size()[axis];
    const double amplitude = 1e-3 * scene.fluid.density;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.density[i] = scene.fluid.density + amplitude * std::sin(wave_number * along[i]);
        fluid.velocity_x[i] = 0.75 * velocity.x(); // and the rest as the shift
        fluid.background_x[i] = 0.25 * velocity.x();
        fluid.velocity_y[i] = 0.5 * velocity.y();
        fluid.background_y[i] = 0.5 * velocity.y();
    }
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->compute_density_rate(particles);
    std::vector<double> errors;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const double slope = std::cos(wave_number * along[i]);
        errors.push_back(fluid.density_rate[i] / (amplitude * wave_number) - expected * slope);
    }
    return largest(errors);
}

TEST(PressureAdvection, TakesTheCompressionAlongAParticlesPathOut) {
    const Vector velocity(0.4, -0.3);
    for (const Eigen::Index axis : {0, 1}) {
        const double speed = std::abs(velocity[axis]);
        const auto error = [&](Compressibility compressibility, double expected) {
            return advection_error(compressibility, velocity, axis, expected) / speed;
        };
        // The kernel's own error for a wave of 48 particles is 0.4 %.
        EXPECT_LT(error(Compressibility::steady_frame, velocity[axis]), 0.006);
        EXPECT_LT(error(Compressibility::acoustic, 0), 1e-3);
        EXPECT_GT(error(Compressibility::acoustic, velocity[axis]), 0.9);
    }
}

} // namespace
} // namespace slurry::testing
