#include "solver/probes/grid_probe.hpp"

#include "solver/probes/point_probe.hpp"

namespace slurry {

namespace {

std::vector<double> cell_centres(double lower, double upper, int count) {
    std::vector<double> centres;
    centres.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) {
        centres.push_back(lower + (upper - lower) * (k + 0.5) / count);
    }
    return centres;
}

} // namespace

GridAxes grid_axes(const Domain& domain, const std::array<int, 2>& points) {
    return {cell_centres(domain.lower.x(), domain.upper.x(), points[0]),
            cell_centres(domain.lower.y(), domain.upper.y(), points[1])};
}

GridValues probe_grid(const ParticleFinder& particles, const Region& region, const GridAxes& axes,
                      double time, std::span<const Disc> discs) {
    GridValues grid;
    for (const double y : axes.y) {
        for (const double x : axes.x) {
            const PointValues values = probe_point(particles, region, {x, y}, time, discs);
            grid.pressure.push_back(values.pressure);
            grid.velocity_x.push_back(values.velocity_x);
            grid.velocity_y.push_back(values.velocity_y);
        }
    }
    return grid;
}

} // namespace slurry
