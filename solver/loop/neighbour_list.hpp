#pragma once
// Neighbours of consecutive targets, interleaved for the pair loop: block b holds targets b W ... b W + W -
// 1, and entry k of lane l is its k-th neighbour. Short lanes are padded with a row that is far away.
#include "solver/loop/cell_grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace slurry {

class NeighbourList {
  public:
    // A list for blocks of `width` targets. An entry is the neighbour's index times `stride`: the distance of
    // two rows in bytes, so that the pair loop need not multiply.
    explicit NeighbourList(int width, std::size_t stride = 1)
        : width_(static_cast<std::size_t>(width)), stride_(static_cast<std::uint32_t>(stride)) {}

    // Lists for targets first ... last - 1 all points of the grid nearer than the cut-off, themselves
    // excepted, in an order that depends on the grid alone.
    void build(std::span<const double> x, std::span<const double> y, const CellGrid& grid, std::size_t first,
               std::size_t last, std::uint32_t padding, double cutoff);

    [[nodiscard]] std::size_t block_count() const { return counts_.size(); }
    [[nodiscard]] const std::uint32_t* targets(std::size_t block) const {
        return targets_.data() + block * width_;
    }
    [[nodiscard]] const std::uint32_t* neighbours(std::size_t block) const {
        return entries_.data() + block * capacity_ * width_;
    }
    // Entries per lane, padding included.
    [[nodiscard]] std::size_t count(std::size_t block) const { return counts_[block]; }

  private:
    std::size_t width_;
    std::uint32_t stride_;
    std::size_t capacity_ = 40; // per lane; grows when a target has more neighbours
    std::vector<std::uint32_t> targets_;
    std::vector<std::uint32_t> entries_;
    std::vector<std::size_t> counts_;
};

} // namespace slurry
