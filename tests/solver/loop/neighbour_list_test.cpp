// Periodic copies and neighbour lists together, against all pairs with the minimum image.
#include "solver/loop/neighbour_list.hpp"

#include "solver/loop/periodic_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace slurry::testing {
namespace {

using Points = std::vector<Vector>;
using Lists =
    std::vector<std::vector<std::uint32_t>>; // per target: neighbours' identities, sorted, repeats kept

constexpr double list_reach = 0.13;
const Domain unit_domain{{-0.4, 0.3}, {0.6, 1.3}, {false, false}};

Points ordered_points(int n) {
    Points points;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            points.emplace_back(unit_domain.lower + Vector(i + 0.5, j + 0.5) / n);
        }
    }
    return points;
}

Points random_points(int count, const std::function<Vector(double, double)>& map) {
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    Points points;
    for (int k = 0; k < count; ++k) {
        const double u = uniform(generator);
        points.push_back(unit_domain.lower + map(u, uniform(generator)));
    }
    return points;
}

// 60 % in one corner cell.
Points clustered_points() {
    Points points = random_points(160, [](double u, double v) { return Vector(u, v); });
    const Points corner = random_points(240, [](double u, double v) { return Vector(0.05 * u, 0.05 * v); });
    points.insert(points.end(), corner.begin(), corner.end());
    return points;
}

Points duplicated_points() {
    Points points = random_points(100, [](double u, double v) { return Vector(u, v); });
    const Points again = points;
    points.insert(points.end(), again.begin(), again.end());
    points.push_back(unit_domain.lower);
    points.push_back(unit_domain.upper);
    return points;
}

// Every third point is a dummy.
Particles particles_at(const Points& points) {
    Particles particles;
    const std::size_t dummy_count = points.size() / 3;
    particles.fluid.resize(points.size() - dummy_count);
    particles.dummies.resize(dummy_count);
    std::size_t i = 0;
    std::size_t d = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const bool dummy = k % 3 == 2;
        (dummy ? particles.dummies.x[d] : particles.fluid.x[i]) = points[k].x();
        (dummy ? particles.dummies.y[d] : particles.fluid.y[i]) = points[k].y();
        ++(dummy ? d : i);
    }
    return particles;
}

// Row k of the particles (fluid, then dummies) after sorting.
Vector row_position(const Particles& particles, std::size_t k) {
    const std::size_t fluid = particles.fluid.size();
    return k < fluid ? Vector(particles.fluid.x[k], particles.fluid.y[k])
                     : Vector(particles.dummies.x[k - fluid], particles.dummies.y[k - fluid]);
}

Lists brute_force(const Particles& particles, const Domain& domain, bool fluid_only) {
    const std::size_t count = particles.fluid.size() + particles.dummies.size();
    Lists lists(count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::uint32_t j = 0; j < (fluid_only ? particles.fluid.size() : count); ++j) {
            Vector r = row_position(particles, i) - row_position(particles, j);
            for (int axis = 0; axis < 2; ++axis) {
                if (domain.periodic[static_cast<std::size_t>(axis)]) {
                    r[axis] -= std::round(r[axis] / domain.size()[axis]) * domain.size()[axis];
                }
            }
            if (i != j && r.norm() < list_reach) {
                lists[i].push_back(j);
            }
        }
    }
    return lists;
}

Lists listed(const PeriodicRows& rows, const NeighbourList& list, int width, std::size_t first,
             std::size_t last) {
    Lists lists(rows.particle_count());
    const auto lanes = static_cast<std::size_t>(width);
    for (std::size_t block = 0; block < list.block_count(); ++block) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const std::uint32_t target = list.target(block, lane);
            const std::size_t expected = first + block * lanes + lane;
            EXPECT_EQ(target, expected < last ? expected : rows.padding());
            for (std::size_t k = 0; k < list.count(block); ++k) {
                const std::uint32_t row = list.neighbours(block)[k * lanes + lane];
                if (row != rows.padding() && target != rows.padding()) {
                    const auto copy = row - static_cast<std::uint32_t>(rows.particle_count());
                    lists[target].push_back(row < rows.particle_count() ? row : rows.copies()[copy].source);
                } else {
                    EXPECT_EQ(row, rows.padding()) << "a padding target has a neighbour";
                }
            }
        }
    }
    for (auto& neighbours : lists) {
        std::sort(neighbours.begin(), neighbours.end());
    }
    return lists;
}

void expect_lists_match(const Points& points, std::array<bool, 2> periodic, int width) {
    Particles particles = particles_at(points);
    Domain domain = unit_domain;
    domain.periodic = periodic;
    PeriodicRows rows;
    rows.rebuild(particles, domain, list_reach, list_reach);
    NeighbourList fluid_list(width, NeighbourSearch::strips);
    NeighbourList dummy_list(width, NeighbourSearch::strips);
    const std::size_t fluid_count = rows.fluid_count();
    const std::size_t count = rows.particle_count();
    fluid_list.build(rows.x(), rows.y(), rows.all_rows(), 0, fluid_count, rows.padding(), list_reach);
    dummy_list.build(rows.x(), rows.y(), rows.fluid_rows(), fluid_count, count, rows.padding(), list_reach);
    const Lists of_fluid = listed(rows, fluid_list, width, 0, fluid_count);
    const Lists of_dummies = listed(rows, dummy_list, width, fluid_count, count);
    const Lists expected_of_fluid = brute_force(particles, domain, false);
    const Lists expected_of_dummies = brute_force(particles, domain, true);
    for (std::size_t k = 0; k < count; ++k) {
        EXPECT_EQ(k < fluid_count ? of_fluid[k] : of_dummies[k],
                  k < fluid_count ? expected_of_fluid[k] : expected_of_dummies[k])
            << "row " << k;
    }
}

void expect_lists_match_everywhere(const Points& points) {
    for (const bool x : {false, true}) {
        for (const bool y : {false, true}) {
            for (const int width : {1, 4, 8}) {
                SCOPED_TRACE("periodic x " + std::to_string(x) + ", y " + std::to_string(y) + ", width " +
                             std::to_string(width));
                expect_lists_match(points, {x, y}, width);
            }
        }
    }
}

TEST(NeighbourList, OfALattice) {
    expect_lists_match_everywhere(ordered_points(19));
}

TEST(NeighbourList, OfRandomPoints) {
    expect_lists_match_everywhere(random_points(400, [](double u, double v) { return Vector(u, v); }));
}

TEST(NeighbourList, OfPointsInOneCorner) {
    expect_lists_match_everywhere(clustered_points());
}

TEST(NeighbourList, CoincidentPointsAreNeighboursOfEachOtherButNotOfThemselves) {
    expect_lists_match_everywhere(duplicated_points());
}

TEST(NeighbourList, OfPointsOutsideTheDomainThatAreWrappedFirst) {
    const Points points = random_points(300, [](double u, double v) { return Vector(4 * u - 2, 4 * v - 2); });
    expect_lists_match(points, {true, true}, 8);
}

TEST(NeighbourList, OfFewerPointsThanLanesAndOfOne) {
    expect_lists_match_everywhere(
        random_points(4, [](double u, double v) { return Vector(0.1 * u, 0.1 * v); }));
    expect_lists_match_everywhere({unit_domain.lower});
}

} // namespace
} // namespace slurry::testing
