#include "solver/loop/search_timing.hpp"

#include "solver/loop/neighbour_list.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

namespace slurry {

namespace {

using Points = std::vector<Vector>;

Points jittered_lattice(std::size_t count, double side, std::mt19937_64& generator) {
    std::uniform_real_distribution<double> jitter(-0.2, 0.2);
    const auto columns = static_cast<std::size_t>(side);
    Points points;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t row = k / columns;
        const double dx = jitter(generator);
        points.emplace_back(static_cast<double>(k % columns) + dx,
                            static_cast<double>(row) + jitter(generator));
    }
    return points;
}

// Gaussian clusters of at most 1000 points. Two points of a cluster are neighbours with the probability 1 -
// exp(-(cut-off / 2 deviation)^2): about 60 each, and those of the clusters around.
Points gaussian_clusters(std::size_t count, double side, std::mt19937_64& generator) {
    constexpr std::size_t members = 1000;
    constexpr double deviation = 2 * search_timing_cutoff;
    std::uniform_real_distribution<double> anywhere(0, side);
    std::normal_distribution<double> offset(0, deviation);
    Points points;
    Vector centre;
    for (std::size_t k = 0; k < count; ++k) {
        if (k % members == 0) {
            const double x = anywhere(generator);
            centre = Vector(x, anywhere(generator));
        }
        const double dx = offset(generator);
        points.emplace_back(centre + Vector(dx, offset(generator)));
    }
    return points;
}

} // namespace

TimingPoints timing_points(PointSet set, std::size_t count) {
    std::mt19937_64 generator(1);
    const double side = std::ceil(std::sqrt(static_cast<double>(count)));
    Points points = set == PointSet::uniform ? jittered_lattice(count, side, generator)
                                             : gaussian_clusters(count, side, generator);
    const auto strip = [](const Vector& point) { return std::floor(point.y() / search_timing_cutoff); };
    std::sort(points.begin(), points.end(), [&](const Vector& a, const Vector& b) {
        return strip(a) != strip(b) ? strip(a) < strip(b) : a.x() < b.x();
    });
    TimingPoints arrays;
    for (const Vector& point : points) {
        arrays.x.push_back(point.x());
        arrays.y.push_back(point.y());
    }
    return arrays;
}

double time_search(NeighbourSearch search, std::size_t points, PointSet set, int repetitions) {
    if (repetitions < 1) {
        throw std::invalid_argument("time_search needs at least one repetition");
    }
    const auto [x, y] = timing_points(set, points);
    std::vector<std::uint32_t> all(points);
    std::iota(all.begin(), all.end(), 0U);
    NeighbourList list(8, search);
    std::vector<double> seconds;
    for (int repetition = -1; repetition < repetitions; ++repetition) {
        const auto start = std::chrono::steady_clock::now();
        list.build(x, y, all, 0, points, static_cast<std::uint32_t>(points), search_timing_cutoff);
        seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    seconds.erase(seconds.begin());
    const auto median = seconds.begin() + repetitions / 2;
    std::nth_element(seconds.begin(), median, seconds.end());
    return *median;
}

} // namespace slurry
