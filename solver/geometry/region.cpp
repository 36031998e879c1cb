#include "solver/geometry/region.hpp"

#include "solver/geometry/curve.hpp"
#include "solver/geometry/numerical.hpp"
#include "solver/geometry/region_checks.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace slurry {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The lattice of cell centres that continues beyond the sides which are not periodic.
struct Lattice {
    Vector origin, cell;
    std::array<int, 2> cells, beyond;

    Lattice(const Domain& domain, double spacing, int layers) : origin(domain.lower) {
        for (int axis = 0; axis < 2; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            cells[a] = std::max(1, static_cast<int>(std::lround(domain.size()[axis] / spacing)));
            cell[axis] = domain.size()[axis] / cells[a];
            beyond[a] = domain.periodic[a] ? 0 : layers;
        }
    }

    template <class Visit> void for_each(Visit visit) const {
        for (int j = -beyond[1]; j < cells[1] + beyond[1]; ++j)
            for (int i = -beyond[0]; i < cells[0] + beyond[0]; ++i)
                visit(Vector(origin.x() + (i + 0.5) * cell.x(), origin.y() + (j + 0.5) * cell.y()));
    }
};

// Earlier positions, sorted by x, to be searched for one nearby.
class Neighbourhood {
  public:
    [[nodiscard]] bool near(const Vector& point, double radius) const {
        auto other =
            std::lower_bound(points_.begin(), points_.end(), Vector(point.x() - radius, -infinity), before);
        for (; other != points_.end() && other->x() <= point.x() + radius; ++other)
            if ((*other - point).norm() < radius)
                return true;
        return false;
    }
    void add(const std::vector<Dummy>& dummies) {
        for (const Dummy& dummy : dummies)
            points_.push_back(dummy.position);
        std::sort(points_.begin(), points_.end(), before);
    }

  private:
    static bool before(const Vector& a, const Vector& b) {
        return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
    }
    std::vector<Vector> points_;
};

// Whether a dummy prolongs its wall instead of being behind it.
bool beyond_end(const Dummy& dummy, double spacing) {
    const Vector offset = dummy.position - dummy.wall_point;
    return (offset - offset.dot(dummy.normal) * dummy.normal).norm() > 1e-6 * spacing;
}

// What is behind a wall comes first: where walls meet, the prolongation of the one would leave a hole beside
// the other for the fluid to escape through.
std::vector<std::vector<Dummy>> curve_layers(const std::vector<Wall>& walls, double spacing, int layers) {
    std::vector<std::vector<Dummy>> result;
    result.reserve(walls.size());
    for (const Wall& wall : walls)
        result.push_back(wall.curve_dummies(spacing, layers));
    Neighbourhood earlier;
    for (const bool prolonging : {false, true}) {
        for (std::vector<Dummy>& dummies : result) {
            std::erase_if(dummies, [&](const Dummy& dummy) {
                return beyond_end(dummy, spacing) == prolonging && earlier.near(dummy.position, spacing / 2);
            });
            std::vector<Dummy> kept;
            std::ranges::copy_if(dummies, std::back_inserter(kept), [&](const Dummy& dummy) {
                return beyond_end(dummy, spacing) == prolonging;
            });
            earlier.add(kept);
        }
    }
    return result;
}

// The depth that counts behind a wall's end is the larger of the two along and across the wall, which fills
// the corners of a box.
double lattice_depth(const NearestPoint& nearest, const Vector& point) {
    const Vector offset = point - nearest.position;
    return std::max(std::abs(offset.dot(nearest.normal)), std::abs(offset.dot(nearest.tangent)));
}

// The wall whose surface a point in the solid is behind: the one nearest to it.
std::optional<std::pair<std::size_t, NearestPoint>> wall_before(const std::vector<Wall>& walls,
                                                                const Vector& point) {
    std::optional<std::pair<std::size_t, NearestPoint>> best;
    bool solid = false;
    for (std::size_t wall = 0; wall < walls.size(); ++wall) {
        const NearestPoint nearest = walls[wall].nearest(point);
        solid = solid || nearest.distance <= 0;
        if (!best || std::abs(nearest.distance) < std::abs(best->second.distance))
            best = {wall, nearest};
    }
    return solid ? best : std::nullopt;
}

// The walls as bounds on the fluid's y(x) and x.
struct Bounds {
    const Domain& domain;
    const std::vector<Wall>& walls;
    double left, right;

    Bounds(const Domain& box, const std::vector<Wall>& all)
        : domain(box), walls(all), left(box.lower.x()), right(box.upper.x()) {
        for (const Wall& wall : walls) {
            if (!wall.curve().vertical())
                continue;
            const double x = wall.curve().first_point().x();
            if (wall.side() < 0)
                left = std::max(left, x);
            else
                right = std::min(right, x);
        }
    }

    [[nodiscard]] double height(double x) const {
        double bottom = domain.lower.y();
        double top = domain.upper.y();
        for (const Wall& wall : walls) {
            if (wall.curve().vertical())
                continue;
            const double y = wall.curve().height(x);
            if (wall.side() > 0)
                bottom = std::max(bottom, y);
            else
                top = std::min(top, y);
        }
        return std::max(0.0, top - bottom);
    }

    // Between these every wall is smooth and short against its features.
    [[nodiscard]] std::vector<double> breaks() const {
        std::vector<double> breaks{left, right};
        for (const Wall& wall : walls)
            for (const Leaf& leaf : wall.curve().leaves())
                for (const Vector& point : {leaf.first.position, leaf.last.position})
                    if (point.x() > left && point.x() < right)
                        breaks.push_back(point.x());
        std::sort(breaks.begin(), breaks.end());
        return breaks;
    }
};

} // namespace

Region::Region(const Scene& scene) : domain_(scene.domain) {
    walls_.reserve(scene.walls.size());
    for (const WallScene& wall : scene.walls)
        walls_.emplace_back(wall, domain_);
    check_region(*this, scene.numerics);
}

double Region::distance(const Vector& point) const {
    return distance(point, 0);
}

double Region::distance(const Vector& point, double time) const {
    double smallest = infinity;
    for (const Wall& wall : walls_)
        smallest = std::min(smallest, wall.nearest(point - wall.displacement(time)).distance);
    return smallest;
}

double Region::fluid_area() const {
    const Bounds bounds(domain_, walls_);
    const std::vector<double> breaks = bounds.breaks();
    double area = 0;
    if (!(bounds.left < bounds.right))
        return area;
    for (std::size_t i = 1; i < breaks.size(); ++i) {
        const double half = (breaks[i] - breaks[i - 1]) / 2;
        for (const auto& [position, weight] : gauss_points())
            area += half * weight * bounds.height(breaks[i - 1] + half * (1 + position));
    }
    return area;
}

std::vector<Vector> Region::lattice_points(double spacing) const {
    std::vector<Vector> points;
    Lattice(domain_, spacing, 0).for_each([&](const Vector& point) {
        if (distance(point) > 0)
            points.push_back(point);
    });
    return points;
}

std::vector<std::vector<Dummy>> Region::dummies(DummyLayout layout, double spacing, int layers) const {
    if (layout == DummyLayout::curve)
        return curve_layers(walls_, spacing, layers);
    std::vector<std::vector<Dummy>> result(walls_.size());
    const Lattice lattice(domain_, spacing, layers);
    const double deepest = layers * spacing * (1 + 1e-9);
    lattice.for_each([&](const Vector& point) {
        const auto found = wall_before(walls_, point);
        if (!found || lattice_depth(found->second, point) > deepest)
            return;
        result[found->first].push_back(
            {point, lattice.cell.prod(), found->second.position, found->second.normal});
    });
    return result;
}

} // namespace slurry
