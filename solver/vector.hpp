#pragma once
// Two-dimensional vectors and matrices of state and geometry. Pair loops use plain arrays of numbers instead.
#include <Eigen/Core>

namespace slurry {

using Vector = Eigen::Vector2d;
using Matrix = Eigen::Matrix2d;

} // namespace slurry
