#include "solver/geometry/numerical.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_roots.h>
#include <stdexcept>
#include <string>

namespace slurry {
namespace {

// GSL aborts the program on an error unless told otherwise; while this lives it returns codes.
class ReturnCodes {
  public:
    ReturnCodes() : previous_(gsl_set_error_handler_off()) {}
    ~ReturnCodes() { gsl_set_error_handler(previous_); }
    ReturnCodes(const ReturnCodes&) = delete;
    ReturnCodes& operator=(const ReturnCodes&) = delete;

  private:
    gsl_error_handler_t* previous_;
};

void require(int code, const char* what) {
    if (code != GSL_SUCCESS)
        throw std::runtime_error(std::string(what) + ": " + gsl_strerror(code));
}

double call(double x, void* function) {
    return (*static_cast<std::function<double(double)>*>(function))(x);
}

std::array<QuadraturePoint, 5> make_gauss_points() {
    const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)> table(
        gsl_integration_glfixed_table_alloc(5), gsl_integration_glfixed_table_free);
    std::array<QuadraturePoint, 5> points{};
    for (std::size_t i = 0; i < points.size(); ++i)
        gsl_integration_glfixed_point(-1, 1, i, &points[i].position, &points[i].weight, table.get());
    return points;
}

std::shared_ptr<gsl_spline> allocate_spline(const gsl_interp_type* type, std::size_t points) {
    const ReturnCodes return_codes;
    gsl_spline* spline = gsl_spline_alloc(type, points);
    if (spline == nullptr)
        throw std::runtime_error("spline: too few points");
    return {spline, gsl_spline_free};
}

} // namespace

double find_root(const std::function<double(double)>& function, double lower, double upper) {
    const ReturnCodes return_codes;
    const std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver(
        gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
    std::function<double(double)> copy = function;
    gsl_function callback{call, &copy};
    require(gsl_root_fsolver_set(solver.get(), &callback, lower, upper), "root finding");
    for (int i = 0; i < 200; ++i) {
        require(gsl_root_fsolver_iterate(solver.get()), "root finding");
        const double a = gsl_root_fsolver_x_lower(solver.get());
        const double b = gsl_root_fsolver_x_upper(solver.get());
        if (b - a <= 1e-15 * (std::abs(a) + std::abs(b)))
            break;
    }
    return gsl_root_fsolver_root(solver.get());
}

std::span<const QuadraturePoint, 5> gauss_points() {
    static const std::array<QuadraturePoint, 5> points = make_gauss_points();
    return points;
}

Spline::Spline(Kind kind, std::span<const double> x, std::span<const double> y)
    : spline_(allocate_spline(kind == Kind::periodic_cubic ? gsl_interp_cspline_periodic : gsl_interp_steffen,
                              x.size())),
      lower_(x.front()), upper_(x.back()) {
    const ReturnCodes return_codes;
    require(gsl_spline_init(spline_.get(), x.data(), y.data(), x.size()), "spline");
}

Spline::Values Spline::at(double x) const {
    const double inside = std::clamp(x, lower_, upper_);
    // No accelerator: its cache of the last interval would be shared between threads.
    return {gsl_spline_eval(spline_.get(), inside, nullptr),
            gsl_spline_eval_deriv(spline_.get(), inside, nullptr),
            gsl_spline_eval_deriv2(spline_.get(), inside, nullptr)};
}

} // namespace slurry
