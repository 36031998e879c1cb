#pragma once
// Two-dimensional vectors and matrices of state and geometry. Pair loops use plain arrays of numbers instead.
#include <Eigen/Core>

namespace slurry {

using Vector = Eigen::Vector2d;
using Matrix = Eigen::Matrix2d;

// A vector turned anticlockwise by a right angle.
inline Vector left_of(const Vector& vector) {
    return {-vector.y(), vector.x()};
}

} // namespace slurry
