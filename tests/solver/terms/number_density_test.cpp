// Particle volumes: 1 / sum W (below Eq. 2.8), or m / rho.
#include "solver/terms/particle_volume.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

Particles with_volumes(Scene scene, ParticleVolume kind) {
    scene.numerics.particle_volume = kind;
    Particles particles = arrange(scene);
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->compute_volumes(particles);
    return particles;
}

TEST(ParticleVolume, OfALatticeIsTheCellUpToTheWalls) {
    for (const Scene& scene : {doubly_periodic(12), flat_channel(12)}) {
        const Particles particles = with_volumes(scene, ParticleVolume::number_density);
        for (const double volume : particles.fluid.number_density_volume) {
            EXPECT_NEAR(volume * 144, 1,
                        0.002); // sum W over a lattice with h = dx is within 0.2 % of its integral
        }
        for (const auto kind : {ParticleVolume::mass_over_density, ParticleVolume::constant}) {
            EXPECT_NEAR(particle_volume(particles.fluid, 0, kind, scene.fluid.density) * 144, 1, 1e-12);
        }
    }
}

TEST(ParticleVolume, ByNumberDensityIsSmallerInACluster) {
    Scene scene = doubly_periodic(12);
    Particles particles = arrange(scene);
    FluidParticles& fluid = particles.fluid;
    const Vector centre = scene.domain.lower + 0.5 * scene.domain.size();
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const Vector offset = Vector(fluid.x[i], fluid.y[i]) - centre;
        if (offset.norm() < 0.3) { // contract towards the centre
            fluid.x[i] = centre.x() + 0.8 * offset.x();
            fluid.y[i] = centre.y() + 0.8 * offset.y();
        }
    }
    scene.numerics.particle_volume = ParticleVolume::number_density;
    const auto interactions = make_interactions(scene);
    interactions->refresh_neighbours(particles);
    interactions->compute_volumes(particles);
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        const bool nearer = std::hypot(fluid.x[i] - centre.x(), fluid.y[i] - centre.y()) <
                            std::hypot(fluid.x[nearest] - centre.x(), fluid.y[nearest] - centre.y());
        nearest = nearer ? i : nearest;
    }
    EXPECT_NEAR(fluid.number_density_volume[nearest] * 144, 0.64, 0.05);
}

} // namespace
} // namespace slurry::testing
