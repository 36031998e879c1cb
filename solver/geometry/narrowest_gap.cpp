#include "solver/geometry/curve.hpp"
#include "solver/geometry/region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slurry {
namespace {

constexpr double no_gap = std::numeric_limits<double>::infinity();
constexpr int samples_along = 2000;

// Where an end of one wall touches the other: the distance between them vanishes there without being a gap.
std::vector<Vector> junctions(const Wall& one, const Wall& other, double tolerance) {
    std::vector<Vector> result;
    const auto look = [&](const Wall& ending, const Wall& passing) {
        if (ending.curve().closed())
            return;
        for (const Vector& end : {ending.curve().first_point(), ending.curve().last_point()})
            if (std::abs(passing.nearest(end).distance) <= tolerance)
                result.push_back(end);
    };
    look(one, other);
    look(other, one);
    return result;
}

bool hidden(const std::vector<Wall>& walls, const Wall& own, const Vector& point, double tolerance) {
    return std::ranges::any_of(
        walls, [&](const Wall& wall) { return &wall != &own && wall.nearest(point).distance < -tolerance; });
}

// Distance from a point of a wall to the other if that stands opposite; infinite if not.
double gap_at(const WallPoint& point, const Wall& other) {
    const NearestPoint nearest = other.nearest(point.position);
    const Vector across = nearest.position - point.position;
    const bool ahead = across.dot(point.normal) > 0.7 * across.norm();
    const bool beyond_end = std::abs(across.dot(nearest.tangent)) > 1e-6 * across.norm();
    return ahead && !beyond_end && nearest.distance > 0 ? nearest.distance : no_gap;
}

// The lowest point of the parabola through three evenly spaced values of which the middle one is the
// smallest.
double parabola_minimum(double before, double here, double after) {
    const double bend = before - 2 * here + after;
    if (!std::isfinite(bend) || !(bend > 0))
        return here;
    return here - (after - before) * (after - before) / (8 * bend);
}

double gap_between(const std::vector<Wall>& walls, const Wall& one, const Wall& other, double tolerance) {
    const std::vector<WallPoint> points = one.sample(samples_along);
    std::vector<double> gaps;
    for (const WallPoint& point : points) {
        const double gap = gap_at(point, other);
        gaps.push_back(gap < no_gap && hidden(walls, one, point.position, tolerance) ? no_gap : gap);
    }
    const std::vector<Vector> touching = junctions(one, other, tolerance);
    const double step = one.length() / samples_along;
    double smallest = no_gap;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        const bool closed = one.curve().closed();
        const double before = i > 0 ? gaps[i - 1] : closed ? gaps.back() : no_gap;
        const double after = i + 1 < gaps.size() ? gaps[i + 1] : closed ? gaps.front() : no_gap;
        if (!(gaps[i] < no_gap) || gaps[i] > before || gaps[i] > after)
            continue;
        if (std::ranges::any_of(touching, [&](const Vector& joint) {
                return (points[i].position - joint).norm() < 3 * step;
            }))
            continue;
        smallest = std::min(smallest, parabola_minimum(before, gaps[i], after));
    }
    return smallest;
}

} // namespace

double Region::narrowest_gap() const {
    const double tolerance = 1e-9 * domain_.size().norm();
    double smallest = no_gap;
    for (const Wall& one : walls_)
        for (const Wall& other : walls_)
            if (&one != &other)
                smallest = std::min(smallest, gap_between(walls_, one, other, tolerance));
    return smallest;
}

} // namespace slurry
