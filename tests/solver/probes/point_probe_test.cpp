#include "solver/probes/point_probe.hpp"

#include "solver/probes/grid_probe.hpp"
#include "tests/solver/probes/exact_channel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

namespace slurry::test {
namespace {

ExactChannel rough_channel() {
    return {CosineShape{5e-6, -5e-6, 3e-5, 0}, 3e-5};
}

Scene scene_of(const ExactChannel& channel, double spacing) {
    Scene scene;
    scene.domain = channel.domain();
    scene.numerics.particle_spacing = spacing;
    scene.walls = {channel.pad(), channel.wafer()};
    return scene;
}

struct PointErrors { // relative L2 over the grid's points in the fluid
    double pressure, velocity;
};

PointErrors grid_errors(double spacing, double jitter) {
    const ExactChannel channel = rough_channel();
    const Region region(scene_of(channel, spacing));
    const Particles particles = channel.sample(spacing, jitter);
    const ParticleFinder finder(particles.view(), channel.domain(), spacing);
    const GridAxes axes = grid_axes(channel.domain(), {24, 17});
    const GridValues values = probe_grid(finder, region, axes, 0);
    double pressure_error = 0;
    double pressure_scale = 0;
    double velocity_error = 0;
    double velocity_scale = 0;
    for (std::size_t k = 0; k < values.pressure.size(); ++k) {
        const Vector point(axes.x[k % 24], axes.y[k / 24]);
        EXPECT_EQ(std::isnan(values.pressure[k]), point.y() <= channel.height(point.x()))
            << point.transpose();
        if (std::isnan(values.pressure[k])) {
            continue;
        }
        const Vector velocity(values.velocity_x[k], values.velocity_y[k]);
        pressure_error += std::pow(values.pressure[k] - channel.pressure(point), 2);
        pressure_scale += std::pow(channel.pressure(point), 2);
        velocity_error += (velocity - channel.velocity(point)).squaredNorm();
        velocity_scale += channel.velocity(point).squaredNorm();
    }
    return {std::sqrt(pressure_error / pressure_scale), std::sqrt(velocity_error / velocity_scale)};
}

TEST(GridProbe, IsWithinATenthOfAPercentOfExactFieldsAndNaNBehindWalls) {
    for (const double jitter : {0.0, 0.3}) {
        const PointErrors errors = grid_errors(2.5e-7, jitter);
        std::cout << "pressure " << 100 * errors.pressure << " %, velocity " << 100 * errors.velocity
                  << " %\n";
        EXPECT_LT(errors.pressure, 0.001);
        EXPECT_LT(errors.velocity, 0.001);
    }
}

TEST(GridProbe, ConvergesWithSecondOrderAtLeast) {
    const PointErrors coarse = grid_errors(5e-7, 0.2);
    const PointErrors fine = grid_errors(1.25e-7, 0.2);
    EXPECT_GE(std::log2(coarse.pressure / fine.pressure) / 2, 2);
    EXPECT_GE(std::log2(coarse.velocity / fine.velocity) / 2, 2);
}

TEST(GridProbe, FillsTheDomainWithCellCentres) {
    const GridAxes axes = grid_axes({Vector(-1, 2), Vector(1, 5), {true, false}}, {4, 3});
    EXPECT_EQ(axes.x, (std::vector<double>{-0.75, -0.25, 0.25, 0.75}));
    EXPECT_EQ(axes.y, (std::vector<double>{2.5, 3.5, 4.5}));
}

TEST(PointProbe, KnowsWhereAMovingWallStands) {
    constexpr double spacing = 5e-7;
    const ExactChannel channel = rough_channel();
    Scene scene = scene_of(channel, spacing);
    scene.walls[0].velocity = Vector(-1, 0);
    const Region region(scene);
    const Particles particles = channel.sample(spacing, 0.2);
    const ParticleFinder finder(particles.view(), channel.domain(), spacing);
    const Vector below_the_crest(1.5e-5, 9e-6);
    EXPECT_TRUE(std::isnan(probe_point(finder, region, below_the_crest, 0).pressure));
    EXPECT_TRUE(std::isnan(probe_point(finder, region, below_the_crest, 3e-5).pressure)); // one period on
    const Vector in_the_valley(0.0, 3e-6);
    EXPECT_FALSE(std::isnan(probe_point(finder, region, in_the_valley, 0).pressure));
    EXPECT_TRUE(
        std::isnan(probe_point(finder, region, in_the_valley, 1.5e-5).pressure)); // where the crest is now
}

TEST(PointProbe, SaysNothingInAVoid) {
    constexpr double spacing = 0.1;
    Scene scene;
    scene.domain = {Vector(0, 0), Vector(3, 3), {true, true}};
    scene.numerics.particle_spacing = spacing;
    const Region region(scene);
    Particles particles;
    for (const double y : grid_axes(scene.domain, {30, 30}).y) {
        for (const double x : grid_axes(scene.domain, {30, 30}).x) {
            if ((Vector(x, y) - Vector(1.5, 1.5)).norm() < 0.5) {
                continue;
            }
            particles.x.push_back(x);
            particles.y.push_back(y);
            particles.velocity_x.push_back(1);
            particles.velocity_y.push_back(2);
            particles.pressure.push_back(3);
        }
    }
    const ParticleFinder finder(particles.view(), scene.domain, spacing);
    EXPECT_TRUE(std::isnan(probe_point(finder, region, Vector(1.5, 1.5), 0).pressure));
    const PointValues values =
        probe_point(finder, region, Vector(0.02, 2.98), 0); // across both periodic sides
    EXPECT_NEAR(values.pressure, 3, 1e-12);
    EXPECT_NEAR(values.velocity_x, 1, 1e-12);
    EXPECT_NEAR(values.velocity_y, 2, 1e-12);
}

} // namespace
} // namespace slurry::test
