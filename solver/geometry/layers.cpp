// Dummies in layers that follow a wall's curve (design.md section 4).
#include "solver/geometry/curve.hpp"
#include "solver/geometry/numerical.hpp"
#include "solver/geometry/wall.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slurry {
namespace {

// The curve that runs at a fixed depth behind a wall: the wall's leaves moved along their normals, and arcs
// about the kinks where these part. About kinks and tips sharper than it is deep it runs back on
// itself.
class OffsetCurve {
  public:
    OffsetCurve(const Wall& wall, double depth) : wall_(wall), depth_(depth) {
        const auto leaves = wall.curve().leaves();
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            parts_.push_back({i, leaves[i].start, leaves[i].end, 0, false});
            if (i + 1 == leaves.size() && !wall.curve().closed())
                break;
            const double turn =
                angle_between(leaves[i].last.first, leaves[(i + 1) % leaves.size()].first.first);
            if (wall.side() * turn > 1e-9)
                parts_.push_back({i, 0, turn, 0, true});
        }
        for (Part& part : parts_)
            part.length = length(part, part.start, part.end);
    }

    // Leaves out what is nearer to the wall than the depth, to within the resolution along the curve.
    void cut(double resolution) {
        std::vector<Part> kept;
        for (const Part& part : parts_) {
            const int steps = std::max(1, static_cast<int>(std::ceil(part.length / resolution)));
            const auto at = [&](int step) { return part.start + (part.end - part.start) * step / steps; };
            for (int step = 0; step < steps; ++step)
                keep_valid(part, at(step), at(step + 1), kept);
        }
        parts_ = std::move(kept);
    }

    [[nodiscard]] double length() const {
        double sum = 0;
        for (const Part& part : parts_)
            sum += part.length;
        return sum;
    }

    // n points, at (k + 1/2) / n of the length.
    [[nodiscard]] std::vector<Vector> points(int n) const {
        std::vector<Vector> result;
        const double step = length() / n;
        double before = 0;
        for (const Part& part : parts_) {
            for (double target = (static_cast<double>(result.size()) + 0.5) * step - before;
                 target < part.length && result.size() < static_cast<std::size_t>(n); target += step)
                result.push_back(position(part, parameter(part, target)));
            before += part.length;
        }
        return result;
    }

  private:
    struct Part {
        std::size_t leaf;
        double start, end; // parameters of the leaf; angles from its last tangent, for a fan
        double length;
        bool fan; // about the kink at the leaf's end
    };

    [[nodiscard]] const Leaf& leaf(const Part& part) const { return wall_.curve().leaves()[part.leaf]; }

    [[nodiscard]] Vector position(const Part& part, double parameter) const {
        if (part.fan) {
            const Vector out = -wall_.side() * left_of(leaf(part).last.first.normalized());
            const double sine = std::sin(parameter);
            const double cosine = std::cos(parameter);
            return leaf(part).last.position + depth_ * (cosine * out + sine * left_of(out));
        }
        const Jet jet = wall_.curve().jet(leaf(part), parameter);
        return jet.position - depth_ * wall_.side() * left_of(jet.first.normalized());
    }

    // An offset by d behind a curve lengthens it by d times the angle that the curve turns towards the fluid.
    [[nodiscard]] double length(const Part& part, double from, double to) const {
        if (part.fan)
            return depth_ * std::abs(to - from);
        const double turn =
            angle_between(wall_.curve().jet(leaf(part), from).first, wall_.curve().jet(leaf(part), to).first);
        return std::abs(wall_.curve().arc_between(leaf(part), from, to) + depth_ * wall_.side() * turn);
    }

    [[nodiscard]] double parameter(const Part& part, double target) const {
        const auto excess = [&](double at) { return length(part, part.start, at) - target; };
        if (part.fan || target <= 0 || excess(part.end) <= 0)
            return part.start + (part.end - part.start) * target / part.length;
        return find_root(excess, part.start, part.end);
    }

    // How much the point is too near to some other part of the wall, m.
    [[nodiscard]] double intrusion(const Part& part, double parameter) const {
        return wall_.nearest(position(part, parameter)).distance + depth_ * (1 - 1e-6);
    }

    void keep_valid(const Part& part, double from, double to, std::vector<Part>& kept) const {
        const auto function = [&](double at) { return intrusion(part, at); };
        const bool from_valid = function(from) <= 0;
        const bool to_valid = function(to) <= 0;
        if (!from_valid && !to_valid)
            return;
        if (from_valid != to_valid)
            (from_valid ? to : from) = find_root(function, from, to);
        Part piece{part.leaf, from, to, 0, part.fan};
        piece.length = length(piece, from, to);
        kept.push_back(piece);
    }

    const Wall& wall_;
    double depth_;
    std::vector<Part> parts_;
};

Dummy dummy_at(const Wall& wall, Vector position, double volume) {
    const Curve& curve = wall.curve();
    position -= curve.periods(position) * curve.period();
    const NearestPoint nearest = wall.nearest(position);
    return {position, volume, nearest.position, nearest.normal};
}

} // namespace

std::vector<Dummy> Wall::curve_dummies(double spacing, int layers) const {
    std::vector<Dummy> dummies;
    const Jet& first = curve().leaves().front().first;
    const Jet& last = curve().leaves().back().last;
    for (int layer = 0; layer < layers; ++layer) {
        const double depth = (layer + 0.5) * spacing;
        OffsetCurve offset(*this, depth);
        offset.cut(spacing / 8);
        const int n = std::max(1, static_cast<int>(std::lround(offset.length() / spacing)));
        const double step = offset.length() / n;
        for (const Vector& position : offset.points(n))
            dummies.push_back(dummy_at(*this, position, step * spacing));
        for (int k = 0; k < layers && !curve().closed(); ++k) {
            const auto prolong = [&](const Jet& end, double along) {
                const Vector tangent = end.first.normalized();
                const Vector position =
                    end.position + along * (k + 0.5) * step * tangent - depth * side() * left_of(tangent);
                dummies.push_back(dummy_at(*this, position, step * spacing));
            };
            prolong(first, -1);
            prolong(last, 1);
        }
    }
    return dummies;
}

} // namespace slurry
