#include "solver/loop/displacement_watch.hpp"

#include "solver/loop/pack.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slurry {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Bounded, for positions that are not finite: they get a cell, too, and the watchdog finds them.
std::ptrdiff_t cell_along(double position, double size) {
    return static_cast<std::ptrdiff_t>(std::min(1e9, std::max(-1e9, std::floor(position / size))));
}

// The first and last cell of a range of positions may be cut short; across a periodic side they are one.
std::ptrdiff_t cell_count(double lower, double upper, double size, bool periodic) {
    return periodic ? std::max(std::ptrdiff_t{1}, std::lround((upper - lower) / size))
                    : cell_along(upper, size) - cell_along(lower, size) + 1;
}

// Cells beyond a periodic side are those at the other; beyond any other side there is nothing, and the last
// cell stands for it.
std::ptrdiff_t into_range(std::ptrdiff_t cell, std::ptrdiff_t count, bool periodic) {
    if (!periodic) {
        return std::clamp(cell, std::ptrdiff_t{0}, count - 1);
    }
    // Seldom out of range: a division each time would take longer than all the rest.
    return cell >= 0 && cell < count ? cell : (cell % count + count) % count;
}

struct Range {
    double low, high;
};

// Least and largest now[k] - start[k]. By hand: the compiler does not vectorise a loop of a few dozen numbers
// well.
Range moved_range(const double* now, const double* start, std::uint32_t count) {
    constexpr std::uint32_t lanes = native_lanes<double>;
    using Numbers = Pack<double, lanes>;
    Range range{infinity, -infinity};
    const auto include = [&](double moved) {
        range.low = moved < range.low ? moved : range.low;
        range.high = moved > range.high ? moved : range.high;
    };
    if (count < lanes) {
        for (std::uint32_t k = 0; k < count; ++k) {
            include(now[k] - start[k]);
        }
        return range;
    }
    Numbers low = Numbers{} + infinity;
    Numbers high = Numbers{} - infinity;
    for (std::uint32_t k = 0; k < count; k += lanes) {
        const std::uint32_t at = std::min(k, count - lanes); // the last one overlaps
        const Numbers moved = load<Numbers>(now + at) - load<Numbers>(start + at);
        low = moved < low ? moved : low;
        high = moved > high ? moved : high;
    }
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        include(low[lane]);
        include(high[lane]);
    }
    return range;
}

// The place of a dummy, moved by `depth` along its normal.
Vector toward_rim(const DummyParticles& dummies, std::size_t d, double depth) {
    return {dummies.x[d] + depth * dummies.normal_x[d], dummies.y[d] + depth * dummies.normal_y[d]};
}

} // namespace

void DisplacementWatch::Box::include(const Box& other) {
    low_x = std::min(low_x, other.low_x);
    high_x = std::max(high_x, other.high_x);
    low_y = std::min(low_y, other.low_y);
    high_y = std::max(high_y, other.high_y);
}

double DisplacementWatch::Box::squared_diagonal_with(const Box& other) const {
    Box both = *this;
    both.include(other);
    const double width = std::max(0.0, both.high_x - both.low_x);
    const double height = std::max(0.0, both.high_y - both.low_y);
    return width * width + height * height;
}

std::uint32_t DisplacementWatch::cell_of(double x, double y) const {
    const auto column = cell_along(x, size_.x()) - first_column_;
    const auto row = cell_along(y, size_.y()) - first_row_;
    return static_cast<std::uint32_t>(into_range(row, rows_, periodic_y_) * columns_ +
                                      into_range(column, columns_, periodic_x_));
}

void DisplacementWatch::start(const Particles& particles, std::span<const double> x,
                              std::span<const double> y, const Domain& domain, const Vector& cell_size) {
    start_x_ = x;
    start_y_ = y;
    start_time_ = particles.time;
    periodic_x_ = domain.periodic[0];
    periodic_y_ = domain.periodic[1];
    size_ = cell_size;
    first_column_ = cell_along(domain.lower.x(), size_.x());
    first_row_ = cell_along(domain.lower.y(), size_.y());
    columns_ = cell_count(domain.lower.x(), domain.upper.x(), size_.x(), periodic_x_);
    rows_ = cell_count(domain.lower.y(), domain.upper.y(), size_.y(), periodic_y_);
    runs_.clear();
    const auto fluid = static_cast<std::uint32_t>(particles.fluid.size());
    for (std::uint32_t i = 0; i < fluid; ++i) {
        const std::uint32_t cell = cell_of(x[i], y[i]);
        if (runs_.empty() || runs_.back().cell != cell) {
            runs_.push_back({i, i, cell});
        }
        runs_.back().last = i + 1;
    }
    wall_cells_.clear();
    disc_points_.clear();
    const DummyParticles& dummies = particles.dummies;
    for (std::size_t d = 0; d < dummies.size(); ++d) {
        for (const double depth : {0.0, dummies.depth[d]}) {
            const Vector point = toward_rim(dummies, d, depth);
            const std::uint32_t cell = cell_of(point.x(), point.y());
            if (dummies.of_disc(d)) {
                disc_points_.push_back({cell, d, depth, point});
            } else {
                wall_cells_.push_back({cell, dummies.wall[d]});
            }
        }
    }
    std::sort(wall_cells_.begin(), wall_cells_.end());
    wall_cells_.erase(std::unique(wall_cells_.begin(), wall_cells_.end()), wall_cells_.end());
}

DisplacementWatch::Box DisplacementWatch::displacements(const FluidParticles& fluid, const Run& run) const {
    Box box{};
    const auto range = [&](const std::vector<double>& now, std::span<const double> start, double& low,
                           double& high) {
        const auto moved =
            moved_range(now.data() + run.first, start.data() + run.first, run.last - run.first);
        low = moved.low;
        high = moved.high;
    };
    range(fluid.x, start_x_, box.low_x, box.high_x);
    range(fluid.y, start_y_, box.low_y, box.high_y);
    return box;
}

double DisplacementWatch::largest(const Particles& particles) const {
    std::vector<Box> of_runs(runs_.size());
    std::vector<Box> cells(static_cast<std::size_t>(columns_ * rows_),
                           Box{infinity, -infinity, infinity, -infinity});
    const auto run_count = static_cast<std::ptrdiff_t>(runs_.size());
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t k = 0; k < run_count; ++k) {
        const auto run = static_cast<std::size_t>(k);
        of_runs[run] = displacements(particles.fluid, runs_[run]);
    }
    for (std::size_t run = 0; run < runs_.size(); ++run) {
        cells[runs_[run].cell].include(of_runs[run]);
    }
    for (const WallCell& of : wall_cells_) {
        const Vector moved =
            (particles.time - start_time_) * particles.dummies.wall_drift[static_cast<std::size_t>(of.wall)];
        cells[of.cell].include({moved.x(), moved.x(), moved.y(), moved.y()});
    }
    for (const DiscPoint& point : disc_points_) {
        const Vector moved = toward_rim(particles.dummies, point.dummy, point.depth) - point.start;
        cells[point.cell].include({moved.x(), moved.x(), moved.y(), moved.y()});
    }
    double largest = 0;
    for (std::ptrdiff_t row = 0; row < rows_; ++row) {
        for (std::ptrdiff_t column = 0; column < columns_; ++column) {
            largest = std::max(largest, largest_squared_beside(cells, column, row));
        }
    }
    return std::sqrt(largest);
}

// Half of the neighbouring cells: the other half look at this one.
double DisplacementWatch::largest_squared_beside(std::span<const Box> cells, std::ptrdiff_t column,
                                                 std::ptrdiff_t row) const {
    const auto at = [&](std::ptrdiff_t c, std::ptrdiff_t r) -> const Box& {
        return cells[static_cast<std::size_t>(into_range(r, rows_, periodic_y_) * columns_ +
                                              into_range(c, columns_, periodic_x_))];
    };
    const Box& here = at(column, row);
    return std::max({here.squared_diagonal_with(at(column + 1, row)),
                     here.squared_diagonal_with(at(column - 1, row + 1)),
                     here.squared_diagonal_with(at(column, row + 1)),
                     here.squared_diagonal_with(at(column + 1, row + 1))});
}

} // namespace slurry
