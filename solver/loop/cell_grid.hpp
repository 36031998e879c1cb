#pragma once
// Candidates sorted into cells, row by row, so that those near a target are one contiguous window in each of
// three rows. The rows are as high as the cut-off. Narrow columns let the windows end near the cut-off's
// circle.
#include "solver/loop/neighbour_search.hpp"
#include "solver/loop/packed_points.hpp"

#include <array>

namespace slurry {

class CellGrid final : public NeighbourFinder {
  public:
    // Columns are the cut-off / columns_per_cutoff wide. Cells get larger where there would be more cells
    // than candidates.
    CellGrid(const SearchProblem& problem, int columns_per_cutoff);

    // Of rows of cells, counted from y = 0. Points sorted by such rows, then by x, are found in order.
    static double row_height(double cutoff);

    void find(std::size_t first, std::size_t last, NeighbourLists& lists) const override;

  private:
    static constexpr std::size_t batch = 64;

    // The first and last cell of each of three windows, for a batch of targets.
    struct Ends {
        std::array<std::array<std::int32_t, batch>, 3> left, right;
    };

    void measure(int columns_per_cutoff);
    void sort();
    void locate(std::size_t first, std::size_t count, Ends& ends) const;
    // In rows and columns, bounded to those that a target can be in. P is a number or a Pack of them.
    template <class P> [[nodiscard]] P row_coordinate(const P& y) const;
    template <class P> [[nodiscard]] P column_coordinate(const P& x) const;

    SearchProblem problem_;
    double lower_x_ = 0, lower_y_ = 0;
    double width_ = 1, height_ = 1; // of a cell
    std::int32_t columns_ = 1, rows_ = 5;
    std::vector<std::uint32_t> start_; // of cell row * columns_ + column in points_
    PackedPoints points_;
};

} // namespace slurry
