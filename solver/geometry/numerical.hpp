#pragma once
// GSL behind value types: errors become exceptions and nothing is left to free.
#include <cstddef>
#include <functional>
#include <gsl/gsl_spline.h>
#include <memory>
#include <span>

namespace slurry {

// A root of a continuous function between two points where its signs differ, to the last few digits (Brent).
// Throws std::runtime_error when they do not differ.
double find_root(const std::function<double(double)>& function, double lower, double upper);

// Points and weights of Gauss-Legendre quadrature on [-1, 1].
struct QuadraturePoint {
    double position;
    double weight;
};
std::span<const QuadraturePoint, 5> gauss_points();

// An interpolating function through points with ascending x.
class Spline {
  public:
    enum class Kind { periodic_cubic, steffen };
    // Throws std::runtime_error when GSL refuses the points.
    Spline(Kind kind, std::span<const double> x, std::span<const double> y);

    struct Values {
        double value, first, second;
    };
    // Value and derivatives; the argument is limited to the range of the points.
    [[nodiscard]] Values at(double x) const;

  private:
    std::shared_ptr<gsl_spline> spline_;
    double lower_, upper_;
};

} // namespace slurry
