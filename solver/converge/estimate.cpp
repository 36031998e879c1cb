#include "solver/converge/estimate.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace slurry {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double scatter_safety = 2;    // of differences without an order
constexpr double scheme_order = 2;      // the most that is ever extrapolated with
constexpr double least_order = 0.5;     // slower extrapolations go too far to be believed [eca2014]
constexpr double most_order = 6;        // of the search
constexpr double growth_of_scatter = 4; // from one difference to the next: more is divergence

struct Fit {
    double order = nan;
    double limit = nan;
    ArrayXd residual;
};

Fit fit_with(double order, const ArrayXd& spacing, const ArrayXd& value) {
    const ArrayXd power = spacing.unaryExpr([order](double h) { return std::pow(h, order); });
    const ArrayXd from_mean = power - power.mean();
    const double coefficient = (from_mean * value).sum() / from_mean.square().sum();
    const double limit = value.mean() - coefficient * power.mean();
    return {order, limit, value - limit - coefficient * power};
}

// Over orders of both signs: a negative one is what differences that grow look like.
Fit best_fit(const ArrayXd& spacing, const ArrayXd& value) {
    constexpr double step = 0.01;
    Fit best;
    double least = std::numeric_limits<double>::infinity();
    for (double order = -2; order <= most_order + step / 2; order += step) {
        if (std::abs(order) > step / 2) {
            Fit fit = fit_with(order, spacing, value);
            if (const double squares = fit.residual.square().sum(); squares < least) {
                least = squares;
                best = std::move(fit);
            }
        }
    }
    return best;
}

void require_sense(std::span<const GridValue> values) {
    if (values.size() < 3) {
        throw std::invalid_argument("an error band needs three spacings or more");
    }
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (!std::isfinite(values[k].value) || !std::isfinite(values[k].noise) || !(values[k].spacing > 0) ||
            (k > 0 && !(values[k].spacing < values[k - 1].spacing))) {
            throw std::invalid_argument("an error band needs finite values at spacings that fall");
        }
    }
}

// How far the best order moves when each value moves by its noise. Three values an order apart in noise fix
// it to within one, and an order that is found too high makes the extrapolation too short.
double order_deviation(const ArrayXd& spacing, const ArrayXd& value, const ArrayXd& noise) {
    double squares = 0;
    for (Index k = 0; k < value.size(); ++k) {
        ArrayXd moved = value;
        moved(k) += noise(k);
        const double above = best_fit(spacing, moved).order;
        moved(k) -= 2 * noise(k);
        squares += std::pow((above - best_fit(spacing, moved).order) / 2, 2);
    }
    return std::sqrt(squares);
}

// Whether the data are near enough to a curve for its order to mean something.
bool regular(const ArrayXd& steps, const Fit& fit, double range) {
    if (steps.size() == 2) {
        return steps(0) * steps(1) > 0;
    }
    const double deviation = std::sqrt(fit.residual.square().sum() / static_cast<double>(steps.size() - 2));
    return deviation < range / static_cast<double>(steps.size());
}

Estimate without_order(Verdict verdict, double floor) {
    return {verdict, nan, nan, nan, 0, floor};
}

} // namespace

Estimate estimate_error(std::span<const GridValue> values) {
    require_sense(values);
    const auto count = static_cast<Index>(values.size());
    ArrayXd spacing(count), value(count), noise(count);
    for (Index k = 0; k < count; ++k) {
        const GridValue& at = values[static_cast<std::size_t>(k)];
        spacing(k) = at.spacing / values.back().spacing; // so that the finest is 1
        value(k) = at.value;
        noise(k) = at.noise;
    }
    const double finest = value(count - 1);
    const double noise_band = standard_errors * std::sqrt(noise.square().mean());
    const double range = value.maxCoeff() - value.minCoeff();
    if (range <= noise_band) {
        return without_order(Verdict::settled, range + noise_band);
    }
    const ArrayXd steps = value.tail(count - 1) - value.head(count - 1);
    const Fit best = best_fit(spacing, value);
    const bool on_curve = regular(steps, best, range);
    if (on_curve && best.order >= least_order) {
        const double order = std::min(best.order, scheme_order);
        const Fit fit = fit_with(order, spacing, value);
        const double low = std::max(least_order, order - order_deviation(spacing, value, noise));
        const Fit slow = fit_with(low, spacing, value);
        const auto error = [&](const Fit& of) { return safety * std::abs(finest - of.limit); };
        return {Verdict::converging,
                best.order,
                order,
                fit.limit,
                std::max(error(fit), error(slow)),
                noise_band + std::max(fit.residual.abs().maxCoeff(), slow.residual.abs().maxCoeff())};
    }
    const double last = std::abs(steps(count - 2));
    const double before = steps.head(count - 2).abs().maxCoeff();
    const bool grows = on_curve ? best.order < 0 : last > growth_of_scatter * before;
    if (grows && last > 2 * noise_band) {
        return without_order(Verdict::diverging, nan);
    }
    return without_order(Verdict::scattered, scatter_safety * range + noise_band);
}

} // namespace slurry
