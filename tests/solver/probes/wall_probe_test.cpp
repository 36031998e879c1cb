// The wall probe against exact fields at disordered particles: what it adds to an error measured with it.
#include "solver/probes/wall_probe.hpp"

#include "tests/solver/probes/exact_channel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <numeric>

namespace slurry::test {
namespace {

constexpr double viscosity = 1e-3;
constexpr int points_on_wall = 100;

// The rough channel (Sec. 4.1.1), and an asperity of the same height and, nearly, curvature.
ExactChannel over_cosine() {
    return {CosineShape{5e-6, -5e-6, 3e-5, 0}, 3e-5};
}
ExactChannel over_gaussian() {
    return {GaussianShape{5e-6, 5e-6, 2e-5, 5e-6}, 4e-5};
}

struct WallErrors { // relative L2 over the wall
    double pressure, shear;
};

double relative_l2(const std::vector<double>& values, const std::vector<double>& exact) {
    double difference = 0;
    double scale = 0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
        difference += std::pow(values[k] - exact[k], 2);
        scale += std::pow(exact[k], 2);
    }
    return std::sqrt(difference / scale);
}

WallErrors errors_of(const ExactChannel& channel, const Particles& particles, double spacing, bool on_pad) {
    const Wall wall(on_pad ? channel.pad() : channel.wafer(), channel.domain());
    const auto points = wall.sample(points_on_wall);
    const ParticleFinder finder(particles.view(), channel.domain(), spacing);
    const WallValues values = probe_wall(finder, wall, points, 0, viscosity);
    std::vector<double> pressure;
    std::vector<double> shear;
    for (const WallPoint& point : points) {
        const double x = point.position.x();
        pressure.push_back(channel.pressure(point.position));
        shear.push_back(viscosity * (on_pad ? channel.pad_shear_rate(x) : channel.wafer_shear_rate(x)));
    }
    return {relative_l2(values.pressure, pressure), relative_l2(values.shear, shear)};
}

struct Setting {
    const char* name;
    ExactChannel (*channel)();
    bool on_pad;
    double jitter;
};

class WallProbeAccuracy : public testing::TestWithParam<Setting> {};

TEST_P(WallProbeAccuracy, IsWithinTwoTenthsOfAPercentAtTheRoughChannelsSpacing) {
    const auto& [name, channel_of, on_pad, jitter] = GetParam();
    const ExactChannel channel = channel_of();
    const WallErrors errors = errors_of(channel, channel.sample(2.5e-7, jitter), 2.5e-7, on_pad);
    std::cout << "pressure " << 100 * errors.pressure << " %, shear " << 100 * errors.shear << " %\n";
    EXPECT_LT(errors.pressure, 0.002);
    EXPECT_LT(errors.shear, 0.002);
}

TEST_P(WallProbeAccuracy, ConvergesWithSecondOrderAtLeast) {
    const auto& [name, channel_of, on_pad, jitter] = GetParam();
    const ExactChannel channel = channel_of();
    std::vector<WallErrors> errors;
    for (const double spacing : {5e-7, 2.5e-7, 1.25e-7}) {
        errors.push_back(errors_of(channel, channel.sample(spacing, jitter), spacing, on_pad));
    }
    for (std::size_t k = 1; k < errors.size(); ++k) {
        const double pressure_order = std::log2(errors[k - 1].pressure / errors[k].pressure);
        const double shear_order = std::log2(errors[k - 1].shear / errors[k].shear);
        std::cout << "order of pressure " << pressure_order << ", of shear " << shear_order << '\n';
        EXPECT_GE(pressure_order, 2);
        EXPECT_GE(shear_order, 2);
    }
}

INSTANTIATE_TEST_SUITE_P(Walls, WallProbeAccuracy,
                         testing::Values(Setting{"flat_lattice", over_cosine, false, 0},
                                         Setting{"flat_jittered", over_cosine, false, 0.3},
                                         Setting{"flat_opposite_gaussian", over_gaussian, false, 0.2},
                                         Setting{"cosine_cut_lattice", over_cosine, true, 0},
                                         Setting{"cosine_jittered", over_cosine, true, 0.2},
                                         Setting{"cosine_jittered_more", over_cosine, true, 0.3},
                                         Setting{"gaussian_cut_lattice", over_gaussian, true, 0},
                                         Setting{"gaussian_jittered", over_gaussian, true, 0.3}),
                         [](const auto& setting) { return std::string(setting.param.name); });

// White noise, the worst kind: of 1 % of the rms pressure and of the wafer's speed. The gap is 20 to 60
// spacings wide, so the particles next to a wall move at 1 to 2 % of that speed relative to it: shear suffers
// most.
TEST(WallProbe, AmplifiesNoiseNoMoreThanStated) {
    constexpr double spacing = 2.5e-7;
    const ExactChannel channel = over_cosine();
    Particles particles = channel.sample(spacing, 0.2);
    std::mt19937 generator(2);
    std::normal_distribution<double> noise(0, 0.01);
    const double rms = std::sqrt(std::inner_product(particles.pressure.begin(), particles.pressure.end(),
                                                    particles.pressure.begin(), 0.0) /
                                 static_cast<double>(particles.x.size()));
    for (std::size_t i = 0; i < particles.x.size(); ++i) {
        particles.pressure[i] += noise(generator) * rms;
        particles.velocity_x[i] += noise(generator) * ExactChannel::top_speed;
        particles.velocity_y[i] += noise(generator) * ExactChannel::top_speed;
    }
    for (const bool on_pad : {true, false}) {
        const WallErrors errors = errors_of(channel, particles, spacing, on_pad);
        std::cout << "pressure " << 100 * errors.pressure << " %, shear " << 100 * errors.shear << " %\n";
        EXPECT_LT(errors.pressure, 0.015);
        EXPECT_LT(errors.shear, 0.35);
    }
}

// Cubics about a flat wall: reproduced to rounding, whatever the disorder.
class WallProbeOfFlatWall : public testing::Test {
  protected:
    static constexpr double spacing = 0.1;
    Domain domain{Vector(0, 0), Vector(3, 2), {true, false}};
    WallScene scene{"floor", LineShape{{0, 0}, {3, 0}}, FluidSide::above, Vector(0.7, 0)};

    // Jittered particles at heights from..to, with u = 0.7 + 2 y - y^2 + y^3 and p = 5 + 3 y - 2 y^2 + y^3.
    static Particles cubic(double from, double to) {
        std::mt19937 generator(3);
        std::uniform_real_distribution<double> shift(-0.02, 0.02);
        Particles particles;
        for (int row = 0; row < 20; ++row) {
            for (int column = 0; column < 30; ++column) {
                const double y = (row + 0.5) * spacing + shift(generator);
                if (y < from || y > to) {
                    continue;
                }
                particles.x.push_back((column + 0.5) * spacing + shift(generator));
                particles.y.push_back(y);
                particles.velocity_x.push_back(0.7 + y * (2 + y * (-1 + y)));
                particles.velocity_y.push_back(0.1 * y * y);
                particles.pressure.push_back(5 + y * (3 + y * (-2 + y)));
            }
        }
        return particles;
    }

    [[nodiscard]] WallValues probe(const Particles& particles, int points = 17) const {
        const Wall wall(scene, domain);
        return probe_wall(ParticleFinder(particles.view(), domain, spacing), wall, wall.sample(points), 0,
                          viscosity);
    }
};

TEST_F(WallProbeOfFlatWall, ReproducesCubicsAndTheSignOfTheTraction) {
    const WallValues values = probe(cubic(0, 2));
    for (std::size_t k = 0; k < 17; ++k) {
        EXPECT_NEAR(values.pressure[k], 5, 1e-11);
        EXPECT_NEAR(values.shear[k], -2 * viscosity,
                    1e-13); // the fluid is faster than the wall, which holds it back
    }
}

TEST_F(WallProbeOfFlatWall, SaysNothingWhereParticlesAreMissing) {
    const auto nothing = [](const std::vector<double>& values) {
        return std::ranges::all_of(values, [](double value) { return std::isnan(value); });
    };
    for (const double from : {0.25, 0.35, 0.45, 0.8}) { // a void beside the wall
        const WallValues values = probe(cubic(from, 2));
        EXPECT_TRUE(nothing(values.pressure)) << from;
        EXPECT_TRUE(nothing(values.shear)) << from;
    }
    const WallValues one_row = probe(cubic(0, 0.1));
    EXPECT_TRUE(nothing(one_row.pressure));
    EXPECT_TRUE(nothing(one_row.shear));
    const WallValues no_particles = probe(Particles{});
    EXPECT_TRUE(nothing(no_particles.pressure));
    EXPECT_TRUE(nothing(no_particles.shear));
}

TEST_F(WallProbeOfFlatWall, AnswersInTheCornerOfABox) {
    domain.periodic = {false, false};
    const WallValues values = probe(cubic(0, 2), 60);
    for (const std::size_t k : {0U, 1U, 58U, 59U}) { // a quarter of a spacing from the side, three quarters
        EXPECT_NEAR(values.pressure[k], 5, 5e-3);
        EXPECT_NEAR(values.shear[k], -2 * viscosity, 0.02 * viscosity);
    }
}

TEST_F(WallProbeOfFlatWall, AnswersInAGapOfThreeParticles) {
    const WallValues values = probe(cubic(0, 0.3));
    for (std::size_t k = 0; k < 17; ++k) { // a parabola at least: the cubic term grows to 0.027
        EXPECT_NEAR(values.pressure[k], 5, 5e-3);
        EXPECT_NEAR(values.shear[k], -2 * viscosity, 0.02 * viscosity);
    }
}

TEST_F(WallProbeOfFlatWall, PassesOnWhatIsNotANumber) {
    Particles particles = cubic(0, 2);
    particles.velocity_x[45] = std::numeric_limits<double>::quiet_NaN();
    particles.pressure[45] = std::numeric_limits<double>::quiet_NaN();
    const WallValues values = probe(particles);
    const auto nearest = static_cast<std::size_t>(particles.x[45] / 3 * 17);
    EXPECT_TRUE(std::isnan(values.pressure[nearest]));
    EXPECT_TRUE(std::isnan(values.shear[nearest]));
    EXPECT_FALSE(std::isnan(values.pressure[(nearest + 8) % 17]));
}

// The same flow seen from the pad and from the wafer: after 1.3 periods the moving pad's particles are those
// of the resting one, shifted and wrapped, and the probe moves with the pad.
TEST(WallProbe, MovesWithTheWall) {
    constexpr double spacing = 5e-7;
    const ExactChannel channel = over_cosine();
    const Domain domain = channel.domain();
    const Particles resting = channel.sample(spacing, 0.2);
    const Wall wall(channel.pad(), domain);
    const auto points = wall.sample(points_on_wall);
    const WallValues seen_from_pad =
        probe_wall(ParticleFinder(resting.view(), domain, spacing), wall, points, 0, viscosity);

    WallScene moving_scene = channel.pad();
    moving_scene.velocity = Vector(-ExactChannel::top_speed, 0);
    const double time = 1.3 * channel.length() / ExactChannel::top_speed;
    Particles moved = resting;
    for (std::size_t i = 0; i < moved.x.size(); ++i) {
        const double x = moved.x[i] - ExactChannel::top_speed * time;
        moved.x[i] = x - channel.length() * std::floor(x / channel.length());
        moved.velocity_x[i] -= ExactChannel::top_speed;
    }
    const Wall moving(moving_scene, domain);
    const WallValues seen_from_wafer =
        probe_wall(ParticleFinder(moved.view(), domain, spacing), moving, points, time, viscosity);
    EXPECT_LT(relative_l2(seen_from_wafer.pressure, seen_from_pad.pressure), 1e-8);
    EXPECT_LT(relative_l2(seen_from_wafer.shear, seen_from_pad.shear), 1e-8);
}

} // namespace
} // namespace slurry::test
