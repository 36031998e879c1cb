#include "solver/geometry/region.hpp"

#include "solver/geometry/geometry_error.hpp"
#include "tests/solver/geometry/scenes.hpp"

#include <gtest/gtest.h>
#include <set>

namespace slurry {
namespace {

using testing::closed_box;
using testing::make_domain;
using testing::make_scene;
using testing::make_wall;
using testing::rough_channel;

using std::numbers::pi;

std::size_t count(const std::vector<std::vector<Dummy>>& dummies) {
    std::size_t sum = 0;
    for (const auto& wall : dummies)
        sum += wall.size();
    return sum;
}

TEST(Region, RoughChannelHasThePapersAreaAndParticles) {
    const Region region(rough_channel(2.5e-7));
    EXPECT_NEAR(region.fluid_area() / 3e-10, 1, 1e-12);
    EXPECT_EQ(region.lattice_points(1e-7).size(), 30000U);
    EXPECT_EQ(region.lattice_points(2.5e-7).size(), 4800U);
    EXPECT_NEAR(region.narrowest_gap(), 5e-6, 1e-15);
}

TEST(Region, RoughChannelMovesWithItsWall) {
    Scene scene = rough_channel(2.5e-7);
    scene.walls[0].velocity = Vector::Zero();
    scene.walls[1].velocity = {-1, 0};
    const Region region(scene);
    for (const double x : {0.0, 1e-6, 1.4e-5, 2.9e-5})
        for (const double time : {0.0, 1e-5, 1e-4})
            EXPECT_NEAR(region.distance({x - time, 6e-6}, time), region.distance({x, 6e-6}), 1e-17);
}

TEST(Region, ClosedBoxGetsTheLatticeFrameOnce) {
    const Region region(closed_box(0.02, 0.06, 1e-4));
    EXPECT_NEAR(region.fluid_area(), 0.02 * 0.06, 1e-17);
    EXPECT_NEAR(region.narrowest_gap(), 0.02, 1e-12);
    EXPECT_EQ(region.lattice_points(1e-4).size(), 200U * 600U);
    for (const DummyLayout layout : {DummyLayout::curve, DummyLayout::lattice}) {
        const auto dummies = region.dummies(layout, 1e-4, 3);
        EXPECT_EQ(count(dummies), 206U * 606U - 200U * 600U);
        std::set<std::pair<long, long>> cells;
        for (const auto& wall : dummies)
            for (const Dummy& dummy : wall) {
                const Vector cell = dummy.position / 1e-4 - Vector(0.5, 0.5);
                EXPECT_LT((cell - cell.array().round().matrix()).norm(), 1e-6);
                cells.emplace(std::lround(cell.x()), std::lround(cell.y()));
                EXPECT_NEAR(dummy.volume, 1e-8, 1e-20);
                EXPECT_LT(region.distance(dummy.position), 0);
            }
        EXPECT_EQ(cells.size(), 206U * 606U - 200U * 600U);
    }
}

TEST(Region, LatticeDummiesContinueTheFluidsLattice) {
    const double spacing = 2.5e-7;
    const Region region(rough_channel(spacing));
    const auto dummies = region.dummies(DummyLayout::lattice, spacing, 3);
    ASSERT_EQ(dummies.size(), 2U);
    EXPECT_EQ(dummies[0].size(), 360U);
    std::set<std::pair<long, long>> cells;
    for (const Vector& point : region.lattice_points(spacing))
        cells.emplace(std::lround(point.x() / spacing - 0.5), std::lround(point.y() / spacing - 0.5));
    std::size_t expected = cells.size();
    for (std::size_t wall = 0; wall < 2; ++wall)
        for (const Dummy& dummy : dummies[wall]) {
            cells.emplace(std::lround(dummy.position.x() / spacing - 0.5),
                          std::lround(dummy.position.y() / spacing - 0.5));
            ++expected;
            const double depth = -region.walls()[wall].nearest(dummy.position).distance;
            EXPECT_TRUE(depth >= 0 && depth <= 3 * spacing * (1 + 1e-6));
        }
    EXPECT_EQ(cells.size(), expected);
}

TEST(Region, CurveDummiesNeverLieInTheFluid) {
    const double spacing = 0.02;
    for (const WallScene& wall : testing::every_shape()) {
        const bool floor = wall.fluid_side == FluidSide::above;
        const double other = floor ? 2 : -1;
        Scene scene = make_scene(make_domain({0, -1}, {2, 2}, true),
                                 {wall, make_wall("other", LineShape{{0, other}, {2, other}},
                                                  floor ? FluidSide::below : FluidSide::above)},
                                 spacing);
        const Region region(scene);
        for (const auto& dummies : region.dummies(DummyLayout::curve, spacing, 3))
            for (const Dummy& dummy : dummies)
                EXPECT_LT(region.distance(dummy.position), -0.4 * spacing);
    }
}

TEST(Region, FluidAreaOfKnownShapes) {
    const Domain domain = make_domain({0, 0}, {2, 1.5}, true);
    const WallScene top = make_wall("top", LineShape{{0, 1}, {2, 1}}, FluidSide::below);
    const auto area = [&](const Shape& shape) {
        return Region(make_scene(domain, {top, make_wall("w", shape, FluidSide::above)}, 0.02)).fluid_area();
    };
    const double segment = 0.2 * 0.2 / 2 * (2 * pi / 3 - std::sin(2 * pi / 3));
    EXPECT_NEAR(area(ArcShape{0.3, 0.05, 0.2, 2 * pi / 3, true}), 1.4 - segment, 1e-12);
    EXPECT_NEAR(area(ArcShape{0.3, 0.05, 0.2, 2 * pi / 3, false}), 1.4 + segment, 1e-12);
    EXPECT_NEAR(area(ArcShape{0.3, 1, 0.2, pi, true}) / (1.4 - 0.02 * pi), 1, 1e-8);
    EXPECT_NEAR(area(SineShape{0.3, 0.1, 1.9, 0.8}), 1.4, 1e-12);
    EXPECT_NEAR(area(GaussianShape{0.3, 0.2, 1.9, 0.1}), 1.4 - 0.02 * std::sqrt(2 * pi), 1e-12);
    Scene box = closed_box(2, 1, 0.02);
    box.walls[0] = make_wall("slope", LineShape{{0, 0}, {2, 0.5}}, FluidSide::above);
    box.walls[1] = make_wall("right", LineShape{{2, 0.5}, {2, 1}}, FluidSide::left);
    EXPECT_NEAR(Region(box).fluid_area(), 1.5, 1e-12);
}

TEST(Region, BoxWithACurvedFloorIsClosed) {
    Scene box = closed_box(2, 1, 0.02);
    box.walls[0] = make_wall("floor", CosineShape{0.3, 0.1, 1.3, 0.4}, FluidSide::above);
    const Region region(box);
    EXPECT_GT(region.distance({0.5, 0.5}), 0);
    EXPECT_LT(region.distance({0.01, 0.1}), 0); // behind the floor, but in front of the left wall
    for (const auto& dummies : region.dummies(DummyLayout::curve, 0.02, 3))
        for (const Dummy& dummy : dummies)
            EXPECT_LT(region.distance(dummy.position), 0);
}

// Where the fluid touches a wall there are dummies behind it, wherever in their rows another wall begins.
TEST(Region, CurveDummiesLeaveNoHoleWhereWallsMeet) {
    const double spacing = 0.02;
    for (int tenth = 0; tenth < 10; ++tenth) {
        Scene box = closed_box(2, 1, spacing);
        const double mean = 0.3 + 0.1 * tenth * spacing;
        box.walls[0] = make_wall("floor", CosineShape{mean, 0.05, 1.3, 0.4}, FluidSide::above);
        const Region region(box);
        const auto dummies = region.dummies(DummyLayout::curve, spacing, 3);
        for (const double x : {0.0, 2.0}) {
            const double floor = mean + 0.05 * std::cos(2 * pi * (x - 0.4) / 1.3);
            for (double y = floor; y < floor + 5 * spacing; y += 0.05 * spacing) {
                const Vector behind(x + (x > 0 ? 0.5 : -0.5) * spacing, y);
                double nearest = 1;
                for (const auto& wall : dummies)
                    for (const Dummy& dummy : wall)
                        nearest = std::min(nearest, (dummy.position - behind).norm());
                EXPECT_LE(nearest, 0.52 * spacing) << "floor " << mean << ", " << behind.transpose();
            }
        }
    }
}

TEST(Region, UprightChannelPeriodicAlongY) {
    Scene scene = make_scene({{0, 0}, {1, 2}, {false, true}},
                             {make_wall("left", LineShape{{0, 2}, {0, 0}}, FluidSide::right),
                              make_wall("right", LineShape{{1, 0}, {1, 2}}, FluidSide::left, {0, 3})},
                             0.05);
    const Region region(scene);
    EXPECT_EQ(region.lattice_points(0.05).size(), 800U);
    EXPECT_DOUBLE_EQ(region.fluid_area(), 2);
    EXPECT_DOUBLE_EQ(region.narrowest_gap(), 1);
    EXPECT_DOUBLE_EQ(region.distance({0.7, -5}, 1), 0.3);
    for (const auto& wall : region.dummies(DummyLayout::curve, 0.05, 3))
        EXPECT_EQ(wall.size(), 120U);
}

TEST(Region, WithoutWallsIsThePeriodicDomain) {
    Scene scene;
    scene.domain = {{0, 0}, {1, 1}, {true, true}};
    scene.numerics.particle_spacing = 0.02;
    const Region region(scene);
    EXPECT_EQ(region.lattice_points(0.02).size(), 2500U);
    EXPECT_EQ(region.fluid_area(), 1);
    EXPECT_TRUE(std::isinf(region.distance({0.5, 0.5})));
    EXPECT_TRUE(std::isinf(region.narrowest_gap()));
    EXPECT_TRUE(region.dummies(DummyLayout::curve, 0.02, 3).empty());
}

struct BadScene {
    Scene scene;
    std::vector<std::string> words; // of the message
};

std::vector<BadScene> bad_scenes() {
    std::vector<BadScene> cases;
    Scene scene = rough_channel(2.5e-7);
    scene.walls[0].shape = LineShape{{0, 9e-6}, {3e-5, 9e-6}};
    cases.push_back({scene, {"'wafer'", "'pad'", "cross near"}});
    cases.push_back({rough_channel(2e-6), {"narrowest gap", "5e-06", "particle_spacing", "1.667e-06"}});
    scene = rough_channel(2.5e-7);
    scene.walls[1].shape = CosineShape{4e-6, -1e-6, 1e-6, 0};
    cases.push_back({scene, {"'pad'", "radius of curvature", "lattice"}});
    scene = rough_channel(2.5e-7);
    scene.walls[0].fluid_side = FluidSide::above;
    cases.push_back({scene, {"no room for fluid"}});
    scene = rough_channel(2.5e-7);
    scene.walls.pop_back();
    cases.push_back({scene, {"lower side", "open"}});
    scene = closed_box(2, 1, 0.02);
    scene.walls.erase(scene.walls.begin() + 1);
    cases.push_back({scene, {"right side", "open"}});
    scene = closed_box(2, 1, 0.02);
    scene.walls.push_back(make_wall("cutter", LineShape{{0.5, -0.5}, {0.5, 1.5}}, FluidSide::right));
    cases.push_back({scene, {"cross", "'cutter'"}});
    scene = closed_box(2, 1, 0.02);
    scene.walls.push_back(make_wall("step", LineShape{{1, 0.5}, {2, 0.5}}, FluidSide::above));
    cases.push_back({scene, {"'step'", "inward"}});
    scene = closed_box(2, 1, 0.02);
    scene.walls.push_back(make_wall("cellar", LineShape{{0, -0.5}, {2, -0.5}}, FluidSide::above));
    cases.push_back({scene, {"'cellar'", "wholly in the solid"}});
    scene = make_scene(make_domain({0, -1}, {2, 2}, true),
                       {make_wall("top", GaussianShape{1, -0.6, 0.2, 0.1}, FluidSide::below),
                        make_wall("bottom", GaussianShape{0, 0.6, 1.2, 0.1}, FluidSide::above, {1, 0})},
                       0.005);
    cases.push_back({scene, {"'top'", "'bottom'", "collide"}});
    return cases;
}

TEST(Region, RefusesWhatCannotBeSimulated) {
    for (const BadScene& bad : bad_scenes()) {
        try {
            const Region region(bad.scene);
            ADD_FAILURE() << "accepted, but expected: " << bad.words.front();
        } catch (const GeometryError& error) {
            const std::string message = error.what();
            for (const std::string& word : bad.words)
                EXPECT_NE(message.find(word), std::string::npos) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
}

} // namespace
} // namespace slurry
