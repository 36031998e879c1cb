// The bound on displacements must hold for every near pair, and must not grow with what distant particles do.
#include "solver/loop/displacement_watch.hpp"

#include "tests/solver/scenes_for_tests.hpp"

#include <gtest/gtest.h>

namespace slurry::testing {
namespace {

constexpr double reach = 0.17;
const Vector cell(0.2, 0.2); // a fifth of the period

struct Watched {
    Scene scene;
    Particles particles;
    std::vector<double> x, y; // at the start
    DisplacementWatch watch;

    explicit Watched(const Scene& of) : scene(of), particles(arrange(of)) {
        x = particles.fluid.x;
        y = particles.fluid.y;
        x.insert(x.end(), particles.dummies.x.begin(), particles.dummies.x.end());
        y.insert(y.end(), particles.dummies.y.begin(), particles.dummies.y.end());
        watch.start(particles, x, y, scene.domain, cell);
    }
    [[nodiscard]] double largest() const { return watch.largest(particles); }
};

double near_distance(const Domain& domain, double dx, double dy) {
    const Vector length = domain.size();
    dx -= domain.periodic[0] ? std::round(dx / length.x()) * length.x() : 0;
    dy -= domain.periodic[1] ? std::round(dy / length.y()) * length.y() : 0;
    return std::hypot(dx, dy);
}

double apart(const Watched& watched, double nearer_than) {
    const FluidParticles& fluid = watched.particles.fluid;
    double largest = 0;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (near_distance(watched.scene.domain, watched.x[i] - watched.x[j],
                              watched.y[i] - watched.y[j]) < nearer_than) {
                largest =
                    std::max(largest, std::hypot(fluid.x[i] - watched.x[i] - fluid.x[j] + watched.x[j],
                                                 fluid.y[i] - watched.y[i] - fluid.y[j] + watched.y[j]));
            }
        }
    }
    return largest;
}

TEST(DisplacementWatch, BoundsEveryNearPairOfDisorderedParticles) {
    for (const Scene& scene : {doubly_periodic(20), flat_channel(20)}) {
        Watched watched(scene);
        disorder(watched.particles, scene);
        FluidParticles& fluid = watched.particles.fluid;
        for (std::size_t i = 0; i < fluid.size(); ++i) {
            fluid.x[i] += 0.01 * fluid.velocity_x[i];
            fluid.y[i] += 0.01 * fluid.velocity_y[i];
        }
        EXPECT_GE(watched.largest(), apart(watched, reach));
        EXPECT_LE(watched.largest(), 1.5 * apart(watched, 10));
    }
}

TEST(DisplacementWatch, SeesOneParticleMoveAcrossAPeriodicSide) {
    for (std::size_t i = 0; i < 400; i += 7) {
        Watched watched(doubly_periodic(20));
        watched.particles.fluid.x[i] += 0.03;
        watched.particles.fluid.y[i] -= 0.04;
        EXPECT_NEAR(watched.largest(), 0.05, 1e-14);
    }
}

TEST(DisplacementWatch, CommonMotionIsNoDisplacement) {
    Watched watched(doubly_periodic(20));
    for (double& x : watched.particles.fluid.x) {
        x += 5;
    }
    EXPECT_NEAR(watched.largest(), 0, 1e-14);
}

TEST(DisplacementWatch, AShearCountsOnlyAcrossNearParticles) {
    Watched watched(flat_channel(40, 1));
    FluidParticles& fluid = watched.particles.fluid;
    for (std::size_t i = 0; i < fluid.size(); ++i) {
        fluid.x[i] += 0.1 * (fluid.y[i] - 0.2); // 0.1 from floor to lid
    }
    watched.particles.time += 0.1;
    EXPECT_GE(watched.largest(), 0.1 * reach);
    EXPECT_LE(watched.largest(), 0.1 * 2.5 * reach);
}

TEST(DisplacementWatch, SeesAWallMovePastTheFluid) {
    Scene scene = flat_channel(20, 0);
    scene.walls[0].shape = CosineShape{0.35, 0.05, 1, 0};
    scene.walls[0].velocity = {0.5, 0};
    Watched watched(scene);
    watched.particles.time += 0.1;
    EXPECT_NEAR(watched.largest(), 0.05, 1e-14);
}

} // namespace
} // namespace slurry::testing
