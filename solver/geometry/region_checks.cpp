#include "solver/geometry/region_checks.hpp"

#include "solver/geometry/curve.hpp"
#include "solver/geometry/geometry_error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <limits>

namespace slurry {
namespace {

constexpr double least_spacings_per_gap = 3;
constexpr double kernel_support = 3; // smoothing lengths

std::string place(const Vector& point) {
    return fmt::format("({:.4g}, {:.4g}) m", point.x(), point.y());
}

int samples(double length, double spacing) {
    return static_cast<int>(std::clamp(std::ceil(4 * length / spacing), 200.0, 20000.0));
}

bool near_end(const Wall& wall, const Vector& point, double radius) {
    return !wall.curve().closed() && ((point - wall.curve().first_point()).norm() <= radius ||
                                      (point - wall.curve().last_point()).norm() <= radius);
}

void check_crossing(const Wall& one, const Wall& other, double spacing) {
    const int n = samples(one.length(), spacing);
    const double step = one.length() / n;
    double before = 0;
    for (const WallPoint& point : one.sample(n)) {
        const NearestPoint nearest = other.nearest(point.position);
        const bool changes_sign = nearest.distance * before < 0;
        before = nearest.distance;
        if (!changes_sign || std::abs(nearest.distance) > step)
            continue; // the sign jumps behind a wall's end
        if (near_end(one, point.position, 1.5 * step) || near_end(other, nearest.position, 1.5 * step))
            continue;
        throw GeometryError(
            fmt::format("walls '{}' and '{}' cross near {}: move them apart, or let them meet only at "
                        "their ends",
                        one.name(), other.name(), place(point.position)));
    }
}

// The fluid is the intersection of the walls' fluid sides, each wall prolonged straight beyond its ends; so
// it is closed only if no prolongation runs through the fluid.
void check_ends(const Region& region, const Wall& wall, double spacing) {
    if (wall.curve().closed())
        return;
    const Domain& domain = region.domain();
    const auto follow = [&](const Vector& end, const Vector& outward) {
        for (Vector point = end + outward * spacing / 2;
             (point - domain.lower).minCoeff() > 0 && (domain.upper - point).minCoeff() > 0;
             point += outward * spacing / 2)
            if (std::ranges::all_of(region.walls(), [&](const Wall& other) {
                    return &other == &wall || other.nearest(point).distance > 1e-6 * spacing;
                }))
                throw GeometryError(
                    fmt::format("wall '{}' ends at {} and its prolongation runs through the fluid: walls "
                                "have to enclose the fluid without inward corners",
                                wall.name(), place(end)));
    };
    const Jet& first = wall.curve().leaves().front().first;
    const Jet& last = wall.curve().leaves().back().last;
    follow(first.position, -first.first.normalized());
    follow(last.position, last.first.normalized());
}

void check_sides(const Region& region, double spacing) {
    const Domain& domain = region.domain();
    const std::array<std::array<const char*, 2>, 2> names{{{"left", "right"}, {"lower", "upper"}}};
    for (int axis = 0; axis < 2; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (domain.periodic[a])
            continue;
        for (const bool upper : {false, true}) {
            Vector point = domain.lower;
            point[axis] = upper ? domain.upper[axis] : domain.lower[axis];
            const double length = domain.size()[1 - axis];
            const int n = samples(length, spacing);
            for (int i = 0; i < n; ++i) {
                point[1 - axis] = domain.lower[1 - axis] + length * (i + 0.5) / n;
                if (!(region.distance(point) > 1e-6 * spacing))
                    continue;
                throw GeometryError(
                    fmt::format("domain: its {} side is open to the fluid at {}: close it with a wall, "
                                "make the axis periodic, or enlarge the domain",
                                names[a][upper ? 1 : 0], place(point)));
            }
        }
    }
}

void check_reached_by_fluid(const Region& region, const Wall& wall, double spacing) {
    for (const WallPoint& point : wall.sample(samples(wall.length(), spacing)))
        if (std::ranges::all_of(region.walls(), [&](const Wall& other) {
                return &other == &wall || other.nearest(point.position).distance >= -1e-6 * spacing;
            }))
            return;
    throw GeometryError(
        fmt::format("wall '{}' lies wholly in the solid behind other walls: remove it, or check "
                    "fluid_side",
                    wall.name()));
}

void require_gap(double gap, double spacing, const std::string& where) {
    if (gap >= least_spacings_per_gap * spacing * (1 - 1e-9))
        return;
    throw GeometryError(
        fmt::format("{} is {:.4g} m, {:.2g} particle spacings: needs {:g} or more, so particle_spacing "
                    "of at most {:.4g} m",
                    where, gap, gap / spacing, least_spacings_per_gap, gap / least_spacings_per_gap));
}

// Two curved walls that slide past each other: the smallest distance over a whole period.
void check_gap_in_motion(const Wall& one, const Wall& other, double spacing) {
    const bool curved = one.curve().leaves().size() > 1 && other.curve().leaves().size() > 1;
    if (!curved || !one.curve().closed() || !other.curve().closed() || one.velocity() == other.velocity())
        return;
    constexpr int phases = 64;
    const std::vector<WallPoint> points = one.sample(400);
    double gap = std::numeric_limits<double>::infinity();
    for (int phase = 0; phase < phases; ++phase)
        for (const WallPoint& point : points)
            gap =
                std::min(gap, other.nearest(point.position + one.curve().period() * phase / phases).distance);
    const std::string names = fmt::format("'{}' and '{}'", one.name(), other.name());
    if (!(gap > 0))
        throw GeometryError(fmt::format("walls {} collide as they move", names));
    require_gap(gap, spacing, fmt::format("the narrowest gap between walls {} as they move", names));
}

// Where even the first layer of dummies is deeper than the radius of curvature, no layer knows of the curve.
// Deeper ones may run back on themselves: they are cut there (solver/geometry/layers.cpp).
void check_curvature(const Wall& wall, double spacing) {
    for (const Leaf& leaf : wall.curve().leaves()) {
        for (const Jet& jet : {leaf.first, leaf.last}) {
            const double bend =
                -wall.side() * left_of(jet.first).dot(jet.second) / std::pow(jet.first.squaredNorm(), 1.5);
            if (!(bend * spacing / 2 > 1))
                continue;
            throw GeometryError(
                fmt::format("wall '{}' has a radius of curvature of {:.4g} m at {}, less than half a "
                            "particle spacing: use a "
                            "particle_spacing of at most {:.4g} m, or wall_dummies = \"lattice\"",
                            wall.name(), 1 / bend, place(jet.position), 2 / bend));
        }
    }
}

// A particle meets one image of another at most: the kernel's reach, from a wall's deepest dummy, fits in.
void check_period(const Domain& domain, const Numerics& numerics) {
    constexpr double least_smoothing_lengths = 2 * kernel_support + 1;
    const double least = least_smoothing_lengths * numerics.smoothing_length();
    for (const int axis : {0, 1}) {
        const double length = domain.size()[axis];
        if (domain.periodic[static_cast<std::size_t>(axis)] && length < least * (1 - 1e-9))
            throw GeometryError(
                fmt::format("the domain is periodic along {} and {:.4g} m long there: it has to be at "
                            "least {} smoothing lengths, {:.4g} m; reduce the spacing or widen it",
                            axis == 0 ? 'x' : 'y', length, least_smoothing_lengths, least));
    }
}

} // namespace

void check_region(const Region& region, const Numerics& numerics) {
    check_period(region.domain(), numerics);
    const double spacing = numerics.particle_spacing;
    const std::vector<Wall>& walls = region.walls();
    for (const Wall& one : walls)
        for (const Wall& other : walls)
            if (&one != &other)
                check_crossing(one, other, spacing);
    if (!(region.fluid_area() > 0))
        throw GeometryError("the walls leave no room for fluid: check their positions and fluid_side");
    check_sides(region, spacing);
    for (const Wall& wall : walls)
        check_ends(region, wall, spacing);
    for (const Wall& wall : walls)
        check_reached_by_fluid(region, wall, spacing);
    require_gap(region.narrowest_gap(), spacing, "the narrowest gap between walls");
    for (std::size_t i = 0; i < walls.size(); ++i)
        for (std::size_t j = i + 1; j < walls.size(); ++j)
            check_gap_in_motion(walls[i], walls[j], spacing);
    if (numerics.wall_dummies == DummyLayout::curve)
        for (const Wall& wall : walls)
            check_curvature(wall, spacing);
}

} // namespace slurry
