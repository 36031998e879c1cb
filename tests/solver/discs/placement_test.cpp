#include "solver/discs/placement.hpp"

#include "tests/solver/discs/disc_scenes.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace slurry::testing {
namespace {

// The gap between the rims of two discs, over all periodic images nearby.
double gap(const PlacedDisc& one, const PlacedDisc& other, const Domain& domain) {
    double least = std::numeric_limits<double>::infinity();
    for (const int i : {-1, 0, 1})
        for (const int j : {-1, 0, 1}) {
            const bool image = (i == 0 || domain.periodic[0]) && (j == 0 || domain.periodic[1]);
            const Vector shift = domain.size().cwiseProduct(Vector(i, j));
            if (image && (&one != &other || i != 0 || j != 0))
                least =
                    std::min(least, (other.centre + shift - one.centre).norm() - one.radius - other.radius);
        }
    return least;
}

double least_gap(const std::vector<PlacedDisc>& discs, const Domain& domain) {
    double least = std::numeric_limits<double>::infinity();
    for (const PlacedDisc& one : discs)
        for (const PlacedDisc& other : discs)
            least = std::min(least, gap(one, other, domain));
    return least;
}

double least_wall_gap(const std::vector<PlacedDisc>& discs, const Region& region) {
    double least = std::numeric_limits<double>::infinity();
    for (const PlacedDisc& disc : discs)
        least = std::min(least, region.distance(disc.centre) - disc.radius);
    return least;
}

TEST(PlacedDisc, HasTheMassAndInertiaOfASolidDisc) {
    const PlacedDisc disc{"disc", {0, 0}, 2, 3, DiscMotion::free, {0, 0}, 0};
    EXPECT_DOUBLE_EQ(disc.mass(), 12 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(disc.moment_of_inertia(), 24 * std::numbers::pi);
}

TEST(PlaceDiscs, KeepsWhatTheSceneSays) {
    Scene scene = box({false, false});
    scene.discs = {random_discs("grain", counted(2, 0.05)), single("steel", 0.1, {0.3, 0.4})};
    scene.discs[1].density = 7800;
    scene.discs[1].motion = DiscMotion::prescribed;
    scene.discs[1].velocity = {1, 2};
    scene.discs[1].spin = -3;
    const std::vector<PlacedDisc> discs = place(scene);
    ASSERT_EQ(discs.size(), 3U);
    EXPECT_EQ(discs[0].name, "grain_1");
    EXPECT_EQ(discs[1].name, "grain_2");
    EXPECT_EQ(discs[1].density, 2000);
    EXPECT_EQ(discs[2].name, "steel");
    EXPECT_EQ(discs[2].centre, Vector(0.3, 0.4));
    EXPECT_EQ(discs[2].radius, 0.1);
    EXPECT_EQ(discs[2].density, 7800);
    EXPECT_EQ(discs[2].motion, DiscMotion::prescribed);
    EXPECT_EQ(discs[2].velocity, Vector(1, 2));
    EXPECT_EQ(discs[2].spin, -3);
    EXPECT_TRUE(place(box({false, false})).empty());
}

TEST(PlaceDiscs, LetsRimsTouch) {
    Scene scene = box({true, false});
    scene.discs = {single("a", 0.1, {0.3, 0.1}), single("b", 0.1, {0.5, 0.1}), single("c", 0.1, {0.1, 0.1})};
    EXPECT_EQ(refusal(scene), "PLACED 3");
}

TEST(PlaceDiscs, RefusesSingleDiscsWithoutRoom) {
    const auto refused = [](std::array<bool, 2> periodic, const std::vector<DiscScene>& discs) {
        Scene scene = box(periodic);
        scene.discs = discs;
        return refusal(scene);
    };
    EXPECT_EQ(refused({false, false}, {single("a", 0.1, {0.3, 0.5}), single("b", 0.1, {0.45, 0.5})}),
              "disc 'b' at (0.45, 0.5) m overlaps disc 'a' by 0.05 m: move them apart, or make them smaller");
    EXPECT_EQ(refused({false, false}, {single("a", 0.1, {0.5, 0.08})}),
              "disc 'a' at (0.5, 0.08) m: its rim is 0.02 m behind wall 'bottom': move it into the fluid, or "
              "make it "
              "smaller");
    EXPECT_EQ(refused({false, false}, {single("a", 0.1, {0.5, 1.2})}),
              "disc 'a' at (0.5, 1.2) m: its centre is outside the domain: move it in");
    EXPECT_EQ(refused({true, true}, {single("a", 0.1, {-0.01, 0.5})}),
              "disc 'a' at (-0.01, 0.5) m: its centre is outside the domain: move it in");
    EXPECT_EQ(refused({true, true}, {single("a", 0.1, {NAN, 0.5})}).substr(0, 8), "disc 'a'");
    // Across the periodic sides, and the corner.
    EXPECT_EQ(refused({true, false}, {single("a", 0.1, {0.05, 0.5}), single("b", 0.1, {0.95, 0.5})}),
              "disc 'b' at (0.95, 0.5) m overlaps disc 'a' by 0.1 m: move them apart, or make them smaller");
    EXPECT_EQ(
        refused({false, true}, {single("a", 0.1, {0.5, 0.05}), single("b", 0.1, {0.5, 0.95})}).substr(0, 40),
        "disc 'b' at (0.5, 0.95) m overlaps disc ");
    EXPECT_NE(refused({true, true}, {single("a", 0.1, {0.05, 0.05}), single("b", 0.1, {0.95, 0.95})})
                  .find("overlaps disc 'a'"),
              std::string::npos);
    EXPECT_EQ(refused({true, false}, {single("a", 0.1, {0.15, 0.5}), single("b", 0.1, {0.95, 0.5})}),
              "PLACED 2");
    EXPECT_EQ(refused({true, true}, {single("a", 0.51, {0.5, 0.5})}),
              "disc 'a' meets its own image: the domain is periodic along x and 1 m long there, the disc and "
              "least_distance need 1.02 m; widen the domain, or make the disc smaller");
}

TEST(PlaceDiscs, FitsCurvedWalls) {
    Scene scene = rough_channel(1e-7);
    scene.fluid.density = 1000;
    scene.discs = {random_discs("abrasive", counted(40, 5e-7))};
    std::get<RandomDiscs>(scene.discs[0].placement).least_distance = 2e-7;
    const std::vector<PlacedDisc> discs = place(scene);
    ASSERT_EQ(discs.size(), 40U);
    EXPECT_GE(least_gap(discs, scene.domain), 2e-7 * (1 - 1e-6));
    EXPECT_GE(least_wall_gap(discs, Region(scene)), 2e-7 * (1 - 1e-6));
    scene.discs = {single("a", 1e-6, {1.5e-5, 1.05e-5})};
    EXPECT_NE(refusal(scene).find("behind wall 'pad'"), std::string::npos) << refusal(scene);
}

class RandomPlaces : public ::testing::TestWithParam<std::array<bool, 2>> {};

TEST_P(RandomPlaces, NeitherOverlapNorComeTooNear) {
    Scene scene = box(GetParam());
    RandomDiscs random = counted(150, 0.02);
    random.sizes = SizeDistribution::uniform;
    random.spread = 0.6;
    random.least_distance = 0.01;
    scene.discs = {random_discs("grain", random), single("fixed", 0.15, {0.2, 0.2}),
                   random_discs("dust", counted(100, 0.005))};
    const std::vector<PlacedDisc> discs = place(scene);
    ASSERT_EQ(discs.size(), 251U);
    EXPECT_GE(least_gap(discs, scene.domain), 0);
    const std::vector<PlacedDisc> grains(discs.begin(), discs.begin() + 151);
    EXPECT_GE(least_gap(grains, scene.domain), 0.01 * (1 - 1e-6));
    EXPECT_GE(least_wall_gap({discs.begin(), discs.begin() + 150}, Region(scene)), 0.01 * (1 - 1e-6));
    for (const PlacedDisc& disc : discs) {
        EXPECT_GE((disc.centre - scene.domain.lower).minCoeff(), 0);
        EXPECT_GE((scene.domain.upper - disc.centre).minCoeff(), 0);
    }
}

TEST_P(RandomPlaces, CoverTheWholeDomain) {
    Scene scene = box(GetParam());
    scene.discs = {random_discs("dust", counted(4000, 0.0015))};
    const std::vector<PlacedDisc> discs = place(scene);
    for (const int axis : {0, 1}) {
        double mean = 0;
        double square = 0;
        for (const PlacedDisc& disc : discs) {
            mean += disc.centre[axis] / 4000;
            square += std::pow(disc.centre[axis] - 0.5, 2) / 4000;
        }
        EXPECT_NEAR(mean, 0.5, 4 * std::sqrt(1.0 / 12 / 4000));
        EXPECT_NEAR(square, 1.0 / 12, 4 * std::sqrt(1.0 / 180 / 4000) + 0.003); // centres keep off walls
    }
}

TEST_P(RandomPlaces, ReachFortyPerCent) {
    Scene scene = box(GetParam());
    RandomDiscs random;
    random.area_fraction = 0.4;
    random.radius = 0.02;
    scene.discs = {random_discs("grain", random)};
    const std::vector<PlacedDisc> discs = place(scene);
    EXPECT_NEAR(area_of(discs), 0.4, std::numbers::pi * 0.02 * 0.02 / 2 * (1 + 1e-9));
    EXPECT_GE(least_gap(discs, scene.domain), -1e-9);
}

INSTANTIATE_TEST_SUITE_P(Boxes, RandomPlaces,
                         ::testing::Values(std::array{false, false}, std::array{true, false},
                                           std::array{false, true}, std::array{true, true}));

TEST(RandomDiscs, AreTheSameForTheSameSeed) {
    Scene scene = box({true, false});
    scene.discs = {random_discs("grain", counted(50, 0.03))};
    const auto centres = [&](std::uint64_t seed) {
        std::get<RandomDiscs>(scene.discs[0].placement).seed = seed;
        std::vector<Vector> result;
        for (const PlacedDisc& disc : place(scene))
            result.push_back(disc.centre);
        return result;
    };
    EXPECT_EQ(centres(3), centres(3));
    EXPECT_NE(centres(3), centres(4));
}

TEST(RandomDiscs, StandWhereTheyStoodOnOtherMachines) {
    Scene scene = box({true, true});
    scene.discs = {random_discs("grain", counted(1, 0.03))};
    const PlacedDisc disc = place(scene).front();
    // The first two numbers of MT19937 seeded with 1, over 2^32.
    EXPECT_NEAR(disc.centre.x(), 1791095845.0 / 4294967296.0, 1e-12);
    EXPECT_NEAR(disc.centre.y(), 4282876139.0 / 4294967296.0, 1e-12);
}

TEST(RandomDiscs, ScaleWithTheScene) {
    const auto placed = [](double unit) {
        Scene scene = box({true, false});
        scene.domain.upper *= unit;
        scene.walls[0].shape = LineShape{{0, 0}, {unit, 0}};
        scene.walls[1].shape = LineShape{{0, unit}, {unit, unit}};
        scene.numerics.particle_spacing *= unit;
        RandomDiscs random = counted(60, 0.03 * unit);
        random.least_distance = 0.01 * unit;
        scene.discs = {random_discs("grain", random)};
        return place(scene);
    };
    const std::vector<PlacedDisc> metres = placed(1);
    const std::vector<PlacedDisc> microns = placed(std::pow(2, -20));
    for (std::size_t i = 0; i < metres.size(); ++i)
        EXPECT_EQ(metres[i].centre, microns[i].centre * std::pow(2, 20));
}

TEST(RandomDiscs, PlaceTheLargeOnesFirst) {
    // Once the small ones are spread over the box there is no room for the large one.
    Scene scene = box({true, true});
    scene.discs = {random_discs("small", counted(40, 0.04)), random_discs("large", counted(1, 0.3))};
    EXPECT_EQ(refusal(scene), "PLACED 41");
}

TEST(RandomDiscs, AreRefusedWhereTheyCannotFit) {
    Scene scene = box({true, false});
    RandomDiscs random;
    random.area_fraction = 0.7;
    random.radius = 0.04;
    random.least_distance = 1e-6;
    scene.discs = {random_discs("grain", random)};
    const std::string crowded = refusal(scene);
    for (const char* part : {"discs 'grain': ", " of 139 random discs have a place after 239000 tries",
                             "no room for one of radius 0.04 m", "an area fraction of 0.5",
                             "Ask for fewer or smaller discs, or a smaller least_distance"})
        EXPECT_NE(crowded.find(part), std::string::npos) << part << "\n" << crowded;

    random.area_fraction = 0.2;
    random.least_distance = 0.06; // three times the area with half of it around each disc
    scene.discs = {random_discs("grain", random)};
    EXPECT_NE(refusal(scene).find("random discs have a place"), std::string::npos) << refusal(scene);

    scene.discs = {random_discs("grain", counted(1, 0.6))};
    EXPECT_NE(refusal(scene).find("disc 'grain_1' meets its own image"), std::string::npos) << refusal(scene);
    scene.domain.periodic = {false, false};
    scene.walls = box({false, false}).walls;
    EXPECT_NE(refusal(scene).find("discs 'grain': 0 of 1 random discs have a place"), std::string::npos)
        << refusal(scene);
}

TEST(RandomDiscs, NeedNoFluid) {
    Scene scene = box({false, false});
    scene.start.arrangement = Arrangement::empty;
    scene.discs = {random_discs("grain", counted(5, 0.1))};
    EXPECT_EQ(refusal(scene), "PLACED 5");
}

} // namespace
} // namespace slurry::testing
