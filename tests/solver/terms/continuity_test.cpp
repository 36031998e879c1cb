// Continuity (2.14) and its gradient correction (2.21, 2.22).
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

struct Blob {
    Scene scene;
    Particles particles;
};

// Particles without walls or periodic sides around them, moving with v = shift + gradient x.
Blob linear_flow(const Matrix& gradient, bool correction, double disorder_amplitude) {
    Blob blob{doubly_periodic(16), {}};
    blob.scene.numerics.compressibility = Compressibility::acoustic;
    if (disorder_amplitude > 0) {
        jitter(blob.scene, disorder_amplitude);
    }
    blob.particles = arrange(blob.scene);
    blob.scene.domain.periodic = {false, false};
    blob.scene.numerics.gradient_correction = correction;
    FluidParticles& fluid = blob.particles.fluid;
    if (disorder_amplitude > 0) {
        disorder(blob.particles, blob.scene);
    }
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vector velocity = Vector(3, -2) + gradient * Vector(fluid.x[i], fluid.y[i]);
        fluid.velocity_x[i] = velocity.x();
        fluid.velocity_y[i] = velocity.y();
    }
    return blob;
}

bool has_full_support(const Blob& blob, std::size_t i) {
    const double reach = 3 * blob.scene.numerics.smoothing_length();
    const Vector position(blob.particles.fluid.x[i], blob.particles.fluid.y[i]);
    return (position - blob.scene.domain.lower).minCoeff() > reach &&
           (blob.scene.domain.upper - position).minCoeff() > reach;
}

// Largest |d rho / dt + rho div v| / rho over particles with full support.
double divergence_error(Blob& blob, double divergence) {
    const auto interactions = make_interactions(blob.scene);
    interactions->refresh_neighbours(blob.particles);
    interactions->compute_density_rate(blob.particles);
    const FluidParticles& fluid = blob.particles.fluid;
    std::vector<double> errors;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        if (has_full_support(blob, i)) {
            errors.push_back(fluid.density_rate[i] / fluid.density[i] + divergence);
        }
    }
    EXPECT_GT(errors.size(), 50U);
    return largest(errors);
}

Matrix gradient_of(double xx, double xy, double yx, double yy) {
    Matrix gradient;
    gradient << xx, xy, yx, yy;
    return gradient;
}

TEST(CorrectedContinuity, IsExactForLinearVelocitiesOnDisorderedParticles) {
    for (const Matrix& gradient :
         {gradient_of(1, 0, 0, 0), gradient_of(0, 1, 0, 0), gradient_of(0, 0, 1, 0), gradient_of(0, 0, 0, 1),
          gradient_of(2, -3, 0.5, -1), gradient_of(0, -1, 1, 0)}) {
        Blob blob = linear_flow(gradient, true, 0.3);
        EXPECT_LT(divergence_error(blob, gradient.trace()), 1e-12) << gradient;
    }
}

TEST(CorrectedContinuity, IsNeededForThat) {
    Blob blob = linear_flow(gradient_of(1, 0, 0, 0), false, 0.3);
    EXPECT_GT(divergence_error(blob, 1), 0.01);
}

TEST(Continuity, OfAnExpandingLatticeIsCloseWithoutTheCorrection) {
    Blob blob = linear_flow(gradient_of(1, 0, 0, 1), false, 0);
    EXPECT_LT(divergence_error(blob, 2),
              0.01); // what the sum over a lattice with h = dx misses of the integral
}

TEST(Continuity, OfACommonVelocityVanishes) {
    for (const bool correction : {false, true}) {
        Blob blob = linear_flow(Matrix::Zero(), correction, 0.3);
        EXPECT_EQ(divergence_error(blob, 0), 0);
    }
}

TEST(Continuity, WallThatApproachesCompressesTheFluidBesideIt) {
    Scene scene = flat_channel(12);
    Particles particles = arrange(scene);
    for (std::size_t d = 0; d < particles.dummies.size(); ++d) {
        particles.dummies.solid_velocity_y[d] = particles.dummies.wall[d] == 1 ? -1 : 0;
    }
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->compute_density_rate(particles);
    for (std::size_t i = 0; i < particles.fluid.size(); ++i) {
        const double depth = scene.domain.upper.y() - particles.fluid.y[i];
        if (depth < 2 * scene.numerics.particle_spacing) {
            EXPECT_GT(particles.fluid.density_rate[i], 0);
        } else if (depth > 3 * scene.numerics.particle_spacing) {
            EXPECT_EQ(particles.fluid.density_rate[i], 0);
        }
    }
}

} // namespace
} // namespace slurry::testing
