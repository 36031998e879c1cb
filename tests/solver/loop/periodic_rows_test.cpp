// Wrapping, sorting and the displacement that decides when neighbour lists are made anew.
#include "solver/loop/periodic_rows.hpp"

#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

#include <set>

namespace slurry::testing {
namespace {

constexpr double row_reach = 0.3;

// A quantity that names its particle travels with it through every array.
void tag(Particles& particles) {
    for (std::size_t i = 0; i < particles.fluid.size(); ++i) {
        particles.fluid.each_array([&](std::vector<double>& array) {
            if (&array != &particles.fluid.x && &array != &particles.fluid.y) {
                array[i] = particles.fluid.identity[i];
            }
        });
    }
}

TEST(PeriodicRows, SortingKeepsEachParticleTogether) {
    Scene scene = flat_channel(12);
    jitter(scene, 0.3);
    Particles particles = arrange(scene);
    tag(particles);
    const Particles before = particles;
    PeriodicRows rows;
    rows.rebuild(particles, scene.domain, row_reach, row_reach);
    std::set<std::uint32_t> identities;
    for (std::size_t i = 0; i < particles.fluid.size(); ++i) {
        const std::uint32_t identity = particles.fluid.identity[i];
        identities.insert(identity);
        EXPECT_EQ(particles.fluid.x[i], before.fluid.x[identity]);
        EXPECT_EQ(particles.fluid.y[i], before.fluid.y[identity]);
        particles.fluid.each_array([&](std::vector<double>& array) {
            if (&array != &particles.fluid.x && &array != &particles.fluid.y) {
                EXPECT_EQ(array[i], identity);
            }
        });
    }
    EXPECT_EQ(identities.size(), before.fluid.size());
}

TEST(PeriodicRows, SortedDummiesStayWithTheirWall) {
    const Scene scene = flat_channel(12, 1);
    Particles particles = arrange(scene);
    PeriodicRows rows;
    rows.rebuild(particles, scene.domain, row_reach, row_reach);
    for (std::size_t d = 0; d < particles.dummies.size(); ++d) {
        EXPECT_EQ(particles.dummies.wall[d], particles.dummies.y[d] < 0.7 ? 0 : 1);
        EXPECT_EQ(particles.dummies.x[d], particles.dummies.start_x[d]);
        EXPECT_EQ(particles.dummies.y[d], particles.dummies.start_y[d]);
    }
}

TEST(PeriodicRows, WrapsParticlesIntoTheDomainAndMovesTheDummiesStartAlong) {
    const Scene scene = flat_channel(12, 1);
    Particles particles = arrange(scene);
    for (double& x : particles.fluid.x) {
        x += 2.7;
    }
    particles.dummies.move_walls_to(3.4);
    PeriodicRows rows;
    rows.rebuild(particles, scene.domain, row_reach, row_reach);
    for (const auto* positions : {&particles.fluid.x, &particles.dummies.x}) {
        for (const double x : *positions) {
            EXPECT_GE(x, scene.domain.lower.x());
            EXPECT_LE(x, scene.domain.upper.x());
        }
    }
    const std::vector<double> wrapped = particles.dummies.x;
    particles.dummies.move_walls_to(3.4); // the same time: wrapping is not undone
    for (std::size_t d = 0; d < wrapped.size(); ++d) {
        EXPECT_NEAR(particles.dummies.x[d], wrapped[d], 1e-14);
    }
}

TEST(PeriodicRows, CopiesLieOnePeriodAwayWithinReach) {
    const Scene scene = doubly_periodic(12);
    Particles particles = arrange(scene);
    PeriodicRows rows;
    rows.rebuild(particles, scene.domain, row_reach, row_reach);
    EXPECT_EQ(rows.row_count(), rows.particle_count() + rows.copies().size() + 1);
    for (std::size_t c = 0; c < rows.copies().size(); ++c) {
        const PeriodicRows::Copy& copy = rows.copies()[c];
        const std::size_t row = rows.particle_count() + c;
        EXPECT_EQ(rows.x()[row], rows.x()[copy.source] + copy.shift.x());
        EXPECT_EQ(rows.y()[row], rows.y()[copy.source] + copy.shift.y());
        EXPECT_GT(copy.shift.norm(), 0);
    }
    // 12 x 12 particles; 4 layers (0.3 of 1, of 12) on each side: (12 + 8)^2 - 12^2
    EXPECT_EQ(rows.copies().size(), 256U);
}

} // namespace
} // namespace slurry::testing
