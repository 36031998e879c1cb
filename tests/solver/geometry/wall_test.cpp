#include "solver/geometry/wall.hpp"

#include "solver/geometry/curve.hpp"
#include "solver/geometry/geometry_error.hpp"
#include "tests/solver/geometry/scenes.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <ostream>
#include <random>

namespace slurry {
namespace {

using testing::make_domain;
using testing::make_wall;

using std::numbers::pi;

struct Case {
    WallScene wall;
    bool periodic;
};

std::vector<Case> every_case() {
    std::vector<Case> cases;
    for (const bool periodic : {true, false})
        for (const WallScene& wall : testing::every_shape())
            cases.push_back({wall, periodic});
    // layers of depth 0.025, a tip of radius 0.009
    cases.push_back({make_wall("tip", GaussianShape{0.1, 0.7, 1.3, 0.08}, FluidSide::above), true});
    cases.push_back({make_wall("slope", LineShape{{1.9, 0.3}, {0.1, 0.9}}, FluidSide::below), false});
    cases.push_back({make_wall("upright", LineShape{{0.5, 0.9}, {0.5, 0.1}}, FluidSide::left), false});
    return cases;
}

void PrintTo(const Case& one, std::ostream* out) {
    *out << one.wall.name << (one.periodic ? ", periodic" : "");
}

class AnyWall : public ::testing::TestWithParam<Case> {
  protected:
    Domain domain = make_domain({0, 0}, {2, 1}, GetParam().periodic);
    Wall wall{GetParam().wall, domain};
    std::mt19937_64 random{1};

    Vector random_point() {
        std::uniform_real_distribution<double> x(-0.5, 2.5);
        std::uniform_real_distribution<double> y(-0.5, 1.5);
        const double first = x(random);
        return {first, y(random)};
    }
};

TEST_P(AnyWall, NearestPointBeatsEveryDenseSample) {
    const int n = 4000;
    const std::vector<WallPoint> samples = wall.sample(n);
    for (int trial = 0; trial < 200; ++trial) {
        const Vector point = random_point();
        double brute = std::numeric_limits<double>::infinity();
        for (const WallPoint& sample : samples)
            for (const double image : {-2.0, 0.0, 2.0})
                if (image == 0 || domain.periodic[0])
                    brute = std::min(brute, (sample.position + Vector(image, 0) - point).norm());
        const double found = std::abs(wall.nearest(point).distance);
        EXPECT_LE(found, brute + 1e-14);
        EXPECT_GE(found,
                  brute - wall.length() / n / 2); // the farthest that a sample can be from the nearest point
    }
}

TEST_P(AnyWall, NearestPointIsStationaryToTenDigits) {
    for (int trial = 0; trial < 500; ++trial) {
        const Vector point = random_point();
        const NearestPoint nearest = wall.nearest(point);
        EXPECT_NEAR((point - nearest.position).norm(), std::abs(nearest.distance), 1e-14);
        EXPECT_NEAR(nearest.normal.norm(), 1, 1e-14);
        EXPECT_NEAR(nearest.tangent.norm(), 1, 1e-14);
        EXPECT_NEAR(nearest.normal.dot(nearest.tangent), 0, 1e-14);
        EXPECT_GE(nearest.tangent.x(), -1e-12);
        const Vector offset = point - nearest.position;
        if (!wall.curve().closed() && ((nearest.position - wall.curve().first_point()).norm() < 1e-12 ||
                                       (nearest.position - wall.curve().last_point()).norm() < 1e-12))
            continue; // beyond an open end the offset is oblique
        EXPECT_NEAR(offset.dot(nearest.tangent), 0, 1e-10);
        EXPECT_NEAR(offset.dot(nearest.normal), nearest.distance, 1e-12);
        const CurvePoint same = wall.curve().at(nearest.arc_length);
        Vector apart = same.position - nearest.position;
        if (domain.periodic[0])
            apart.x() -= 2 * std::round(apart.x() / 2);
        EXPECT_LT(apart.norm(), 1e-12);
    }
}

TEST_P(AnyWall, DistanceHasUnitGradient) {
    const double h = 1e-6;
    int smooth = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const Vector point = random_point();
        const auto distance = [&](double x, double y) { return wall.nearest(point + Vector(x, y)).distance; };
        const Vector gradient{(distance(h, 0) - distance(-h, 0)) / (2 * h),
                              (distance(0, h) - distance(0, -h)) / (2 * h)};
        const NearestPoint nearest = wall.nearest(point);
        const Vector expected = (point - nearest.position) / nearest.distance;
        if (std::abs(gradient.norm() - 1) < 1e-6 && (gradient - expected).norm() < 1e-4)
            ++smooth;
    }
    EXPECT_GE(smooth, 297); // but for the few points within h of the medial axis
}

TEST_P(AnyWall, SignTellsTheSideOfTheGraph) {
    if (wall.curve().vertical())
        return;
    const bool above = GetParam().wall.fluid_side == FluidSide::above;
    std::uniform_real_distribution<double> x(0.1, 1.9);
    std::uniform_real_distribution<double> y(-0.5, 1.5);
    for (int trial = 0; trial < 1000; ++trial) {
        const Vector point{x(random), y(random)};
        EXPECT_EQ(wall.nearest(point).distance > 0, (point.y() > wall.curve().height(point.x())) == above);
    }
}

TEST_P(AnyWall, SamplesAreEvenAndOnTheWall) {
    const std::vector<WallPoint> points = wall.sample(1000);
    ASSERT_EQ(points.size(), 1000U);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(points[i].arc_length, (static_cast<double>(i) + 0.5) * wall.length() / 1000, 1e-12);
        EXPECT_LT(std::abs(wall.nearest(points[i].position).distance), 1e-12);
        if (i > 0) {
            EXPECT_LE((points[i].position - points[i - 1].position).norm(),
                      wall.length() / 1000 * (1 + 1e-9)); // the arcs are sums by quadrature
        }
    }
}

TEST_P(AnyWall, NormalPointsIntoTheFluidAndCurvatureIsItsTurning) {
    const int n = 20000;
    const std::vector<WallPoint> points = wall.sample(n);
    int smooth = 0;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        EXPECT_GT(wall.nearest(points[i].position + 1e-7 * points[i].normal).distance, 0);
        const Vector bend = points[i + 1].normal - points[i - 1].normal; // n' = -curvature t
        const double turning = -bend.dot(points[i].tangent) * n / (2 * wall.length());
        smooth += std::abs(turning - points[i].curvature) < 1e-2 * (1 + std::abs(turning)) ? 1 : 0;
    }
    EXPECT_GE(smooth, n - 60); // but for kinks and the jumps of a spline's second derivative
}

TEST_P(AnyWall, DummiesLieAtTheirDepthEvenlySpaced) {
    const double spacing = 0.01;
    const int layers = 3;
    double area = 0;
    for (const Dummy& dummy : wall.curve_dummies(spacing, layers)) {
        area += dummy.volume;
        const NearestPoint nearest = wall.nearest(dummy.position);
        EXPECT_LT((nearest.position - dummy.wall_point).norm(), 1e-10);
        const double layer = (dummy.wall_point - dummy.position).dot(dummy.normal) / spacing - 0.5;
        EXPECT_LT(std::abs(layer - std::round(layer)), 1e-5) << dummy.position.transpose();
        EXPECT_TRUE(layer > -0.1 && layer < layers - 0.9);
        if (domain.periodic[0]) {
            EXPECT_TRUE(dummy.position.x() >= 0 && dummy.position.x() <= 2);
        }
    }
    // the true area of the band, by a stratified sample
    const double cell = 0.003;
    const double beyond = domain.periodic[0] ? 0 : 0.05;
    std::uniform_real_distribution<double> within(0, cell);
    int cells = 0;
    for (double x = -beyond; x < 2 + beyond - cell / 2; x += cell)
        for (double y = -0.2; y < 1.2; y += cell) {
            const double offset_x = within(random);
            const Vector point{x + offset_x, y + within(random)};
            const NearestPoint nearest = wall.nearest(point);
            const Vector offset = point - nearest.position;
            const double depth = -offset.dot(nearest.normal);
            cells += depth > 0 && depth < layers * spacing &&
                     std::abs(offset.dot(nearest.tangent)) < layers * spacing;
        }
    EXPECT_NEAR(area / (cells * cell * cell), 1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Shapes, AnyWall, ::testing::ValuesIn(every_case()), [](const auto& instance) {
    std::string name = instance.param.wall.name + (instance.param.periodic ? "_periodic" : "_open");
    std::ranges::replace(name, ' ', '_');
    return name;
});

TEST(Wall, LengthOfKnownCurves) {
    const Domain domain = make_domain({0, 0}, {2, 1}, true);
    EXPECT_NEAR(Wall(make_wall("bulge", ArcShape{0.3, 1, 0.2, pi, true}, FluidSide::above), domain).length(),
                2 - 0.4 + 0.2 * pi, 1e-13);
    // 4 E(-1) / (2 pi) per unit length of cos x: DLMF 19.8
    const Wall cosine(make_wall("cosine", CosineShape{0, 1 / pi, 2, 0.3}, FluidSide::above), domain);
    EXPECT_NEAR(cosine.length(), 4 * std::comp_ellint_2(std::sqrt(0.5)) * std::sqrt(2.0) / pi, 1e-12);
}

TEST(Wall, TinyAndHugeUnitsAreAsAccurate) {
    const Domain domain = make_domain({0, 0}, {3e-5, 1.5e-5}, true);
    const Wall pad(make_wall("pad", CosineShape{5e-6, -5e-6, 3e-5, 0}, FluidSide::above), domain);
    EXPECT_NEAR(pad.nearest({1.5e-5, 1.5e-5}).distance, 5e-6, 1e-18);
    EXPECT_NEAR(pad.nearest({1.5e-5, 1.5e-5}).curvature, -5e-6 * std::pow(2 * pi / 3e-5, 2), 1e-3);
    EXPECT_NEAR(pad.nearest({0, -1e-6}).distance, -1e-6, 1e-18);
}

TEST(Wall, PeriodicCutNearAFeatureDoesNotShow) {
    const Domain domain = make_domain({0, 0}, {2, 1}, true);
    const Wall middle(make_wall("a", ArcShape{0.3, 1, 0.2, 2, true}, FluidSide::above), domain);
    const Wall edge(make_wall("b", ArcShape{0.3, 0.05, 0.2, 2, true}, FluidSide::above), domain);
    const Wall outside(make_wall("c", ArcShape{0.3, -3.95, 0.2, 2, true}, FluidSide::above), domain);
    std::mt19937_64 random{2};
    std::uniform_real_distribution<double> any(0, 2);
    for (int i = 0; i < 1000; ++i) {
        const double x = any(random);
        const double y = any(random) - 0.5;
        const double expected = middle.nearest({x + 0.95, y}).distance;
        EXPECT_NEAR(edge.nearest({x, y}).distance, expected, 1e-13);
        EXPECT_NEAR(outside.nearest({x, y}).distance, expected, 1e-13);
        EXPECT_NEAR(edge.nearest({x + 20, y}).distance, expected, 1e-13);
    }
    EXPECT_NEAR(edge.curve().first_point().x(), 0, 1e-15);
    EXPECT_NEAR(edge.length(), middle.length(), 1e-13);
}

TEST(Wall, FlatWallContinuesTheLattice) {
    const Wall wall(make_wall("wafer", LineShape{{0, 1}, {2, 1}}, FluidSide::below),
                    make_domain({0, 0}, {2, 1}, true));
    const std::vector<Dummy> dummies = wall.curve_dummies(0.1, 3);
    ASSERT_EQ(dummies.size(), 60U);
    for (std::size_t i = 0; i < dummies.size(); ++i) {
        const Vector cell{(static_cast<double>(i % 20) + 0.5) * 0.1,
                          1 + (static_cast<double>(i / 20) + 0.5) * 0.1};
        EXPECT_LT((dummies[i].position - cell).norm(), 1e-14);
        EXPECT_NEAR(dummies[i].volume, 0.01, 1e-15);
    }
}

TEST(Wall, OnlySlidingLinesStayInPlaceBetweenTwoEnds) {
    const WallScene lid = make_wall("lid", LineShape{{0, 1}, {2, 1}}, FluidSide::below, {3, 0});
    EXPECT_EQ(Wall(lid, make_domain({0, 0}, {2, 1}, false)).displacement(2), Vector::Zero());
    EXPECT_EQ(Wall(lid, make_domain({0, 0}, {2, 1}, true)).displacement(2), Vector(6, 0));
}

struct BadWall {
    WallScene wall;
    bool periodic;
    std::string reason; // part of the message
};

std::vector<BadWall> bad_walls() {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    ProfileShape narrow = testing::measured_profile();
    narrow.points.pop_back();
    ProfileShape unsorted = testing::measured_profile();
    std::swap(unsorted.points[3], unsorted.points[4]);
    ProfileShape uneven = testing::measured_profile();
    uneven.points.back().y() += 0.1;
    ProfileShape micrometres = testing::measured_profile(); // its sides are at the same height
    for (Vector& point : micrometres.points)
        point *= 1e6;
    const LineShape flat{{0, 0.5}, {2, 0.5}};
    const CosineShape wave{0.3, 0.1, 1, 0};
    return {
        {make_wall("w", LineShape{{1, 1}, {1, 1}}, FluidSide::above), false, "same point"},
        {make_wall("w", LineShape{{1, 0}, {1, 1}}, FluidSide::above), false, "'left' or 'right'"},
        {make_wall("w", flat, FluidSide::left), false, "'above' or 'below'"},
        {make_wall("w", LineShape{{0, 0}, {2, 1}}, FluidSide::above), true, "periodic axis"},
        {make_wall("w", LineShape{{0, 0}, {1, 0}}, FluidSide::above), true, "whole domain"},
        {make_wall("w", wave, FluidSide::right), true, "'above' or 'below'"},
        {make_wall("w", CosineShape{0.3, 0.1, 1.1, 0}, FluidSide::above), true, "whole number"},
        {make_wall("w", CosineShape{0.3, 0.1, -1, 0}, FluidSide::above), true, "wavelength"},
        {make_wall("w", CosineShape{nan, 0.1, 1, 0}, FluidSide::above), true, "finite"},
        {make_wall("w", GaussianShape{0.3, 0.1, 1, nan}, FluidSide::above), true, "width"},
        {make_wall("w", ArcShape{0.3, 1, 0.2, 4, true}, FluidSide::above), true, "angle"},
        {make_wall("w", ArcShape{0.3, 0.1, 0.2, 3, true}, FluidSide::above), false, "reaches"},
        {make_wall("w", SineShape{0.3, 0.1, 1, 3}, FluidSide::above), true, "reaches"},
        {make_wall("w", RandomShape{0.3, 0.1, 0, 1}, FluidSide::above), true, "correlation_length"},
        {make_wall("w", RandomShape{0.3, 0.1, 0.009, 1}, FluidSide::above), true, "1 / 200"},
        {make_wall("w", RandomShape{0.3, 0, 0.1, 1}, FluidSide::above), true, "rms_height"},
        {make_wall("w", narrow, FluidSide::above), true, "covers"},
        {make_wall("w", micrometres, FluidSide::above), true,
         "covers x = 0 to 2e+06 m, 1e+06 times the domain's width of 2 m, and has 1 of its points in the "
         "domain, but needs 3 or more: is it in um?"},
        {make_wall("w", unsorted, FluidSide::above), true, "row 5"},
        {make_wall("w", uneven, FluidSide::above), true, "heights"},
        {make_wall("w", wave, FluidSide::above, {0, 1}), true, "along y"},
        {make_wall("w", wave, FluidSide::above, {1, 0}), false, "not periodic"},
        {make_wall("w", flat, FluidSide::above, {1, 0.1}), true, "across"},
        {make_wall("w", flat, FluidSide::above, {nan, 0}), true, "finite"},
    };
}

TEST(Wall, RefusesWhatMakesNoSense) {
    for (const BadWall& bad : bad_walls()) {
        try {
            const Wall wall(bad.wall, make_domain({0, 0}, {2, 1}, bad.periodic));
            ADD_FAILURE() << "accepted, but expected: " << bad.reason;
        } catch (const GeometryError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(bad.reason), std::string::npos) << message;
            EXPECT_NE(message.find("'w'"), std::string::npos) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
}

} // namespace
} // namespace slurry
