#include "solver/converge/steadiness.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace slurry {
namespace {

constexpr std::size_t fewest_samples = 8;
constexpr double least_share_of_time = 0.25;

Eigen::Map<const Eigen::ArrayXd> array_of(std::span<const double> values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
}

double variance(std::span<const double> values) {
    const auto array = array_of(values);
    return (array - array.mean()).square().mean();
}

} // namespace

double steady_from(std::span<const double> time, std::span<const double> value) {
    std::size_t start = value.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t first = 0; first + fewest_samples <= value.size(); ++first) {
        const auto rest = value.subspan(first);
        const double squared_error = variance(rest) / static_cast<double>(rest.size());
        if (squared_error < least) { // false for NaN
            least = squared_error;
            start = first;
        }
    }
    const double latest =
        time.empty() ? 0 : time.front() + (1 - least_share_of_time) * (time.back() - time.front());
    return start < value.size() && time[start] <= latest ? time[start]
                                                         : std::numeric_limits<double>::quiet_NaN();
}

Reading mean_from(std::span<const double> time, std::span<const double> value, double from) {
    const auto first = static_cast<std::size_t>(std::ranges::lower_bound(time, from) - time.begin());
    const auto rest = value.subspan(first);
    constexpr std::size_t parts = 4;
    std::array<double, parts> means{};
    for (std::size_t part = 0; part < parts; ++part) {
        const std::size_t begin = part * rest.size() / parts;
        const std::size_t end = (part + 1) * rest.size() / parts;
        means[part] = array_of(rest.subspan(begin, end - begin)).mean();
    }
    return {array_of(rest).mean(), std::sqrt(variance(means) / (parts - 1))};
}

Reading final_value(std::span<const double> time, std::span<const double> value) {
    constexpr std::size_t near = 9;
    constexpr Eigen::Index coefficients = 3;
    if (value.size() < near) {
        return {value.back(), 0};
    }
    const auto last = array_of(value.last(near));
    const auto stamps = array_of(time.last(near));
    const Eigen::ArrayXd t = (stamps - stamps(stamps.size() - 1)) / (stamps(stamps.size() - 1) - stamps(0));
    Eigen::MatrixXd powers(t.size(), coefficients);
    powers << Eigen::VectorXd::Ones(t.size()), t.matrix(), t.square().matrix();
    const Eigen::VectorXd fit = powers.colPivHouseholderQr().solve(last.matrix());
    const double squares = (last.matrix() - powers * fit).squaredNorm();
    return {value.back(), std::sqrt(squares / static_cast<double>(t.size() - coefficients))};
}

} // namespace slurry
