#include "solver/loop/neighbour_list.hpp"

#include <algorithm>

namespace slurry {

namespace {

// Writes the neighbours of one target into its lane; counts on without writing when the lane is full.
std::size_t fill_lane(std::span<const double> x, std::span<const double> y, const CellGrid& grid,
                      std::uint32_t target, double squared_cutoff, std::uint32_t* lane, std::size_t stride,
                      std::size_t capacity) {
    std::size_t found = 0;
    grid.visit_near(x[target], y[target], [&](std::uint32_t other) {
        const double dx = x[target] - x[other];
        const double dy = y[target] - y[other];
        if (dx * dx + dy * dy < squared_cutoff && other != target) {
            if (found < capacity) {
                lane[found * stride] = other;
            }
            ++found;
        }
    });
    return found;
}

} // namespace

void NeighbourList::build(std::span<const double> x, std::span<const double> y, const CellGrid& grid,
                          std::size_t first, std::size_t last, std::uint32_t padding, double cutoff) {
    const std::size_t blocks = (last - first + width_ - 1) / width_;
    targets_.assign(blocks * width_, padding);
    counts_.assign(blocks, 0);
    for (std::size_t target = first; target < last; ++target) {
        targets_[target - first] = static_cast<std::uint32_t>(target);
    }
    for (bool complete = false; !complete;) {
        entries_.resize(blocks * width_ * capacity_);
        std::size_t longest = 0;
#pragma omp parallel for schedule(static) reduction(max : longest)
        for (std::ptrdiff_t signed_block = 0; signed_block < static_cast<std::ptrdiff_t>(blocks);
             ++signed_block) {
            const auto block = static_cast<std::size_t>(signed_block);
            std::uint32_t* entries = entries_.data() + block * capacity_ * width_;
            std::fill_n(entries, capacity_ * width_, padding);
            for (std::size_t lane = 0; lane < width_; ++lane) {
                const std::uint32_t target = targets_[block * width_ + lane];
                if (target != padding) {
                    const std::size_t found =
                        fill_lane(x, y, grid, target, cutoff * cutoff, entries + lane, width_, capacity_);
                    counts_[block] = std::max(counts_[block], found);
                }
            }
            longest = std::max(longest, counts_[block]);
        }
        complete = longest <= capacity_;
        if (!complete) {
            capacity_ = longest + longest / 4;
            std::fill(counts_.begin(), counts_.end(), 0);
        }
    }
    for (auto& e : entries_)
        e *= stride_;
    for (auto& t : targets_)
        t *= stride_;
}

} // namespace slurry
