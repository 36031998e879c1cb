#pragma once
// Cell-linked list: points sorted by square cells of the cut-off's size, row by row.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slurry {

class CellGrid {
  public:
    // Sorts the points `indices` of (x, y). Within a cell they keep the order of `indices`.
    CellGrid(std::span<const double> x, std::span<const double> y, std::span<const std::uint32_t> indices,
             double cell_size);

    // Calls visit(index) for every point in the 3 x 3 cells around (x, y), always in the same order.
    template <class Visit> void visit_near(double x, double y, Visit&& visit) const {
        const std::ptrdiff_t column = column_of(x);
        const std::ptrdiff_t row = row_of(y);
        const std::ptrdiff_t left = column > 0 ? column - 1 : 0;
        const std::ptrdiff_t right = column + 1 < columns_ ? column + 1 : columns_ - 1;
        for (std::ptrdiff_t r = row > 0 ? row - 1 : 0; r <= row + 1 && r < rows_; ++r) {
            const auto first = start_[static_cast<std::size_t>(r * columns_ + left)];
            const auto last = start_[static_cast<std::size_t>(r * columns_ + right + 1)];
            for (auto k = first; k < last; ++k) {
                visit(order_[k]);
            }
        }
    }

  private:
    [[nodiscard]] std::ptrdiff_t column_of(double x) const;
    [[nodiscard]] std::ptrdiff_t row_of(double y) const;

    double lower_x_ = 0, lower_y_ = 0, inverse_size_ = 0;
    std::ptrdiff_t columns_ = 1, rows_ = 1;
    std::vector<std::uint32_t> start_;
    std::vector<std::uint32_t> order_;
};

} // namespace slurry
