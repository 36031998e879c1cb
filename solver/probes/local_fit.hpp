#pragma once
// Moving least squares: the polynomial that fits scattered values best near a point.
#include <Eigen/Core>

#include <optional>

namespace slurry {

// Coordinates of samples about the point of the fit, in particle spacings; equal lengths.
struct LocalSamples {
    Eigen::ArrayXd along;    // along the wall, or x
    Eigen::ArrayXd across;   // from the wall, or y
    Eigen::ArrayXd distance; // from the point: sets the weight

    explicit LocalSamples(Eigen::Index count) : along(count), across(count), distance(count) {}
};

// What the fit makes of any values f at the samples: f.dot(stencil).
using Stencil = Eigen::VectorXd;

// The stencil of f at the origin, for f a polynomial of the given degree; the squared residuals are weighted
// by exp(-(distance / weight_width)^2). None when the samples do not determine it: too few, not enough rows
// either way, none near, or so one-sided that the value would be mainly amplified noise.
[[nodiscard]] std::optional<Stencil> value_stencil(const LocalSamples& samples, int degree,
                                                   double weight_width);

// The same for df/d(across) at the origin, f = across * (polynomial of degree - 1): f vanishes at across = 0
// exactly, which no slip demands of a tangential velocity relative to the wall. The unit is that of f per
// particle spacing.
[[nodiscard]] std::optional<Stencil> slope_stencil(const LocalSamples& samples, int degree,
                                                   double weight_width);

} // namespace slurry
