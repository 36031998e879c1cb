#pragma once
// The paper's search (Sec. 2.6, wang2014's reference 33): a line sweeps along x. Candidates within the
// cut-off on either side of it are kept in order of y, where each target finds those within the cut-off above
// and below it: O(n log n) and the pairs. Serial; all lists are made at once.
#include "solver/loop/neighbour_search.hpp"

namespace slurry {

class PlaneSweep final : public NeighbourFinder {
  public:
    explicit PlaneSweep(const SearchProblem& problem);

    void find(std::size_t first, std::size_t last, NeighbourLists& lists) const override;

  private:
    std::size_t first_target_;
    std::vector<std::span<const std::uint32_t>> lists_; // of each target, in found_
    NeighbourLists found_;                              // in the order of the sweep
};

} // namespace slurry
