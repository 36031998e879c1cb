// Density diffusion and its hydrostatic part.
#include "solver/terms/density_diffusion.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

// Rates of particles at rest: diffusion alone.
void diffuse(Scene scene, Particles& particles) {
    scene.numerics.compressibility = Compressibility::acoustic;
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->compute_density_rate(particles);
}

void stop(FluidParticles& fluid) {
    std::fill(fluid.velocity_x.begin(), fluid.velocity_x.end(), 0.0);
    std::fill(fluid.velocity_y.begin(), fluid.velocity_y.end(), 0.0);
}

TEST(DensityDiffusion, ExchangesBetweenPairsAndSoConserves) {
    Scene scene = doubly_periodic(12);
    scene.numerics.density_diffusion = 0.1;
    jitter(scene, 0.3);
    Particles particles = arrange(scene);
    disorder(particles, scene);
    stop(particles.fluid);
    diffuse(scene, particles);
    const FluidParticles& fluid = particles.fluid;
    std::vector<double> mass_rates; // V d rho / dt
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        mass_rates.push_back(fluid.mass / fluid.density[i] * fluid.density_rate[i]);
    }
    EXPECT_GT(sum_of_magnitudes(mass_rates), 0);
    EXPECT_LT(std::abs(sum_of(mass_rates)), 1e-12 * sum_of_magnitudes(mass_rates));
}

TEST(DensityDiffusion, DampsACheckerboardAtEveryParticle) {
    constexpr int n = 12;
    Scene scene = doubly_periodic(n);
    scene.numerics.density_diffusion = 0.1;
    Particles particles = arrange(scene);
    FluidParticles& fluid = particles.fluid;
    const double spacing = scene.numerics.particle_spacing;
    const auto sign = [&](std::size_t i) {
        const auto column = std::lround((fluid.x[i] - scene.domain.lower.x()) / spacing - 0.5);
        const auto row = std::lround((fluid.y[i] - scene.domain.lower.y()) / spacing - 0.5);
        return (column + row) % 2 == 0 ? 1 : -1;
    };
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.density[i] = 1000 + 1.0 * sign(i);
    }
    diffuse(scene, particles);
    // One acoustic step (0.25 h / c) must not overshoot: the rate stays below 2 / step.
    const double step = 0.25 * scene.numerics.smoothing_length() / scene.numerics.sound_speed;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        EXPECT_LT(fluid.density_rate[i] * sign(i), 0);
        EXPECT_LT(std::abs(fluid.density_rate[i]) * step, 2);
    }
}

TEST(DensityDiffusion, ConvergesToTheLaplacian) {
    // delta h c times the sum approximates delta h c Laplacian(rho) [molteni2009].
    Scene scene = doubly_periodic(40);
    scene.numerics.density_diffusion = 0.1;
    Particles particles = arrange(scene);
    FluidParticles& fluid = particles.fluid;
    const double wave_number = 2 * std::acos(-1.0);
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.density[i] = 1000 + std::cos(wave_number * fluid.x[i]);
    }
    diffuse(scene, particles);
    const double rate = 0.1 * scene.numerics.smoothing_length() * 10 * wave_number * wave_number;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        EXPECT_NEAR(fluid.density_rate[i], -rate * std::cos(wave_number * fluid.x[i]), 0.02 * rate);
    }
}

// Largest rate that a density of `waves` waves along the box decays with, per amplitude, 1/s.
double decay_of(const Scene& scene, int waves) {
    Particles particles = arrange(scene);
    FluidParticles& fluid = particles.fluid;
    const double wave_number = 2 * std::acos(-1.0) * waves;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.density[i] = 1000 + std::cos(wave_number * (fluid.x[i] - fluid.x[0]));
    }
    diffuse(scene, particles);
    return -fluid.density_rate[0];
}

TEST(DensityDiffusion, OfFourthOrderLeavesSmoothFieldsAloneAndDampsNoise) {
    Scene scene = doubly_periodic(40);
    scene.numerics.density_diffusion = 0.1;
    const double long_plain = decay_of(scene, 1);
    const double short_plain = decay_of(scene, 20);
    scene.numerics.fourth_order_diffusion_share = 0.9;
    const double long_mixed = decay_of(scene, 1);
    EXPECT_NEAR(long_mixed, 0.1 * long_plain, 0.005 * long_plain);
    EXPECT_NEAR(decay_of(scene, 2) - 0.1 * 4 * long_plain, 16 * (long_mixed - 0.1 * long_plain),
                0.01 * long_plain); // what it does grows with the fourth power of the wave number
    EXPECT_GT(decay_of(scene, 20), 0.25 * short_plain);
}

TEST(DensityDiffusion, FallsWithTheSpacingWhereViscosityDampsTheNoise) {
    Scene scene = doubly_periodic(12);
    scene.numerics.density_diffusion = 0.1;
    const double sound = scene.numerics.sound_speed * scene.numerics.smoothing_length();
    for (const auto& [sound_reynolds, expected] :
         {std::pair{0.0, 0.0}, {0.5, 0.02}, {2.5, 0.1}, {100.0, 0.1}}) {
        scene.fluid.dynamic_viscosity =
            sound_reynolds > 0 ? scene.fluid.density * sound / sound_reynolds : 1e300;
        EXPECT_NEAR(effective_density_diffusion(scene.fluid, scene.numerics), expected, 1e-12);
    }
    scene.fluid.dynamic_viscosity = 0;
    EXPECT_EQ(effective_density_diffusion(scene.fluid, scene.numerics), 0.1);
}

Particles hydrostatic(const Scene& scene) {
    Particles particles = arrange(scene);
    const double c = scene.numerics.sound_speed;
    const Vector slope = scene.fluid.density / (c * c) * scene.fluid.body_force;
    for (std::size_t i = 0; i < particles.fluid.size(); ++i) {
        particles.fluid.density[i] =
            scene.fluid.density + slope.dot(Vector(particles.fluid.x[i], particles.fluid.y[i]));
    }
    return particles;
}

TEST(HydrostaticDiffusion, LeavesAHydrostaticDensityAloneUpToTheWalls) {
    Scene scene = flat_channel(12);
    scene.numerics.density_diffusion = 0.1;
    scene.numerics.fourth_order_diffusion_share = 0.8;
    jitter(scene, 0.3);
    scene.fluid.body_force = {0, -3};
    Particles particles = hydrostatic(scene);
    diffuse(scene, particles);
    Particles uncorrected = hydrostatic(scene);
    scene.fluid.body_force = {0, 0};
    diffuse(scene, uncorrected);
    EXPECT_GT(largest(uncorrected.fluid.density_rate), 1);
    EXPECT_LT(largest(particles.fluid.density_rate), 1e-12 * largest(uncorrected.fluid.density_rate));
}

TEST(DensityDiffusion, IsBetweenFluidParticlesOnly) {
    Scene scene = flat_channel(12);
    scene.numerics.density_diffusion = 0.1;
    Particles particles = arrange(scene);
    for (double& density : particles.fluid.density) {
        density = 1020; // the walls' is 1000
    }
    diffuse(scene, particles);
    EXPECT_EQ(largest(particles.fluid.density_rate), 0);
}

} // namespace
} // namespace slurry::testing
