// What dummies take from the fluid, Eqs. 2.16 and 2.17.
#include "solver/terms/wall_extrapolation.hpp"

#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

Scene channel_with_means(double lid_speed) {
    Scene scene = flat_channel(12, lid_speed);
    scene.numerics.wall_extrapolation = WallExtrapolation::mean;
    return scene;
}

void extrapolate(const Scene& scene, Particles& particles) {
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->compute_volumes(particles);
    interactions->extrapolate_to_walls(particles);
}

// Dummies of the two layers nearest to their wall: the fluid is in their reach for certain.
bool is_near_fluid(const Scene& scene, const Particles& particles, std::size_t d) {
    const double y = particles.dummies.y[d];
    const double depth =
        particles.dummies.wall[d] == 0 ? scene.domain.lower.y() - y : y - scene.domain.upper.y();
    return depth < 2 * scene.numerics.particle_spacing;
}

template <class Check> void for_near_dummies(const Scene& scene, const Particles& particles, Check&& check) {
    std::size_t near = 0;
    for (std::size_t d = 0; d < particles.dummies.size(); ++d) {
        if (is_near_fluid(scene, particles, d)) {
            check(d);
            ++near;
        }
    }
    EXPECT_EQ(near, 2 * 2 * 12U);
}

TEST(WallExtrapolation, ReproducesAConstantOnDisorderedParticles) {
    Scene scene = channel_with_means(0.7);
    jitter(scene, 0.3);
    Particles particles = arrange(scene);
    FluidParticles& fluid = particles.fluid;
    std::fill(fluid.velocity_x.begin(), fluid.velocity_x.end(), 0.4);
    std::fill(fluid.velocity_y.begin(), fluid.velocity_y.end(), -0.1);
    std::fill(fluid.pressure.begin(), fluid.pressure.end(), 123.0);
    extrapolate(scene, particles);
    const DummyParticles& dummies = particles.dummies;
    for_near_dummies(scene, particles, [&](std::size_t d) {
        const double wall_speed = dummies.wall[d] == 0 ? 0 : 0.7;
        EXPECT_NEAR(dummies.velocity_x[d], 2 * wall_speed - 0.4, 1e-13); // 2.16: mirrored about the wall's
        EXPECT_NEAR(dummies.velocity_y[d], 0.1, 1e-13);
        EXPECT_NEAR(dummies.pressure[d], 123, 1e-10);
    });
}

TEST(WallExtrapolation, ContinuesAHydrostaticPressureIntoTheWall) {
    Scene scene = channel_with_means(0);
    jitter(scene, 0.3);
    scene.fluid.body_force = {0.3, -9.81};
    Particles particles = arrange(scene);
    const auto pressure_at = [&](double x, double y) {
        return 200 + scene.fluid.density * scene.fluid.body_force.dot(Vector(x, y));
    };
    FluidParticles& fluid = particles.fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.pressure[i] = pressure_at(fluid.x[i], fluid.y[i]);
        fluid.density[i] = scene.fluid.density;
    }
    extrapolate(scene, particles);
    const DummyParticles& dummies = particles.dummies;
    for_near_dummies(scene, particles, [&](std::size_t d) {
        const double margin =
            3.4 * scene.numerics.particle_spacing; // the pressure itself is not periodic in x
        const double x = dummies.x[d];
        if (x - scene.domain.lower.x() > margin && scene.domain.upper.x() - x > margin) {
            EXPECT_NEAR(dummies.pressure[d], pressure_at(x, dummies.y[d]), 1e-8);
        }
    });
}

TEST(WallExtrapolation, NeverGivesAValueThatIsNotFinite) {
    Scene scene = channel_with_means(1);
    Particles particles = arrange(scene);
    disorder(particles, scene);
    for (double& y : particles.fluid.y) {
        y = 0.5 * (y + 0.7); // the fluid leaves both walls: dummies without neighbours
    }
    extrapolate(scene, particles);
    for (const auto* values :
         {&particles.dummies.velocity_x, &particles.dummies.velocity_y, &particles.dummies.pressure}) {
        EXPECT_TRUE(std::isfinite(largest(*values)));
    }
    EXPECT_EQ(largest(particles.dummies.pressure), 0);
}

// A lone neighbour at the edge of a kernel's support may weigh less than can be divided by.
TEST(WallExtrapolation, IsFiniteWhateverTheFluidWeighs) {
    for (const float weight : {0.0F, 1e-45F, 1e-40F, 1e-36F, 1e-31F, 1e-20F}) {
        MeanView<float> dummy{};
        const ExtrapolationCoefficients<float> coefficients{1};
        Extrapolation<float> result{};
        VelocityExtrapolation::finish<float, float>({weight, 0, 2 * weight}, dummy, coefficients, result);
        PressureExtrapolation::finish<float, float>({weight, 3 * weight, 0, 0}, dummy, coefficients, result);
        EXPECT_EQ(result.velocity_x, 0) << weight;
        EXPECT_TRUE(result.velocity_y == 0 || std::abs(result.velocity_y - 2) < 1e-5) << weight;
        EXPECT_TRUE(result.pressure == 0 || std::abs(result.pressure - 3) < 1e-5) << weight;
    }
}

} // namespace
} // namespace slurry::testing
