#include "solver/loop/cell_grid.hpp"

#include "solver/loop/pack.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace slurry {

namespace {

// A little more than the cut-off: rounding must not put a neighbour into a cell that is not looked at.
constexpr double margin = 1e-6;

// Also for NaN, which becomes the lower bound.
template <class P> P bounded(const P& value, double lower, double upper) {
    const P least = lower + P{};
    const P most = upper + P{};
    const P raised = value > least ? value : least;
    return raised < most ? raised : most;
}

} // namespace

CellGrid::CellGrid(const SearchProblem& problem, int columns_per_cutoff) : problem_(problem) {
    measure(columns_per_cutoff);
    sort();
}

double CellGrid::row_height(double cutoff) {
    return cutoff * (1 + margin);
}

void CellGrid::measure(int columns_per_cutoff) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double lower_x = infinity;
    double lower_y = infinity;
    double upper_x = -infinity;
    double upper_y = upper_x;
    const double reach = problem_.cutoff * (1 + margin);
    // Beyond it neighbouring numbers are about a cell apart, and sums of such numbers overflow.
    const double farthest = 1e15 * reach;
    const auto& candidates = problem_.candidates;
#pragma omp parallel for schedule(static) reduction(min : lower_x, lower_y) reduction(max : upper_x, upper_y)
    for (const auto index : candidates) {
        const double x = problem_.x[index];
        const double y = problem_.y[index];
        if (std::abs(x) < farthest && std::abs(y) < farthest) { // not for NaN
            lower_x = std::min(lower_x, x);
            upper_x = std::max(upper_x, x);
            lower_y = std::min(lower_y, y);
            upper_y = std::max(upper_y, y);
        }
    }
    if (lower_x > upper_x) {
        return;
    }
    const auto count = static_cast<double>(candidates.size());
    height_ = std::max({row_height(problem_.cutoff), problem_.row_height, (upper_y - lower_y) / count});
    // Two empty rows below and above save the question whether a row exists. Rows are counted from y = 0: if
    // the points come in strips counted from there, what is found is in order and need not be sorted.
    lower_y_ = (std::floor(lower_y / height_) - 2) * height_;
    rows_ = static_cast<std::int32_t>((upper_y - lower_y_) / height_) + 3;
    lower_x_ = lower_x;
    width_ = std::max(reach / columns_per_cutoff, (upper_x - lower_x) * rows_ / count);
    columns_ = static_cast<std::int32_t>((upper_x - lower_x) / width_) + 1;
}

void CellGrid::sort() {
    const auto& candidates = problem_.candidates;
    std::vector<std::uint32_t> cells(candidates.size());
#pragma omp parallel for schedule(static)
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const std::uint32_t index = candidates[k];
        const auto row = static_cast<std::int32_t>(row_coordinate<double>(problem_.y[index]));
        const auto column = static_cast<std::int32_t>(column_coordinate<double>(problem_.x[index]));
        cells[k] = static_cast<std::uint32_t>(row * columns_ + column);
    }
    start_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_) + 2, 0);
    for (const auto cell : cells) {
        ++start_[cell + 2];
    }
    for (std::size_t cell = 2; cell < start_.size(); ++cell) {
        start_[cell] += start_[cell - 1];
    }
    points_.resize(candidates.size());
    for (std::size_t k = 0; k < cells.size(); ++k) { // afterwards start_[cell + 1] is where the cell ends
        const std::uint32_t index = candidates[k];
        points_.set(start_[cells[k] + 1]++, problem_.x[index], problem_.y[index], index);
    }
}

// Several targets at a time, by hand: of the scalar loop the compiler makes branches.
void CellGrid::locate(std::size_t first, std::size_t count, Ends& ends) const {
    constexpr std::size_t lanes = native_lanes<double>;
    using Numbers = Pack<double, lanes>;
    using Integers = Pack<std::int32_t, lanes>;
    const double reach = problem_.cutoff * (1 + margin);
    std::array<double, batch> x{};
    std::array<double, batch> y{};
    std::copy_n(problem_.x.data() + first, count, x.begin());
    std::copy_n(problem_.y.data() + first, count, y.begin());
    for (std::size_t k = 0; k < count; k += lanes) {
        const auto at = row_coordinate(load<Numbers>(y.data() + k));
        const auto row = __builtin_convertvector(at, Integers);
        const Numbers from_below = at - __builtin_convertvector(row, Numbers); // in heights
        const std::array<Numbers, 3> gaps{from_below, Numbers{}, 1 - from_below};
        for (std::size_t near = 0; near < 3; ++near) {
            // The tangents of the circle at 0 and 45 degrees do nearly as well as the circle.
            const Numbers half_width =
                reach * bounded<Numbers>(std::numbers::sqrt2 - gaps[near] * (height_ / reach), 0, 1);
            const auto middle = load<Numbers>(x.data() + k);
            const Integers start = (row + (static_cast<std::int32_t>(near) - 1)) * columns_;
            const auto left = column_coordinate<Numbers>(middle - half_width);
            const auto right = column_coordinate<Numbers>(middle + half_width);
            store(ends.left[near].data() + k, Integers(start + __builtin_convertvector(left, Integers)));
            store(ends.right[near].data() + k, Integers(start + __builtin_convertvector(right, Integers)));
        }
    }
}

void CellGrid::find(std::size_t first, std::size_t last, NeighbourLists& lists) const {
    lists.ends.clear();
    Ends ends;
    for (std::size_t begin = first; begin < last; begin += batch) {
        const std::size_t count = std::min(batch, last - begin);
        locate(begin, count, ends);
        for (std::size_t k = 0; k < count; ++k) {
            std::array<Window, 3> windows;
            for (std::size_t near = 0; near < 3; ++near) {
                windows[near] = {start_[static_cast<std::size_t>(ends.left[near][k])],
                                 start_[static_cast<std::size_t>(ends.right[near][k]) + 1]};
            }
            const std::size_t target = begin + k;
            points_.append_near({problem_.x[target], problem_.y[target], static_cast<std::uint32_t>(target)},
                                windows, problem_.cutoff * problem_.cutoff, lists);
        }
    }
}

template <class P> P CellGrid::row_coordinate(const P& y) const {
    return bounded<P>((y - lower_y_) * (1 / height_), 1, rows_ - 2);
}

template <class P> P CellGrid::column_coordinate(const P& x) const {
    return bounded<P>((x - lower_x_) * (1 / width_), 0, columns_ - 1);
}

} // namespace slurry
