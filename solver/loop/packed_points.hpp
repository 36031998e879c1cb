#pragma once
// Points copied into the order in which a search reads them, and the one test of distance that all searches
// use: with a test each, rounding could put a pair at the cut-off into one list and not into the other.
#include "solver/loop/neighbour_search.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace slurry {

struct Target {
    double x, y;
    std::uint32_t index;
};

struct Window { // the slots first ... last - 1
    std::uint32_t first, last;
};

class PackedPoints {
  public:
    void resize(std::size_t count);
    void set(std::size_t slot, double x, double y, std::uint32_t index) {
        x_[slot] = x;
        y_[slot] = y;
        index_[slot] = index;
    }

    // Appends to the list all points of the windows that are nearer to the target than the cut-off, and not
    // the target itself.
    void append_near(const Target& target, std::span<const Window> windows, double squared_cutoff,
                     NeighbourLists& lists) const;

  private:
    std::vector<double> x_, y_;
    std::vector<std::uint32_t> index_;
};

} // namespace slurry
