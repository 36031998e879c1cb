#pragma once
// The searches for neighbours behind one interface. They may differ in the order of what they find: the lists
// made of it are sorted (NeighbourList).
#include "solver/scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace slurry {

struct SearchProblem {
    std::span<const double> x, y;              // of all points; lengths in one unit, equal sizes
    std::span<const std::uint32_t> candidates; // the points that can be neighbours, each once
    std::size_t first, last; // the points first ... last - 1 ask; they need not be candidates
    double cutoff;           // > 0
    double row_height = 0;   // of the points\' order, if they are sorted by rows from y = 0, then by x
};

// Lists of consecutive targets, one behind the other.
struct NeighbourLists {
    std::vector<std::uint32_t> entries; // may be longer than the lists
    std::vector<std::size_t> ends;      // of each list in entries

    [[nodiscard]] std::size_t size() const { return ends.empty() ? 0 : ends.back(); }
    [[nodiscard]] std::size_t begin(std::size_t list) const { return list > 0 ? ends[list - 1] : 0; }
    [[nodiscard]] std::size_t length(std::size_t list) const { return ends[list] - begin(list); }
    [[nodiscard]] std::span<std::uint32_t> list(std::size_t list) {
        return std::span(entries).subspan(begin(list), length(list));
    }
};

class NeighbourFinder {
  public:
    NeighbourFinder() = default;
    NeighbourFinder(const NeighbourFinder&) = delete;
    NeighbourFinder& operator=(const NeighbourFinder&) = delete;
    virtual ~NeighbourFinder() = default;

    // Makes the lists of the candidates nearer to the targets first ... last - 1 than the cut-off, themselves
    // excepted, each in any order. A point that is not finite has no neighbours. Threads may ask at the same
    // time.
    virtual void find(std::size_t first, std::size_t last, NeighbourLists& lists) const = 0;
};

// The finder refers to the problem's positions, which have to outlive it.
std::unique_ptr<NeighbourFinder> make_finder(NeighbourSearch search, const SearchProblem& problem);

} // namespace slurry
