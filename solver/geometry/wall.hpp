#pragma once
// A wall: a piecewise smooth curve with the fluid on one side, at rest or translating.
#include "solver/scene/scene.hpp"
#include "solver/vector.hpp"

#include <memory>
#include <string>
#include <vector>

namespace slurry {

class Curve;

// The nearest point of a wall to some point.
struct NearestPoint {
    Vector position;   // on the wall
    Vector normal;     // unit, into the fluid
    Vector tangent;    // unit; (tangent, normal) is right-handed or left-handed as the fluid side demands:
                       // tangent has tangent.x > 0, or tangent.y > 0 on a vertical line
    double distance;   // signed, m: positive in the fluid
    double arc_length; // m, along the wall from its first point
    double curvature;  // 1/m, positive where the wall bends towards the fluid (a concave wall seen from the
                       // fluid)
};

// A point of a wall and the frame there.
struct WallPoint {
    Vector position;
    Vector normal;  // unit, into the fluid
    Vector tangent; // unit, see NearestPoint
    double arc_length;
    double curvature;
};

// A particle of a wall, behind its surface, that completes the kernel support of the fluid beside it
// (Sec. 2.3).
struct Dummy {
    Vector position;
    double volume;     // m2 (area that it stands for)
    Vector wall_point; // nearest point of the wall
    Vector normal;     // unit, into the fluid
};

class Wall {
  public:
    // Throws GeometryError (solver/geometry/geometry_error.hpp) when the shape makes no sense in this domain.
    Wall(const WallScene& scene, const Domain& domain);
    ~Wall();
    Wall(Wall&&) noexcept;
    Wall& operator=(Wall&&) noexcept;

    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] const Vector& velocity() const;
    // Displacement since the start: velocity * time, since walls only translate; zero for a line between two
    // ends that slides along itself (the lid of a closed box stays where it is).
    [[nodiscard]] Vector displacement(double time) const;

    // The nearest point of the wall where it stands at time 0, periodic images included. Shift the argument
    // by -displacement(t), and the answer back, for later times.
    [[nodiscard]] NearestPoint nearest(const Vector& point) const;
    // n points evenly spaced in arc length at time 0: at (k + 1/2) / n of the length.
    [[nodiscard]] std::vector<WallPoint> sample(int n) const;
    [[nodiscard]] double length() const;

    // Layers along the curve at depths (k + 1/2) spacing, k < layers, each evenly spaced along its own arc
    // (so the volume follows the curve); ends that are not periodic are prolonged by `layers` spacings.
    // Kinks: the layer is rounded on the convex side and cut where it meets itself on the other.
    [[nodiscard]] std::vector<Dummy> curve_dummies(double spacing, int layers) const;

    // The curve at time 0, from its left (lower, if vertical) end.
    [[nodiscard]] const Curve& curve() const;
    // +1 where the fluid lies to the left of the curve's tangent, -1 to the right.
    [[nodiscard]] double side() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace slurry
