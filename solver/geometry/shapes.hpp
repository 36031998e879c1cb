#pragma once
// The curves of the shapes that a scene can name.
#include "solver/geometry/curve.hpp"
#include "solver/scene/scene.hpp"

namespace slurry {

// The curve of a wall, left to right (a vertical line: upwards), over one period if the domain has one.
// Throws GeometryError when the shape makes no sense in this domain; the message names the wall.
Curve make_curve(const WallScene& wall, const Domain& domain);

} // namespace slurry
