#include "solver/converge/spacings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace slurry {
namespace {

// A hundredth of stretch is worth ten of distance from what was asked for.
constexpr double weight_of_stretch = 10;
constexpr double farthest = 0.12; // relative to what was asked for

double stretch(const Domain& domain, double spacing) {
    const Vector cells = domain.size() / spacing;
    return (cells.array() / cells.array().round().max(1) - 1).abs().maxCoeff();
}

} // namespace

double admissible_spacing(const Domain& domain, double wanted) {
    double best = wanted;
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](double spacing) {
        const double penalty =
            weight_of_stretch * stretch(domain, spacing) + std::abs(std::log(spacing / wanted));
        if (penalty < least * (1 - 1e-9)) {
            least = penalty;
            best = spacing;
        }
    };
    consider(wanted);
    for (const int axis : {0, 1}) {
        const double length = domain.size()[axis];
        const double fewest = std::max(1.0, std::ceil(length / (wanted * (1 + farthest))));
        const double most = std::floor(length / (wanted * (1 - farthest)));
        for (double cells = fewest; cells <= most; ++cells) {
            consider(length / cells);
        }
    }
    return best;
}

std::vector<double> study_spacings(const Domain& domain, double finest, int count) {
    std::vector<double> spacings;
    for (int k = count - 1; k >= 0; --k) {
        spacings.push_back(admissible_spacing(domain, finest * std::pow(std::numbers::sqrt2, k)));
    }
    return spacings;
}

std::string adaptation(const Domain& domain, double wanted, double taken) {
    constexpr double same = 1e-9; // relative: what rounding makes of a side divided by a whole number
    if (std::abs(taken / wanted - 1) < same) {
        return {};
    }
    const Vector size = domain.size(), before = size / wanted, after = size / taken;
    return fmt::format("spacing {:.5g} m becomes {:.5g} m so that the domain's sides, {:.5g} m and {:.5g} m, "
                       "are whole multiples of it, or nearly: {:.5g} and {:.5g}, not {:.5g} and {:.5g}",
                       wanted, taken, size[0], size[1], after[0], after[1], before[0], before[1]);
}

} // namespace slurry
