#include "solver/loop/cell_grid.hpp"

#include <algorithm>
#include <limits>

namespace slurry {

CellGrid::CellGrid(std::span<const double> x, std::span<const double> y,
                   std::span<const std::uint32_t> indices, double cell_size)
    : inverse_size_(1 / cell_size), order_(indices.size()) {
    double upper_x = -std::numeric_limits<double>::infinity();
    double upper_y = upper_x;
    lower_x_ = lower_y_ = -upper_x;
    for (const auto index : indices) {
        lower_x_ = std::min(lower_x_, x[index]);
        upper_x = std::max(upper_x, x[index]);
        lower_y_ = std::min(lower_y_, y[index]);
        upper_y = std::max(upper_y, y[index]);
    }
    if (!indices.empty()) {
        columns_ = static_cast<std::ptrdiff_t>((upper_x - lower_x_) * inverse_size_) + 1;
        rows_ = static_cast<std::ptrdiff_t>((upper_y - lower_y_) * inverse_size_) + 1;
    }
    start_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
    const auto cell_of = [&](std::uint32_t index) {
        return static_cast<std::size_t>(row_of(y[index]) * columns_ + column_of(x[index]));
    };
    for (const auto index : indices) {
        ++start_[cell_of(index) + 1];
    }
    for (std::size_t cell = 1; cell < start_.size(); ++cell) {
        start_[cell] += start_[cell - 1];
    }
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (const auto index : indices) {
        order_[next[cell_of(index)]++] = index;
    }
}

std::ptrdiff_t CellGrid::column_of(double x) const {
    return std::clamp(static_cast<std::ptrdiff_t>((x - lower_x_) * inverse_size_), std::ptrdiff_t{0},
                      columns_ - 1);
}

std::ptrdiff_t CellGrid::row_of(double y) const {
    return std::clamp(static_cast<std::ptrdiff_t>((y - lower_y_) * inverse_size_), std::ptrdiff_t{0},
                      rows_ - 1);
}

} // namespace slurry
