#include "solver/geometry/wall.hpp"

#include "solver/geometry/curve.hpp"
#include "solver/geometry/geometry_error.hpp"
#include "solver/geometry/shapes.hpp"

#include <cmath>
#include <fmt/core.h>

namespace slurry {

struct Wall::Implementation {
    std::string name;
    Vector velocity;
    double side;
    Curve curve;
    bool stays; // slides along itself between two ends
};

namespace {

bool is_line(const WallScene& wall) {
    return std::holds_alternative<LineShape>(wall.shape);
}

// Walls only translate, so the region keeps its shape only if the motion maps it onto a region of the same
// domain.
void check_motion(const WallScene& wall, const Curve& curve, const Domain& domain) {
    const Vector& velocity = wall.velocity;
    const auto refuse = [&](const char* reason) {
        throw GeometryError(fmt::format("wall '{}': velocity [{:g}, {:g}] m/s {}", wall.name, velocity.x(),
                                        velocity.y(), reason));
    };
    if (!velocity.allFinite())
        refuse("is not finite");
    if (is_line(wall)) {
        const Vector along = (curve.last_point() - curve.first_point()).normalized();
        if (std::abs(left_of(along).dot(velocity)) > 1e-12 * velocity.norm())
            refuse("has a part across the line: a line can only move along itself");
        return;
    }
    if (velocity.y() != 0)
        refuse("has a part along y: the fluid's volume would change");
    if (velocity.x() != 0 && !domain.periodic[0])
        refuse("moves a curved wall along x, which is not periodic: make the domain periodic in x");
}

} // namespace

Wall::Wall(const WallScene& scene, const Domain& domain) {
    Curve curve = make_curve(scene, domain);
    if (!curve.first_point().allFinite() || !std::isfinite(curve.length()))
        throw GeometryError(fmt::format("wall '{}': its shape is not finite", scene.name));
    check_motion(scene, curve, domain);
    const bool left = scene.fluid_side == FluidSide::above || scene.fluid_side == FluidSide::left;
    const bool stays = !curve.closed();
    implementation_ = std::make_unique<Implementation>(
        Implementation{scene.name, scene.velocity, left ? 1.0 : -1.0, std::move(curve), stays});
}

Wall::~Wall() = default;
Wall::Wall(Wall&&) noexcept = default;
Wall& Wall::operator=(Wall&&) noexcept = default;

const std::string& Wall::name() const {
    return implementation_->name;
}
const Vector& Wall::velocity() const {
    return implementation_->velocity;
}
const Curve& Wall::curve() const {
    return implementation_->curve;
}
double Wall::side() const {
    return implementation_->side;
}
double Wall::length() const {
    return implementation_->curve.length();
}

Vector Wall::displacement(double time) const {
    if (implementation_->stays)
        return Vector::Zero();
    return implementation_->velocity * time;
}

NearestPoint Wall::nearest(const Vector& point) const {
    const double side = implementation_->side;
    const Foot foot = implementation_->curve.nearest(point);
    const Vector offset = point - foot.position;
    const double distance = offset.norm();
    // At a kink the bisector decides the side (Baerentzen and Aanaes 2005), and the normal points along the
    // offset.
    Vector normal = side * left_of(foot.before + foot.after).normalized();
    const double signed_distance = offset.dot(normal) < 0 ? -distance : distance;
    if (foot.before != foot.after && distance > 1e-9 * length())
        normal = offset / signed_distance;
    const Vector tangent = -side * left_of(normal);
    return {foot.position, normal, tangent, signed_distance, foot.arc_length, side * foot.curvature};
}

std::vector<WallPoint> Wall::sample(int n) const {
    std::vector<WallPoint> points;
    for (int k = 0; k < n; ++k) {
        const CurvePoint point = implementation_->curve.at((k + 0.5) / n * length());
        const Vector normal = side() * left_of(point.tangent);
        points.push_back({point.position, normal, point.tangent, point.arc_length, side() * point.curvature});
    }
    return points;
}

} // namespace slurry
