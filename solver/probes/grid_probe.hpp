#pragma once
// Pressure and velocity on a regular grid over the domain.
#include "solver/geometry/region.hpp"
#include "solver/particles/disc.hpp"
#include "solver/probes/particle_finder.hpp"

#include <array>
#include <span>
#include <vector>

namespace slurry {

struct GridAxes {
    std::vector<double> x, y; // m
};

struct GridValues { // [ny * nx], x fastest; NaN as in PointValues
    std::vector<double> pressure, velocity_x, velocity_y;
};

// The centres of [nx, ny] equal cells that fill the domain: periodic images do not coincide.
[[nodiscard]] GridAxes grid_axes(const Domain& domain, const std::array<int, 2>& points);

// probe_point at every point of the grid; `time` in s.
[[nodiscard]] GridValues probe_grid(const ParticleFinder& particles, const Region& region,
                                    const GridAxes& axes, double time, std::span<const Disc> discs = {});

} // namespace slurry
